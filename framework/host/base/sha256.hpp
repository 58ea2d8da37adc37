// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace altiplan::host {

/// Hexadecimal SHA-256 of a file's bytes; "" where it is none or may not be read. Throws
/// MachineFault where the machine does not give it: no sum would say that it is another file.
std::string sha256(const std::filesystem::path& file);
std::string sha256_of(std::string_view bytes);
/// Of a file that is there: throws MachineFault, saying why, where it cannot be read twice. What
/// cannot be read is not another file. Of a folder "".
std::string sha256_of_present(const std::filesystem::path& file);
}  // namespace altiplan::host
