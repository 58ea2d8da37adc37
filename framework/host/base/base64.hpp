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
/// Throws Error if the text is not base64.
std::vector<std::byte> from_base64(std::string_view text);

/// Base64 of the values as stored in memory: little-endian on every supported machine.
template <class Value>
std::string base64_of(const std::vector<Value>& values) {
  return base64(std::as_bytes(std::span(values)));
}
}  // namespace altiplan::host
