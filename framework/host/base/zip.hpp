// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace altiplan::host {

/// True of bytes that begin like a ZIP archive.
bool is_zip(std::string_view bytes);
/// An archive of these names and contents, deflated; the same content makes the same bytes.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& entries);
/// The names of its entries, in order. Throws Error for a damaged archive.
std::vector<std::string> zip_names(std::string_view zip);
/// The content of the first entry whose name ends so; none if there is no such entry. Throws Error
/// for a damaged or encrypted archive, another compression than deflate, and contents over 64 MB.
std::optional<std::string> zip_entry(std::string_view zip, std::string_view ending);
}  // namespace altiplan::host
