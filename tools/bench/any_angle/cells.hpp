// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "measuring.hpp"

namespace altiplan::bench {

/// A query from cell to cell, in the map file's indices.
struct Way {
  std::array<double, 3> start;
  std::array<double, 3> goal;
};

/// A world of one layer with its own cells.
class Cells {
 public:
  /// `text`: the layer's plugin and parameters.
  Cells(host::Registry& registry, const std::string& text, const Site& site = {});

  const GridSpec& spec() const { return spec_; }
  double build_ms() const { return build_ms_; }          ///< build time of the layer
  double occupancy_ms() const { return occupancy_ms_; }  ///< time to fill the occupancy grid
  std::size_t blocked() const { return world_->voxels(spec_)->blocked_count(); }
  Request request(const Way& way) const;

 private:
  GridSpec spec_;
  std::shared_ptr<const World> world_;
  double build_ms_;
  double occupancy_ms_;
};

struct CityKind {
  bool complex = true;
  Cell counts{80, 80, 100};
  int buildings = 60;

  /// The query of paper 003, section 4, in its 80 x 80 x 100 cells; otherwise with the same
  /// distance from the sides.
  Way way() const;
};
Cells make_city(host::Registry& registry, const CityKind& kind, int seed);

/// A Warframe .3dmap.
Cells load_map(host::Registry& registry, const std::string& file);

/// Reads a query per line: start x y z, goal x y z; ignores the rest of the line, and the first two
/// lines of a .3dscen file. Empty at the end; throws Error with `name` and the line.
class Ways {
 public:
  Ways(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}
  std::optional<Way> next();

 private:
  std::istream& in_;
  std::string name_;
  int line_ = 0;
  bool is_scenario_ = false;
};

/// `count` of the queries at least `least` cells long, evenly from the shortest to the longest, in
/// the given order.
std::vector<Way> spread(std::vector<Way> ways, double min_cells, std::size_t count);
}  // namespace altiplan::bench
