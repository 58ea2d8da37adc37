// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace altiplan::host {

/// In zlib's format (RFC 1950); level 1 is the fastest, 9 the smallest.
std::string compressed(std::string_view bytes, int level);
/// Throws Error where it is damaged.
std::string decompressed(std::string_view bytes);
}  // namespace altiplan::host
