// SPDX-License-Identifier: Apache-2.0
#include "link/checksum.hpp"

namespace altiplan::link {

std::uint16_t checksum(std::string_view bytes, std::uint16_t start) {
  constexpr unsigned kPolynomial = 0x8408;  // x^16 + x^12 + x^5 + 1, low bit first
  unsigned crc = start;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 1) != 0 ? (crc >> 1) ^ kPolynomial : crc >> 1;
    }
  }
  return static_cast<std::uint16_t>(crc);
}
}  // namespace altiplan::link
