// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace altiplan::host {

/// Why a file that is named in another one cannot be read, as a sentence: "there is no file 'a'",
/// "'a' is a pipe, expected a file"; "" where it can. Throws MachineFault where it is the machine
/// that does not give it. How files are read: altiplan/kit/formats/input_file.hpp.
std::string file_problem(const std::filesystem::path& file);
}  // namespace altiplan::host
