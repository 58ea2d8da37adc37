// SPDX-License-Identifier: Apache-2.0
#include "host/base/base64.hpp"

#include <array>
#include <bit>
#include <cstdint>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

static_assert(std::endian::native == std::endian::little, "scenes hold little-endian numbers");

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr char kPadding = '=';

std::uint32_t digit(char letter) {
  const std::size_t at = kDigits.find(letter);
  if (at == std::string_view::npos) {
    throw Error(std::string("'") + letter + "' is not a base64 character");
  }
  return std::uint32_t(at);
}
}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8 | (i < count ? std::to_integer<std::uint32_t>(bytes[at + i]) : 0);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += i <= count ? kDigits[group >> (18 - 6 * i) & 63] : kPadding;
    }
  }
  return text;
}

std::vector<std::byte> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) {
    throw Error("expected base64 in groups of four characters, found " +
                std::to_string(text.size()) + " characters");
  }
  std::size_t padding = 0;
  while (padding < 2 && text.size() > padding && text[text.size() - 1 - padding] == kPadding) {
    ++padding;
  }
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t at = 0; at < text.size(); at += 4) {
    const std::size_t count = at + 4 == text.size() ? 3 - padding : 3;
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      group = group << 6 | (i <= count ? digit(text[at + i]) : 0);
    }
    for (std::size_t i = 0; i < count; ++i) {
      bytes.push_back(std::byte(group >> (16 - 8 * i) & 255));
    }
  }
  return bytes;
}
}  // namespace altiplan::host
