// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "altiplan/error.hpp"
#include "host/config/config.hpp"
#include "host/run/pipeline.hpp"
#include "support/folders.hpp"

namespace altiplan::testing {}
namespace altiplan::host::testing {
using namespace altiplan::testing;  // which other files of a unit call `testing`

/// A folder of the test's own with a scenario and a pipeline in it, run with the test's plugins.
class Files : public ::testing::Test {
 protected:
  Files()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ("altiplan_files_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    overrides_.plugin_path = {altiplan::folders::build() / "tests/plugins",
                              altiplan::folders::build() / "tests/mock_plugins"};
    scenario("");
  }
  ~Files() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// East through an empty kilometre, and what a test adds or says in place of that.
  void scenario(
      const std::string& more,
      const std::string& ends =
          "start: {at_m: [100, 500, 500]}\n"
          "goal: {at_m: [900, 500, 500]}\n",
      const std::string& volume = "volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}\n") const {
    write("s.yaml", "altiplan: 1\n" + volume + ends + more);
  }
  /// The pipeline's file from its first line after the scenario's.
  std::filesystem::path pipeline(const std::string& text) const {
    return write("p.yaml", "altiplan: 1\nscenario: s.yaml\n" + text);
  }
  RunResult run(const std::string& text, const RunOptions& options = {}) const {
    const Config config = load_config(pipeline(text), overrides_);
    return host::run(config, options);
  }
  /// What the user would read of the exception that running brings; "" without one.
  std::string refusal(const std::string& text) const {
    try {
      run(text);
    } catch (const Error& error) {
      return without_folder(error.what());
    }
    return "";
  }
  std::string without_folder(std::string text) const {
    const std::string folder = folder_.string() + "/";
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }

  std::filesystem::path folder_;
  Overrides overrides_;
};

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)
}  // namespace altiplan::host::testing
