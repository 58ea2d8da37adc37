// SPDX-License-Identifier: Apache-2.0
#include "host/view/png.hpp"

#include <zlib.h>

#include <string_view>

#include "altiplan/error.hpp"
#include "host/base/deflate.hpp"

namespace altiplan::host {
namespace {

std::string big_endian(std::uint32_t value) {
  return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

/// Length, type, data, and the checksum of type and data (PNG specification, section 5.3).
std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
  return big_endian(std::uint32_t(data.size())) + body + big_endian(std::uint32_t(sum));
}
}  // namespace

std::string png(int width, int height, const std::vector<std::uint8_t>& rgba) {
  const std::size_t row = 4 * std::size_t(width);
  if (width < 1 || height < 1 || rgba.size() != row * std::size_t(height)) {
    throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels cannot have " + std::to_string(rgba.size()) + " bytes");
  }
  // Each row as differences from the pixel on the left: filter 1, "Sub".
  std::string rows;
  rows.reserve((row + 1) * std::size_t(height));
  for (std::size_t begin = 0; begin < rgba.size(); begin += row) {
    rows += '\1';
    for (std::size_t i = 0; i < row; ++i) {
      rows += char(rgba[begin + i] - (i < 4 ? 0 : rgba[begin + i - 4]));
    }
  }
  const std::string header = big_endian(std::uint32_t(width)) + big_endian(std::uint32_t(height)) +
                             std::string("\x08\x06\x00\x00\x00", 5);  // 8 bits, RGBA
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", compressed(rows, 9)) +
         chunk("IEND", "");
}
}  // namespace altiplan::host
