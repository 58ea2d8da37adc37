// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/layers/mean_cost.hpp"
#include "altiplan/kit/sampling/leg_rules.hpp"
#include "heap.hpp"

namespace altiplan::hybrid_astar {

/// Least length through the air to the goal, by columns of square cells in which the vehicle may be
/// at some height. Along eight directions, so up to 1.0824 times the least. An A* search backwards
/// from the goal, resumed whenever a column is asked for that it has not closed (D. Silver:
/// Cooperative Pathfinding. AIIDE 2005): columns that no pose comes to are never looked at.
class Columns {
 public:
  /// Starts and goals count as places where the vehicle may be.
  Columns(const Request& request, double cell_m, const std::vector<Pose>& starts,
          const std::vector<Pose>& goals)
      : request_(request), goals_(goals), rules_(request), min_(request.volume.min) {
    const Vec3 extent = request.volume.max - request.volume.min;
    cell_ = std::max(cell_m, std::max(extent.x(), extent.y()) / kMaxColumns);
    nx_ = 1 + int(extent.x() / cell_);
    ny_ = 1 + int(extent.y() / cell_);
    columns_.resize(std::size_t(nx_) * std::size_t(ny_));
    start_ = index(request.start.position);
    for (const std::vector<Pose>* ends : {&starts, &goals}) {
      for (const Pose& end : *ends) {
        columns_[std::size_t(index(end.position))].is_open = 1;
      }
    }
    for (int k = 0; k < 9; ++k) {
      const int row = k / 3;
      steps_[std::size_t(k)] = through_air(Vec3(1 - k % 3, 1 - row, 0) * cell_);
    }
  }

  /// Begins the search. The watch must outlive it.
  void begin(BudgetWatch& watch) {
    watch_ = &watch;
    for (const Pose& goal : goals_) {
      const int column = index(goal.position);
      columns_[std::size_t(column)].distance = 0;
      queue_.push({to_start(column), column});
    }
  }

  /// Metres through the air to the goal; infinite if no columns lead there.
  double operator()(const Vec3& p) {
    if (request_.objective) {
      return by_objective(p);
    }
    const double radius = request_.goal.loiter ? request_.goal.loiter->radius : 0;
    // The ends lie anywhere in their columns, and beside their place on a loiter circle.
    const double spare = 2 * std::numbers::sqrt2 * cell_ +
                         kPi * radius / double(std::max<std::size_t>(goals_.size(), 1));
    return std::max(straight(p) - through_air({radius, 0, 0}), from_column(index(p)) - spare);
  }
  /// The same by a straight leg to the goal's position.
  double straight(const Vec3& p) const {
    const Vec3 leg = request_.goal.position - p;
    return through_air({leg.x(), leg.y(), 0});
  }

  /// Middle of the heights between limits above ground; none without such a limit from above.
  std::optional<double> middle_above_ground(double x, double y) const {
    const auto is_ceiling = [](const AltitudeBand& band) {
      return band.datum == AltitudeBand::Datum::ground && band.max < kInfinity;
    };
    const std::vector<AltitudeBand>& bands = request_.limits.altitude;
    if (request_.level_m || std::none_of(bands.begin(), bands.end(), is_ceiling)) {
      return std::nullopt;
    }
    const auto [low, high] = heights(x, y);
    return (low + high) / 2;
  }

  /// After a search that has found no columns from the start to the goal: which of the two is shut
  /// in, the one with fewer columns around it, and by what.
  std::string shut_in() {
    const std::vector<int> starts = around(start_);
    const std::vector<int> goals = around(index(goals_.front().position));
    const bool is_start = open_of(starts) < open_of(goals);
    kit::LegRules refused(request_);
    for (const int column : is_start ? starts : goals) {
      if (!is_open(column)) {
        const Vec3 p = centre(column);
        const auto [low, high] = heights(p.x(), p.y());
        const Vec3 middle(p.x(), p.y(), (low + high) / 2);
        refused.ok(std::nullopt, middle, middle);
      }
    }
    const std::string by = refused.refusals();
    return std::string("the ") + (is_start ? "start" : "goal") + " is shut in on " +
           std::to_string(open_of(is_start ? starts : goals)) + " of " +
           std::to_string(columns_.size()) + " columns of cells" +
           (by.empty() ? "" : ", around which are refused " + by);
  }

 private:
  static constexpr double kMaxColumns = 512;  ///< along an axis
  static constexpr int kHeights = 9;          ///< tried in a column

  /// Of columns on equally short paths, those nearer to the start first; distances may be longer by
  /// that share.
  static constexpr double kNearer = 1 + 1e-6;

  struct Column {
    double distance = kInfinity;  ///< to the goal
    bool is_closed = false;       ///< the distance is the least
    signed char is_open = -1;     ///< -1: not yet known
  };
  struct Entry {
    double f;
    int column;
    bool operator<(const Entry& other) const { return f < other.f; }
  };

  /// Least distance of the column; 0 once the budget is spent, for a search that is about to end.
  double from_column(int asked) {
    const Column& column = columns_[std::size_t(asked)];
    if (!column.is_closed && !is_open(asked)) {
      return kInfinity;
    }
    while (!column.is_closed && !queue_.empty()) {
      if (watch_->spent(0)) {
        return 0;
      }
      expand();
    }
    return column.distance;
  }

  void expand() {
    const int at = queue_.top().column;
    queue_.pop();
    Column& column = columns_[std::size_t(at)];
    if (column.is_closed) {
      return;
    }
    column.is_closed = true;
    if (!is_open(at)) {  // not before: most columns in the queue are never reached
      column.distance = kInfinity;
      return;
    }
    for_neighbours(at, [&](int next, int k) {
      const double distance =
          column.distance + (request_.objective ? step_cost(next, at) : steps_[std::size_t(k)]);
      Column& other = columns_[std::size_t(next)];
      if (distance < other.distance && !other.is_closed) {
        other.distance = distance;
        queue_.push({distance + to_start(next), next});
      }
    });
  }

  /// Lower bound on the length from the starts; 0 where no bound is consistent: the fastest of
  /// several winds differs by direction.
  double to_start(int column) const {
    const double x = column % nx_ - start_ % nx_;
    const int rows = column / nx_ - start_ / nx_;
    const double y = rows;
    const double longer = std::max(std::abs(x), std::abs(y));
    const double shorter = std::min(std::abs(x), std::abs(y));
    if (request_.objective) {
      return 0;
    }
    if (request_.wind.is_calm()) {
      const double length = cell_ * (longer + (std::numbers::sqrt2 - 1) * shorter);
      const double radius = request_.start.loiter ? request_.start.loiter->radius : 0;
      // Every start on the circle is within its radius, along eight directions and between columns.
      const double nearer = radius > 0 ? 1.1 * radius + 3 * cell_ : 0;
      return kNearer * std::max(0.0, length - nearer);
    }
    const std::vector<Wind::Layer>& layers = request_.wind.layers;
    return layers.size() == 1 && !layers.front().grid && !is_calm_below() && !request_.start.loiter
               ? kNearer * through_air(Vec3(x, y, 0) * cell_)
               : 0;
  }

  /// True if the volume reaches below the lowest layer of wind.
  bool is_calm_below() const {
    return request_.volume.min.z() < request_.wind.layers.front().above_m;
  }

  /// Length through the air of a straight leg with that displacement, in the wind that helps most.
  double through_air(const Vec3& leg) const {
    const double run = leg.norm();
    if (request_.wind.is_calm() || run == 0) {
      return run;
    }
    double fastest = is_calm_below() ? request_.air_speed() : 0;
    for (const Wind::Layer& layer : request_.wind.layers) {
      fastest = std::max(fastest,
                         layer.grid
                             ? request_.air_speed() + layer.max_speed()
                             : ground_speed(leg, request_.air_speed(), layer.velocity).value_or(0));
    }
    return fastest > 0 ? run / fastest * request_.air_speed() : kInfinity;
  }

  /// Cost to the goal by the objective, as through the middles of columns, but no less than its
  /// bound.
  double by_objective(const Vec3& p) {
    const int column = index(p);
    Vec3 middle = centre(column);
    middle.z() = p.z();
    const double over_columns =
        from_column(column) - request_.objective->cost(Leg::straight(p, middle), 0, request_);
    const bool is_point = request_.goal.tolerance_m == 0 && !request_.goal.loiter;
    return std::max(over_columns,
                    is_point ? request_.objective->bound(p, request_.goal.position, request_) : 0);
  }
  /// Of a step from column to column, at the height where it costs least.
  double step_cost(int from, int to) const {
    Vec3 a = centre(from);
    Vec3 b = centre(to);
    const auto [low, high] = heights(a.x(), a.y());
    const auto* mean = dynamic_cast<const kit::MeanCost*>(request_.objective.get());
    const int count = mean != nullptr && mean->is_mean() ? 1 : kHeights;
    double minimum = kInfinity;
    for (int k = 0; k < count; ++k) {
      a.z() = b.z() = low + (high - low) * k / kHeights;
      minimum = std::min(minimum, request_.objective->cost(Leg::straight(a, b), 0, request_));
    }
    return minimum;
  }

  /// The columns that lead to this one, and those beside them that are closed to the vehicle.
  std::vector<int> around(int column) {
    std::vector<int> found{column};
    std::vector<bool> is_found(columns_.size());
    is_found[std::size_t(column)] = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!is_open(found[i])) {
        continue;
      }
      for_neighbours(found[i], [&](int next, int) {
        if (!is_found[std::size_t(next)]) {
          is_found[std::size_t(next)] = true;
          found.push_back(next);
        }
      });
    }
    return found;
  }
  std::size_t open_of(const std::vector<int>& some) {
    return std::size_t(
        std::count_if(some.begin(), some.end(), [&](int column) { return is_open(column); }));
  }

  template <class Visit>
  void for_neighbours(int column, const Visit& visit) const {
    for (int k = 0; k < 9; ++k) {
      const int x = column % nx_ + k % 3 - 1;
      const int y = column / nx_ + k / 3 - 1;
      if (k != 4 && x >= 0 && x < nx_ && y >= 0 && y < ny_) {
        visit(y * nx_ + x, k);
      }
    }
  }

  int index(const Vec3& p) const {
    const int x = std::clamp(int((p.x() - min_.x()) / cell_), 0, nx_ - 1);
    const int y = std::clamp(int((p.y() - min_.y()) / cell_), 0, ny_ - 1);
    return y * nx_ + x;
  }

  /// True if the vehicle may be at some height above the column's centre.
  bool is_open(int column) {
    signed char& open = columns_[std::size_t(column)].is_open;
    if (open < 0) {
      open = is_flyable(column) ? 1 : 0;
    }
    return open == 1;
  }

  /// The heights between the limits at a place.
  std::pair<double, double> heights(double x, double y) const {
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
    return {low, high};
  }

  /// At no height.
  Vec3 centre(int column) const {
    const int row = column / nx_;
    return min_ + Vec3(column % nx_ + 0.5, row + 0.5, 0) * cell_;
  }

  bool is_flyable(int column) const {
    const Vec3 at = centre(column);
    const auto [low, high] = heights(at.x(), at.y());
    for (int k = 0; k < kHeights && low <= high; ++k) {
      const double z = low + (high - low) * k / (kHeights - 1);
      if (rules_.point_ok({at.x(), at.y(), z})) {
        return true;
      }
    }
    return false;
  }

  const Request& request_;
  const std::vector<Pose>& goals_;
  kit::LegRules rules_;
  BudgetWatch* watch_ = nullptr;
  Vec3 min_;
  double cell_;
  int nx_;
  int ny_;
  int start_;
  std::array<double, 9> steps_{};  ///< lengths of the steps to the goal from neighbours
  std::vector<Column> columns_;
  Heap<Entry> queue_;
};
}  // namespace altiplan::hybrid_astar
