// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/value.hpp"

namespace altiplan::study {

/// A key of `set` with one of its values.
struct Assignment {
  std::string key;    ///< "steps.0.with.weight_g"
  std::string value;  ///< YAML on one line
  std::string label;  ///< the value as part of a name: 125x125x25
  Location where;     ///< in the study file
};

/// One cell of a grid: a value for each key.
struct GridCell {
  std::string label;  ///< "[weight_g=0.3,corner=any]", of the keys that vary; "" if none does
  std::vector<Assignment> assignments;
};

/// Every combination of the values in `set`, the last key varying fastest: {a: [1, 2], b: 3, c:
/// 0..9} has 20 cells. A list always means several values; `path` is the map's key path in its
/// file. Throws ConfigError, also for more than a million cells.
std::vector<GridCell> grid_of(const Value& set, const std::string& path);

/// The value as YAML on one line, which reads back as the same value.
std::string flow_text(const Value& value);
}  // namespace altiplan::study
