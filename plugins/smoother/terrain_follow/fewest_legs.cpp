// SPDX-License-Identifier: Apache-2.0
#include "fewest_legs.hpp"

#include <algorithm>
#include <cmath>

namespace terrain_follow {
using altiplan::kInfinity;

namespace {
constexpr double kRounding = 1e-9;  // metres
}  // namespace

FewestLegs::FewestLegs(std::vector<Station> stations, std::vector<Column> columns,
                       const LegLimits& limits)
    : stations_(std::move(stations)), columns_(std::move(columns)), limits_(limits) {}

void FewestLegs::add(const Column& column) {
  const auto after = std::upper_bound(columns_.begin(), columns_.end(), column.s,
                                      [](double s, const Column& other) { return s < other.s; });
  columns_.insert(after, column);
}

std::vector<Node> FewestLegs::solve() {
  reached_.clear();
  for (const Station& station : stations_) {
    reached_.emplace_back(station.heights.size());
  }
  reached_.front().front().cost = 0;
  worst_.assign(stations_.size(), kInfinity);
  const Reached& goal = reached_.back().front();
  for (std::size_t i = 0; i + 1 < stations_.size(); ++i) {
    touched_.assign(stations_.size(), false);
    for (std::size_t k = 0; k < stations_[i].heights.size(); ++k) {
      if (reached_[i][k].cost + kLeg < goal.cost) {
        extend({i, k});
      }
    }
    for (std::size_t j = i + 1; j < stations_.size(); ++j) {
      if (touched_[j]) {
        worst_[j] =
            std::max_element(reached_[j].begin(), reached_[j].end(),
                             [](const Reached& a, const Reached& b) { return a.cost < b.cost; })
                ->cost;
      }
    }
  }
  std::vector<Node> nodes;
  Node node{stations_.size() - 1, 0};
  if (reached_.back().front().cost < kInfinity) {
    for (; node.station > 0; node = reached_[node.station][node.height].from) {
      nodes.push_back(node);
    }
    nodes.push_back({0, 0});
    std::reverse(nodes.begin(), nodes.end());
  }
  return nodes;
}

/// The funnel of slopes that lead through all columns so far (Imai and Iri's feasible directions).
void FewestLegs::extend(const Node& from) {
  const double s0 = stations_[from.station].s;
  const double z0 = height(from);
  double steepest_down = -limits_.sink;
  double steepest_up = limits_.climb;
  std::size_t next = from.station + 1;
  auto column = std::upper_bound(columns_.begin(), columns_.end(), s0,
                                 [](double s, const Column& other) { return s < other.s; });
  for (; column != columns_.end() && next < stations_.size(); ++column) {
    const double run = column->s - s0;
    steepest_down = std::max(steepest_down, (column->low - kRounding - z0) / run);
    steepest_up = std::min(steepest_up, (column->high + kRounding - z0) / run);
    if (steepest_down > steepest_up || run > limits_.max_length + altiplan::kLengthTolerance) {
      return;
    }
    if (column->s == stations_[next].s) {
      reach(from, next, z0 + run * steepest_down, z0 + run * steepest_up);
      if (stations_[next].is_corner) {
        return;
      }
      ++next;
    }
  }
}

void FewestLegs::reach(const Node& from, std::size_t station, double low, double high) {
  const std::vector<double>& heights = stations_[station].heights;
  const double z0 = height(from);
  const double run = stations_[station].s - stations_[from.station].s;
  const double cost = reached_[from.station][from.height].cost + kLeg;
  if (heights.empty() || cost >= worst_[station]) {
    return;
  }
  touched_[station] = true;
  const auto found = forbidden_.find(from);
  const double minimum = run < limits_.min_length ? limits_.min_length : 0;
  auto k = std::size_t(std::lower_bound(heights.begin(), heights.end(), low - kRounding) -
                       heights.begin());
  for (; k < heights.size() && heights[k] <= high + kRounding; ++k) {
    const double climb = std::abs(heights[k] - z0);
    Reached& there = reached_[station][k];
    if (cost + climb >= there.cost ||
        (minimum > 0 && std::hypot(run, climb) < minimum - altiplan::kLengthTolerance) ||
        (found != forbidden_.end() && found->second.count({station, k}) > 0)) {
      continue;
    }
    there = {cost + climb, from};
  }
}
}  // namespace terrain_follow
