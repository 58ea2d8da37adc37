// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/search.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

std::string number(double value) { return with_digits(value, 6); }

/// The next length with a simple number, not below the value.
double simple(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (step * decade >= value * (1 - 1e-9)) {
      return step * decade;
    }
  }
  return 10 * decade;
}

struct Cells {
  double across = 0;
  double high = 0;
};

double extent(const Box& volume) { return (volume.max - volume.min).head<2>().maxCoeff(); }

/// In open space a search is quick on cells of a 160th of the volume. Within a band above ground,
/// they are a quarter of the band high, and not so wide that ground of 45 degrees leaves it between
/// two of them.
Cells cells_of(const WishedHeights& heights, const SearchSpace& space) {
  constexpr double kMaxCells = 8e7;  // of 25 bytes, of which a search touches few
  const Vec3 size = space.volume.max - space.volume.min;
  Cells cells;
  if (heights.max_m) {
    const double band = *heights.max_m - heights.min_m;
    cells.high = std::max(2.0, band / 4) / space.fineness;
    cells.across = std::max({extent(space.volume) / 600, std::min(space.spacing_m, band), 5.0}) /
                   space.fineness;
  } else {
    cells.high = simple(std::clamp(size.z() / 40, 5.0, 50.0) / space.fineness);
    cells.across = std::max(extent(space.volume) / 160, 5.0) / space.fineness;
  }
  const double min_across = std::sqrt(size.x() * size.y() * size.z() / cells.high / kMaxCells);
  cells.across = simple(std::max(cells.across, min_across));
  return cells;
}

std::string list_of(const Cells& cells) {
  const std::string across = number(cells.across);
  return "[" + across + ", " + across + ", " + number(cells.high) + "]";
}

/// The parameters of hybrid_astar.
std::string pose_cells(const RouteWish& wish, const WishedHeights& heights,
                       const SearchSpace& space) {
  const double across = std::max(*wish.turn_radius_m, extent(space.volume) / 300) / space.fineness;
  const double high = heights.max_m ? std::max(5.0, (*heights.max_m - heights.min_m) / 4) : 25;
  return "{cell_m: " + number(simple(across)) + ", cell_height_m: " + number(high) +
         ", weight_h: " + (heights.max_m ? "5" : "2") + "}";
}

Search wing_search(const RouteWish& wish, const WishedHeights& heights, const SearchSpace& space) {
  const std::string poses = "with: " + pose_cells(wish, heights, space);
  const char* budget = "within_iterations: 60000";
  if (wish.planner == "hybrid_astar" || (!wish.planner && heights.max_m)) {
    return {"  - plan: hybrid_astar\n    " + poses + "\n    " + budget + "\n  - smooth: shortcut\n",
            "hybrid_astar " + poses.substr(6) + ", then shortcut"};
  }
  if (wish.planner) {
    return {"  - plan: " + *wish.planner + "\n  - smooth: shortcut\n",
            *wish.planner + ", then shortcut"};
  }
  return {
      "  - plan: rrt_star\n    with: {max_iterations: " + std::to_string(20000 * space.fineness) +
          "}\n    else:\n      - plan: hybrid_astar\n" + "        " + poses + "\n        " +
          budget + "\n  - smooth: shortcut\n",
      "rrt_star over poses, else hybrid_astar, then shortcut"};
}

/// True if the planner has the parameter `cell_m` with a length for each axis.
bool takes_cells(const std::string& planner, Registry& registry) {
  const ParamReport report = registry.get("planner", planner).describe(nullptr, "");
  return std::any_of(report.fields.begin(), report.fields.end(), [](const BoundField& field) {
    return field.spec.name == "cell_m" && field.value_json.rfind('[', 0) == 0;
  });
}
}  // namespace

std::string open_cells(const SearchSpace& space) { return list_of(cells_of({}, space)); }

Search choose_search(const RouteWish& wish, const WishedHeights& heights, const SearchSpace& space,
                     Registry& registry) {
  if (wish.turn_radius_m) {
    return wing_search(wish, heights, space);
  }
  const std::string planner = wish.planner.value_or("theta_star");
  const Cells cells = cells_of(heights, space);
  Search search{"  - plan: " + planner + "\n", planner};
  if (takes_cells(planner, registry)) {
    search.steps += "    with: {cell_m: " + list_of(cells) + "}\n";
    search.words += ", cell_m: " + list_of(cells);
  }
  if (!heights.max_m) {
    search.steps += "  - smooth: shortcut\n  - smooth: prune\n";
    search.words += ", then shortcut and prune";
    return search;
  }
  // prune looks at all pairs of waypoints, terrain_follow at all stations.
  const bool is_pruned = wish.planner && space.length_m / cells.across < 350;
  search.steps += is_pruned ? "  - smooth: prune\n" : "";
  search.steps += "  - smooth: terrain_follow\n    with: {station_m: " +
                  number(simple(std::max(space.length_m / 1000, 25.0))) + ", height_step_m: 2}\n";
  search.words += std::string(", then ") + (is_pruned ? "prune and " : "") + "terrain_follow";
  return search;
}
}  // namespace altiplan::host
