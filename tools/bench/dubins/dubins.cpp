// SPDX-License-Identifier: Apache-2.0
// Lengths and paths under a turn radius, and trees of them, compared with OMPL's Dubins state
// space.
#include "google_rows.hpp"
#include "rows.hpp"

void altiplan::bench::add_dubins(Subcommands& all) {
  add_google(all, "dubins", "time paths under a turn radius and trees of them against OMPL",
             [](const Given& given) {
               for (const PosePairs& pairs :
                    {PosePairs{"easy", 10}, PosePairs{"hard", 2}, PosePairs{"far", 100}}) {
                 add_length_rows(pairs);
                 add_path_rows(pairs);
               }
               add_dubins_star_rows(*given.registry);
             });
}
