// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace altiplan::host {

/// Hexadecimal SHA-256 of a file's bytes; "" if it is not a file or not readable. Throws
/// MachineFault if the machine fails to provide it: an empty sum would read as a changed file.
std::string sha256(const std::filesystem::path& file);
std::string sha256_of(std::string_view bytes);
/// SHA-256 of an existing file; throws MachineFault with the reason if two attempts to read it
/// fail, since an unreadable file is not a changed file. "" for a folder.
std::string sha256_of_present(const std::filesystem::path& file);
}  // namespace altiplan::host
