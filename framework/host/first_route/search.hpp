// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/first_route/corridor.hpp"

namespace altiplan::host {

/// Planner, cells and smoothers of a pipeline, as text.
struct Search {
  std::string steps;  ///< the list under `steps:`
  std::string words;  ///< for the user
};

/// What a search is chosen by.
struct SearchSpace {
  Box volume;
  double length_m = 0;   ///< between the points
  double spacing_m = 0;  ///< of the model's posts
  int fineness = 1;      ///< cells are that much smaller
};

/// "[250, 250, 50]": cells on which a search without a limit above is quick.
std::string open_cells(const SearchSpace& space);

/// A search that answers in seconds. The wish's planner gets cells if it takes them.
Search choose_search(const RouteWish& wish, const WishedHeights& heights, const SearchSpace& space,
                     Registry& registry);
}  // namespace altiplan::host
