// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <queue>
#include <utility>
#include <vector>

#include "altiplan/kit/sampling/leg_rules.hpp"

namespace altiplan::hybrid_astar {

/// Least length through the air to the goal, by columns of square cells: Dijkstra's search
/// backwards over the columns in which the vehicle may be at some height. Along eight directions,
/// so up to 1.0824 times the least.
class Columns {
 public:
  /// Starts and goals count as places where the vehicle may be.
  Columns(const Request& request, double cell_m, const std::vector<Pose>& starts,
          const std::vector<Pose>& goals)
      : request_(request), starts_(starts), goals_(goals), min_(request.volume.min) {
    const Vec3 extent = request.volume.max - request.volume.min;
    cell_ = std::max(cell_m, std::max(extent.x(), extent.y()) / kMaxColumns);
    nx_ = 1 + int(extent.x() / cell_);
    ny_ = 1 + int(extent.y() / cell_);
    distance_.assign(std::size_t(nx_) * std::size_t(ny_), kInfinity);
  }

  /// False if the budget ended it.
  bool search(BudgetWatch& watch) {
    const kit::LegRules rules(request_);
    std::vector<signed char> open(distance_.size(), -1);  // -1: not yet known
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Pose& start : starts_) {
      open[std::size_t(index(start.position))] = 1;
    }
    for (const Pose& goal : goals_) {
      distance_[std::size_t(index(goal.position))] = 0;
      queue.emplace(0, index(goal.position));
    }
    for (std::uint64_t n = 0; !queue.empty(); ++n) {
      if (watch.spent(0)) {
        return false;
      }
      const auto [d, column] = queue.top();
      queue.pop();
      if (d > distance_[std::size_t(column)]) {
        continue;
      }
      for (int k = 0; k < 9; ++k) {
        const int dx = k % 3 - 1;
        const int dy = k / 3 - 1;
        const int x = column % nx_ + dx;
        const int y = column / nx_ + dy;
        if (k == 4 || x < 0 || x >= nx_ || y < 0 || y >= ny_) {
          continue;
        }
        const auto next = std::size_t(y) * std::size_t(nx_) + std::size_t(x);
        const double to = d + through_air(Vec3(-dx, -dy, 0) * cell_);
        if (to < distance_[next] && is_open(rules, int(next), open)) {
          distance_[next] = to;
          queue.emplace(to, int(next));
        }
      }
    }
    return true;
  }

  /// Metres through the air to the goal; infinite if no columns lead there.
  double operator()(const Vec3& p) const {
    const Vec3 straight = request_.goal.position - p;
    const double radius = request_.goal.loiter ? request_.goal.loiter->radius : 0;
    // The ends lie anywhere in their columns, and beside their place on a loiter circle.
    const double spare = 2 * std::numbers::sqrt2 * cell_ +
                         kPi * radius / double(std::max<std::size_t>(goals_.size(), 1));
    return std::max(through_air({straight.x(), straight.y(), 0}) - through_air({radius, 0, 0}),
                    distance_[std::size_t(index(p))] - spare);
  }

 private:
  static constexpr double kMaxColumns = 512;  ///< along an axis
  static constexpr int kHeights = 9;          ///< tried in a column

  /// Length through the air of a straight leg with that displacement, in the wind that helps most.
  double through_air(const Vec3& leg) const {
    const double run = leg.norm();
    if (request_.wind.is_calm() || run == 0) {
      return run;
    }
    double fastest = 0;
    for (const Wind::Layer& layer : request_.wind.layers) {
      fastest =
          std::max(fastest, ground_speed(leg, request_.air_speed(), layer.velocity).value_or(0));
    }
    return fastest > 0 ? run / fastest * request_.air_speed() : kInfinity;
  }

  int index(const Vec3& p) const {
    const int x = std::clamp(int((p.x() - min_.x()) / cell_), 0, nx_ - 1);
    const int y = std::clamp(int((p.y() - min_.y()) / cell_), 0, ny_ - 1);
    return y * nx_ + x;
  }

  /// True if the vehicle may be at some height above the column's centre.
  bool is_open(const kit::LegRules& rules, int column, std::vector<signed char>& known) const {
    signed char& open = known[std::size_t(column)];
    if (open < 0) {
      open = is_flyable(rules, column) ? 1 : 0;
    }
    return open == 1;
  }

  bool is_flyable(const kit::LegRules& rules, int column) const {
    const int row = column / nx_;
    const double x = min_.x() + (column % nx_ + 0.5) * cell_;
    const double y = min_.y() + (row + 0.5) * cell_;
    double low = request_.level_m.value_or(request_.volume.min.z());
    double high = request_.level_m.value_or(request_.volume.max.z());
    if (const auto ground = request_.world->ground(x, y); ground && !request_.level_m) {
      low = std::max(low, *ground);
      for (const AltitudeBand& band : request_.limits.altitude) {
        const double datum = band.datum == AltitudeBand::Datum::sea ? 0 : *ground;
        low = std::max(low, datum + band.min);
        high = std::min(high, datum + band.max);
      }
      low = std::max(low, *ground + request_.limits.min_ground_clearance.value_or(0));
    }
    for (int k = 0; k < kHeights && low <= high; ++k) {
      const double z = low + (high - low) * k / (kHeights - 1);
      if (rules.point_ok({x, y, z})) {
        return true;
      }
    }
    return false;
  }

  const Request& request_;
  const std::vector<Pose>& starts_;
  const std::vector<Pose>& goals_;
  Vec3 min_;
  double cell_;
  int nx_;
  int ny_;
  std::vector<double> distance_;
};
}  // namespace altiplan::hybrid_astar
