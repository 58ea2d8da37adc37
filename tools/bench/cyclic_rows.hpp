// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <string>

namespace altiplan::bench {

/// Queries of a row, in cyclic order.
inline constexpr std::size_t kQueries = 4096;

/// A row of the table: the time of one call of ask(n), n below kQueries; its items are queries.
template <class Ask>
void add_row(const std::string& name, const Ask& ask) {
  benchmark::RegisterBenchmark(name.c_str(), [ask](benchmark::State& state) {
    std::size_t n = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(ask(n));
      n = (n + 1) % kQueries;
    }
    state.SetItemsProcessed(state.iterations());
  });
}
}  // namespace altiplan::bench
