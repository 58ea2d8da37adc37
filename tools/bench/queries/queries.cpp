// SPDX-License-Identifier: Apache-2.0
// What planners ask the world most, beside the plain way of doing it and beside OMPL and FCL. All
// ask the same; a row is timed only after its answers have been compared.
#include "google_rows.hpp"
#include "rows.hpp"

void altiplan::bench::add_queries(Subcommands& all) {
  add_google(all, "queries", "time queries of the world beside plain ways, OMPL and FCL",
             [](const Given&) {
               add_cell_rows();
               add_terrain_rows();
               add_shape_rows(200);
               add_shape_rows(10000);
             });
}
