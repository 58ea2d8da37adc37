// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace altiplan::link {

inline constexpr std::uint16_t kChecksumStart = 0xffff;

/// CRC-16/MCRF4XX; `start` continues one.
std::uint16_t checksum(std::string_view bytes, std::uint16_t start = kChecksumStart);
}  // namespace altiplan::link
