// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cyclic_rows.hpp"
#include "measuring.hpp"

namespace altiplan::bench {

/// Throws WrongAnswer naming the row and the first query whose answers differ.
template <class Agrees>
void require(const std::string& name, const Agrees& agrees) {
  for (std::size_t n = 0; n < kQueries; ++n) {
    if (!agrees(n)) {
      throw WrongAnswer(name + ": the answers to query " + std::to_string(n) + " differ");
    }
  }
}

/// The share of the queries with that answer, as "37 %".
template <class Ask>
std::string share(const Ask& ask) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < kQueries; ++n) {
    count += ask(n) ? 1 : 0;
  }
  return std::to_string((100 * count + kQueries / 2) / kQueries) + " %";
}

// Each compares the answers, then adds its rows.
void add_shape_rows(int count);
void add_cell_rows();
void add_terrain_rows();
void add_turn_rows();
}  // namespace altiplan::bench
