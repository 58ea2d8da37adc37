// SPDX-License-Identifier: Apache-2.0
// Sampling planners and their building blocks, compared with plain implementations and OMPL. A row
// is timed only after its answers have been compared or judged.
#include "google_rows.hpp"
#include "rows.hpp"

void altiplan::bench::add_sampling(Subcommands& all) {
  add_google(all, "sampling", "time sampling planners and their parts against plain code and OMPL",
             [](const Given& given) {
               add_point_rows();
               add_connect_rows(*given.registry);
               add_star_rows(*given.registry);
               add_tree_rows(*given.registry);
             });
}
