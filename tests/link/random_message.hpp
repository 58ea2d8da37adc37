// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "altiplan/random.hpp"
#include "link/messages.hpp"

namespace altiplan::link {

/// Visits a message and fills its fields with random bytes; some are zero, so that packets are
/// truncated. Numbers are finite: of a NaN others do not keep every bit.
struct RandomFields {
  RandomStream& random;
  double zeros;

  void extensions() {}
  void operator()(std::string_view /*name*/, auto& value) { fill(value); }

  template <class T, std::size_t N>
  void fill(std::array<T, N>& values) {
    for (T& value : values) {
      fill(value);
    }
  }
  template <class T>
  void fill(T& value) {
    if (random.uniform() < zeros) {
      value = 0;
    } else if constexpr (std::is_floating_point_v<T>) {
      value = static_cast<T>(random.uniform(-1e6, 1e6));
    } else if constexpr (std::is_same_v<T, char>) {
      value = static_cast<char>(random.integer('a', 'z'));
    } else {
      const auto bits = random();
      std::memcpy(&value, &bits, sizeof value);
    }
  }
};

template <std::size_t... I>
Message message_at(std::size_t index, std::index_sequence<I...> /*alternatives*/) {
  Message message;
  (void)((I == index && (message.emplace<I>(), true)) || ...);
  return message;
}

/// A message of any type, with random fields.
inline Message random_message(RandomStream& random) {
  constexpr std::size_t kTypes = std::variant_size_v<Message>;
  Message message = message_at(static_cast<std::size_t>(random.integer(0, kTypes - 1)),
                               std::make_index_sequence<kTypes>());
  RandomFields fill{random, random.uniform()};
  std::visit([&](auto& one) { one.describe(fill); }, message);
  return message;
}
}  // namespace altiplan::link
