// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace altiplan::host {

/// A Chromium: the program that ALTIPLAN_CHROMIUM names if set, else one on the PATH.
std::optional<std::filesystem::path> find_chromium();

/// A PNG of the page, rendered headless. `query` is appended to its URL. Throws Error if Chromium
/// does not render it in time.
std::string screenshot(const std::filesystem::path& chromium, const std::string& page,
                       const std::string& query,
                       std::chrono::milliseconds patience = std::chrono::seconds(60));
}  // namespace altiplan::host
