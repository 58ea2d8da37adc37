// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "host/base/program.hpp"

namespace altiplan::host {

/// GDAL's programs on one file of a user's, which work in a folder of their own.
class GdalPrograms {
 public:
  /// `who` needs them, for messages ("--basemap"); none may take longer.
  GdalPrograms(std::string who, std::string file, std::chrono::seconds longest)
      : who_(std::move(who)), file_(std::move(file)), longest_(longest) {}

  /// What a program prints. Throws Error with its first complaint: what it cannot read is nothing
  /// for its exit code.
  std::string run(std::vector<std::string> arguments) const;
  std::string in_folder(const char* name) const { return folder_.path() / name; }

  /// Throws Error if they are not.
  static void expect_installed(const std::string& who);

 private:
  std::string who_;
  std::string file_;
  std::chrono::seconds longest_;
  TemporaryFolder folder_;
};
}  // namespace altiplan::host
