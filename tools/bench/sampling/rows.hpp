// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include "measuring.hpp"

namespace altiplan::bench {

// Each topic adds its rows. What a row needs is made when it runs for the first time, so that
// --benchmark_filter costs nothing for rows left out; it is timed after its answers have been
// compared, and WrongAnswer names a row where they differ.
void add_point_rows();
void add_connect_rows(host::Registry& registry);
void add_star_rows(host::Registry& registry);
void add_tree_rows(host::Registry& registry);
}  // namespace altiplan::bench
