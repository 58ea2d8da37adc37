// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include "measuring.hpp"

namespace altiplan::bench {

// Each topic adds its rows. A row's data are created when it first runs, so that rows excluded by
// --benchmark_filter cost nothing; it is timed after its answers have been compared, and
// WrongAnswer names a row whose answers differ.
void add_point_rows();
void add_connect_rows(host::Registry& registry);
void add_star_rows(host::Registry& registry);
void add_tree_rows(host::Registry& registry);
}  // namespace altiplan::bench
