// SPDX-License-Identifier: Apache-2.0
// The most frequent queries of planners to the world, compared with plain implementations, OMPL and
// FCL. All answer the same queries; a row is timed only after its answers have been compared.
#include "google_rows.hpp"
#include "rows.hpp"

void altiplan::bench::add_queries(Subcommands& all) {
  add_google(all, "queries", "time world queries against plain implementations, OMPL and FCL",
             [](const Given&) {
               add_cell_rows();
               add_terrain_rows();
               add_turn_rows();
               add_shape_rows(200);
               add_shape_rows(10000);
             });
}
