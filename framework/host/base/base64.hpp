// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace altiplan::host {

/// Base64 (RFC 4648, with padding).
std::string base64(std::span<const std::byte> bytes);
/// Throws Error where the text is not base64.
std::vector<std::byte> from_base64(std::string_view text);

/// Of the values as they lie in memory: little-endian on every machine that altiplan runs on.
template <class Value>
std::string base64_of(const std::vector<Value>& values) {
  return base64(std::as_bytes(std::span(values)));
}
}  // namespace altiplan::host
