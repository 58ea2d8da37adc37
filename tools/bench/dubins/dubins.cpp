// SPDX-License-Identifier: Apache-2.0
// Lengths and paths under a turn radius, compared with OMPL's Dubins state space.
#include "google_rows.hpp"
#include "rows.hpp"

void altiplan::bench::add_dubins(Subcommands& all) {
  add_google(all, "dubins", "time paths under a turn radius, lengths against OMPL",
             [](const Given&) {
               for (const PosePairs& pairs :
                    {PosePairs{"easy", 10}, PosePairs{"hard", 2}, PosePairs{"far", 100}}) {
                 add_length_rows(pairs);
                 add_path_rows(pairs);
               }
             });
}
