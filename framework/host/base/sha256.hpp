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
}  // namespace altiplan::host
