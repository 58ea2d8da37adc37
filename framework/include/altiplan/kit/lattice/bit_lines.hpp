// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace altiplan::kit {

/// Cells of a level as lines of bits, 1 blocked: its rows or its columns. Lines and the cells in
/// them are numbered from -1, which is the border, as is everything after the last. Does not own
/// the words; a word before the first line and one after the last must be readable.
class BitLines {
 public:
  /// Number of bits, from the first of a window, that belong to the line.
  static constexpr int kWindow = 57;

  BitLines() = default;
  BitLines(const std::uint64_t* line_0, std::size_t words_per_line)
      : line_0_(reinterpret_cast<const unsigned char*>(line_0)),
        bytes_per_line_(std::ptrdiff_t(words_per_line * sizeof(std::uint64_t))) {
    static_assert(std::endian::native == std::endian::little);
  }

  /// Bits of a line, and the offset to those of the next.
  const unsigned char* line(int number) const { return line_0_ + number * bytes_per_line_; }
  std::ptrdiff_t bytes_per_line() const { return bytes_per_line_; }

  /// The cells of a line from `at` on in the direction of the scan: the first is the lowest bit
  /// (kAhead: cell numbers rise), or the highest.
  template <bool kAhead>
  static std::uint64_t window(const unsigned char* line, int at) {
    const auto from = std::size_t(at + 1);
    std::uint64_t bits = 0;
    if (kAhead) {
      std::memcpy(&bits, line + from / 8, sizeof bits);
      return bits >> from % 8;
    }
    std::memcpy(&bits, line + from / 8 - 7, sizeof bits);
    return bits << (7 - from % 8);
  }

 private:
  const unsigned char* line_0_ = nullptr;
  std::ptrdiff_t bytes_per_line_ = 0;
};

/// The first blocked cell of a line from `at` on in the direction of the scan.
template <bool kAhead>
int first_blocked(const unsigned char* line, int at) {
  for (;; at += kAhead ? BitLines::kWindow : -BitLines::kWindow) {
    if (const std::uint64_t bits = BitLines::window<kAhead>(line, at); bits != 0) {
      return kAhead ? at + std::countr_zero(bits) : at - std::countl_zero(bits);
    }
  }
}

/// The first free cell of a line from `at` on, if it is below `limit`; else some cell that is not.
inline int first_free(const unsigned char* line, int at, int limit) {
  for (; at < limit; at += BitLines::kWindow) {
    constexpr std::uint64_t kWhole = (std::uint64_t{1} << BitLines::kWindow) - 1;
    if (const std::uint64_t bits = ~BitLines::window<true>(line, at) & kWhole; bits != 0) {
      return at + std::countr_zero(bits);
    }
  }
  return at;
}
}  // namespace altiplan::kit
