// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace altiplan::host {

/// The reason why a file named in another one cannot be read ("file not found: 'a'", "'a' is a
/// pipe, expected a file"); "" if it can. Throws MachineFault if the machine fails to provide it.
/// altiplan/formats/input_file.hpp describes how files are read.
std::string file_problem(const std::filesystem::path& file);
}  // namespace altiplan::host
