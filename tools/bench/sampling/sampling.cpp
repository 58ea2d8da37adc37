// SPDX-License-Identifier: Apache-2.0
// What sampling planners are made of and those planners, beside plain ways of doing it and beside
// OMPL. A row is timed only after its answers have been compared or judged.
#include "google_rows.hpp"
#include "rows.hpp"

void altiplan::bench::add_sampling(Subcommands& all) {
  add_google(all, "sampling", "time sampling planners and their parts beside plain ways and OMPL",
             [](const Given& given) {
               add_point_rows();
               add_connect_rows(*given.registry);
               add_star_rows(*given.registry);
               add_tree_rows(*given.registry);
             });
}
