// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "band.hpp"

namespace terrain_follow {

/// A position where a waypoint may be, and the heights that it may have.
struct Station {
  double s = 0;
  bool is_corner = false;  ///< a waypoint must be there
  std::vector<double> heights;
};

/// A waypoint: a station and a height of it, by their indices.
struct Node {
  std::size_t station = 0;
  std::size_t height = 0;
  auto operator<=>(const Node&) const = default;
};

struct LegLimits {
  double climb = altiplan::kInfinity;  ///< rise over run
  double sink = altiplan::kInfinity;
  double min_length = 0;
  double max_length = altiplan::kInfinity;
};

/// The profile through a band with the fewest legs, and of those with the least climb and descent,
/// by dynamic programming from station to station. Legs keep between the limits at the columns;
/// what they do between them is for the caller to find out.
class FewestLegs {
 public:
  FewestLegs(std::vector<Station> stations, std::vector<Column> columns, const LegLimits& limits);

  const std::vector<Station>& stations() const { return stations_; }
  const std::vector<Column>& columns() const { return columns_; }
  double height(const Node& node) const { return stations_[node.station].heights[node.height]; }

  void add(const Column& column);
  void forbid(const Node& from, const Node& to) { forbidden_[from].insert(to); }
  /// Empty if there is none.
  std::vector<Node> solve();

 private:
  struct Reached {
    double cost = altiplan::kInfinity;
    Node from;
  };
  static constexpr double kLeg = 1e7;  ///< cost of a leg: more metres than any route climbs

  void extend(const Node& from);
  void reach(const Node& from, std::size_t station, double low, double high);

  std::vector<Station> stations_;
  std::vector<Column> columns_;
  LegLimits limits_;
  std::map<Node, std::set<Node>> forbidden_;
  std::vector<std::vector<Reached>> reached_;
  std::vector<double> worst_;  ///< the greatest cost of a station's heights, or more
  std::vector<bool> touched_;  ///< stations whose heights got another cost
};
}  // namespace terrain_follow
