// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <string>

#include "measuring.hpp"

namespace altiplan::bench {

/// Queries of a row, in cyclic order.
inline constexpr std::size_t kQueries = 4096;

/// A row of the table: the time of one call of ask(n), n below kQueries.
template <class Ask>
void add_row(const std::string& name, const Ask& ask) {
  benchmark::RegisterBenchmark(name.c_str(), [ask](benchmark::State& state) {
    std::size_t n = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(ask(n));
      n = (n + 1) % kQueries;
    }
  });
}

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
