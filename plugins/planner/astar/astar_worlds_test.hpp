// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <queue>
#include <string>
#include <vector>

#include "reference/random_levels.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

/// The lengths to all cells by Dijkstra's algorithm, one entry per cell, x fastest; kInfinity where
/// there is no route. They are final up to `last`, where the search then ends.
inline std::vector<double> shortest_lengths(
    const Cell& counts, const Vec3& cell, const Cell& start, int neighbours,
    const std::function<bool(const Cell&, const Cell&)>& step_free, const Cell* last = nullptr) {
  const auto id = [&](const Cell& c) { return (c[2] * counts[1] + c[1]) * counts[0] + c[0]; };
  std::vector<double> best(std::size_t(counts[0] * counts[1] * counts[2]), kInfinity);
  using Entry = std::pair<double, Cell>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({0, start});
  best[std::size_t(id(start))] = 0;
  while (!queue.empty()) {
    const auto [g, c] = queue.top();
    queue.pop();
    if (last && c == *last) {
      return best;
    }
    if (g > best[std::size_t(id(c))]) {
      continue;
    }
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int moved = std::abs(dx) + std::abs(dy) + std::abs(dz);
          const Cell n = {c[0] + dx, c[1] + dy, c[2] + dz};
          const bool inside = n[0] >= 0 && n[1] >= 0 && n[2] >= 0 && n[0] < counts[0] &&
                              n[1] < counts[1] && n[2] < counts[2];
          if (moved == 0 || (neighbours == 6 && moved > 1) || !inside || !step_free(c, n)) {
            continue;
          }
          const double length = g + cell.cwiseProduct(Vec3(dx, dy, dz)).norm();
          if (length < best[std::size_t(id(n))]) {
            best[std::size_t(id(n))] = length;
            queue.push({length, n});
          }
        }
      }
    }
  }
  return best;
}

/// Length of the shortest path over cells by Dijkstra's algorithm; infinite if there is none.
inline double shortest(const Cell& counts, const Vec3& cell, const Cell& start, const Cell& goal,
                       int neighbours,
                       const std::function<bool(const Cell&, const Cell&)>& step_free) {
  const std::vector<double> lengths =
      shortest_lengths(counts, cell, start, neighbours, step_free, &goal);
  return lengths[std::size_t((goal[2] * counts[1] + goal[1]) * counts[0] + goal[0])];
}

/// Solid balls, in closed form.
class Balls final : public Environment {
 public:
  std::vector<Vec3> centres;
  double radius = 1;

 private:
  Box do_bounds() const override {
    Box box = Box::empty();
    for (const Vec3& c : centres) {
      box = box.with(c);
    }
    return box.grown(radius);
  }
  double do_clearance(const Vec3& p) const override {
    double minimum = kInfinity;
    for (const Vec3& c : centres) {
      minimum = std::min(minimum, (c - p).norm() - radius);
    }
    return minimum;
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    for (const Vec3& c : centres) {
      if (point_leg_distance(c, a, b) < radius + r - kLengthTolerance) {
        return true;
      }
    }
    return false;
  }
  double do_over_approximation() const override { return 0; }
};

inline std::shared_ptr<Balls> random_balls(SplitMix64& random, int count) {
  auto balls = std::make_shared<Balls>();
  balls->radius = 12;
  for (int i = 0; i < count; ++i) {
    balls->centres.push_back(
        Vec3(random.uniform() * 100, random.uniform() * 90, random.uniform() * 40));
  }
  return balls;
}

inline Request among(std::shared_ptr<const Environment> environment) {
  Request request = request_in(world_of(std::move(environment)), {5, 5, 5}, {95, 85, 35},
                               {{0, 0, 0}, {100, 90, 40}});
  request.limits.min_clearance = request.vehicle.radius_m = 1.5;
  return request;
}
}  // namespace altiplan::testing
