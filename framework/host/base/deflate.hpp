// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace altiplan::host {

/// Compresses to zlib's format (RFC 1950); level 1 is the fastest, 9 the smallest.
std::string compressed(std::string_view bytes, int level);
/// Empty if the result would exceed `max_bytes`. Throws Error if the data is damaged.
std::optional<std::string> decompressed(std::string_view bytes, std::size_t max_bytes);

/// The same as bare deflate (RFC 1951), as archives hold it.
std::string deflated(std::string_view bytes);
std::optional<std::string> inflated(std::string_view bytes, std::size_t max_bytes);
}  // namespace altiplan::host
