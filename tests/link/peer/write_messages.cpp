// SPDX-License-Identifier: Apache-2.0
// write_messages COUNT: random messages, one line of JSON each, with their packet in hexadecimal.
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "link/packet.hpp"
#include "link/random_message.hpp"

namespace altiplan::link {
namespace {

/// Visits a message and lists its fields as JSON; numbers of 64 bits as text.
struct FieldsAsJson {
  std::string text{};

  void extensions() {}
  template <class T>
  void operator()(std::string_view name, const T& value) {
    text += (text.empty() ? "\"" : ",\"") + std::string(name) + "\":" + json(value);
  }

  template <class T>
  static std::string json(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      char number[32];
      std::snprintf(number, sizeof number, "%.9g", double(value));
      return number;
    } else {
      return sizeof(T) == 8 ? "\"" + std::to_string(value) + "\"" : std::to_string(value);
    }
  }
  template <std::size_t N>
  static std::string json(const std::array<char, N>& value) {
    return "\"" + text_of(value) + "\"";
  }
  template <class T, std::size_t N>
  static std::string json(const std::array<T, N>& values) {
    std::string text;
    for (const T& value : values) {
      text += (text.empty() ? "" : ",") + json(value);
    }
    return "[" + text + "]";
  }
};

std::string hexadecimal(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned char>(byte));
    text += digits;
  }
  return text;
}

void write_messages(int count) {
  RandomStream random(5);
  for (int n = 0; n < count; ++n) {
    Message message = random_message(random);
    FieldsAsJson fields;
    std::visit([&](auto& one) { one.describe(fields); }, message);
    std::cout << "{\"name\":\"" << layout_of(message).name << "\",\"packet\":\""
              << hexadecimal(packet_bytes(message, {1, 2}, std::uint8_t(n))) << "\",\"fields\":{"
              << fields.text << "}}\n";
  }
}
}  // namespace
}  // namespace altiplan::link

int main(int argc, char** argv) {
  altiplan::link::write_messages(argc > 1 ? std::atoi(argv[1]) : 1000);
}
