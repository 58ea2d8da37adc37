// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan {

/// A node of a parsed file with its location. Scalars stay text: the field that reads one defines
/// its type.
struct ALTIPLAN_API Value {
  enum class Kind { scalar, list, map };
  struct Entry;

  Kind kind = Kind::scalar;
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< "5" is text, 5 a number
  std::vector<Value> items;
  std::vector<Entry> entries;  ///< in file order, keys unique
  Location where;

  const Value* find(std::string_view key) const;
  Value* find(std::string_view key);
  /// "a list", "a map", "the text 'x'" … for messages.
  std::string what() const;
};

struct Value::Entry {
  std::string key;
  Location where;
  Value value;
};
}  // namespace altiplan
