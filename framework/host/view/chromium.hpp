// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "host/base/program.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// A Chromium: the program that ALTIPLAN_CHROMIUM names if set, else one on the PATH.
std::optional<std::filesystem::path> find_chromium();

/// The page of a scene in a Chromium without a window, driven through its DevTools protocol. Every
/// member throws Error if Chromium ends, or takes longer than `timeout`.
class ShownPage {
 public:
  /// Opens the page, with `query` appended to its URL, and waits until it is drawn.
  ShownPage(const std::filesystem::path& chromium, const std::string& page,
            const std::string& query, int width, int height, std::chrono::milliseconds timeout);

  /// The value of a JavaScript expression, or of the promise that it gives. Throws Error with what
  /// the script throws.
  Json run(const std::string& script);
  /// What the page looks like: "png" or "jpeg".
  std::string picture(const char* format);

 private:
  Json call(const char* method, Json parameters);
  Json answer_to(int id, const char* method);
  [[noreturn]] void give_up();

  std::string name_;
  TemporaryFolder folder_;  ///< outlives the program that uses it
  Program program_;
  std::chrono::milliseconds timeout_;
  std::string session_;
  std::string unread_;
  int calls_ = 0;
};

/// A PNG of the page, 1,600 x 1,000 pixels.
std::string screenshot(const std::filesystem::path& chromium, const std::string& page,
                       const std::string& query,
                       std::chrono::milliseconds timeout = std::chrono::seconds(60));
}  // namespace altiplan::host
