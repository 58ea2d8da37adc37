// SPDX-License-Identifier: Apache-2.0
// The resumed search over columns against Dijkstra's search over all of them.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "altiplan/shape.hpp"
#include "columns.hpp"
#include "support/support.hpp"

namespace altiplan::hybrid_astar::hybrid_astar_columns_test {
namespace {

constexpr double kCell = 50;

Request among_towers(RandomStream& random) {
  std::vector<Shape> towers;
  for (int n = 0; n < 40; ++n) {
    const Vec3 p = random.in({{-900, -900, 0}, {900, 900, 0}});
    towers.push_back(Cylinder{p.x(), p.y(), random.uniform(20, 150), 0, 300});
  }
  const Box volume{{-1000, -1000, 100}, {1000, 1000, 100}};
  Request request =
      testing::request_in(testing::world_of(towers), random.in(volume), random.in(volume), volume);
  request.level_m = 100;
  request.vehicle.speed_mps = 20;
  request.vehicle.radius_m = 5;
  apply_constraints(request, {}, AppliesTo::route);
  return request;
}

/// Lengths to the goal's column, of columns given as pairs.
class Plain {
 public:
  using Column = std::pair<int, int>;

  explicit Plain(const Request& request) : request_(request) {
    distance_[column(request.goal.position)] = 0;
    std::set<std::pair<double, Column>> open{{0, column(request.goal.position)}};
    while (!open.empty()) {
      const auto [d, at] = *open.begin();
      open.erase(open.begin());
      if (d > distance_[at]) {
        continue;
      }
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const Column next{at.first + dx, at.second + dy};
          const double to = d + through_air(Vec3(-dx, -dy, 0) * kCell);
          const auto known = distance_.find(next);
          if ((dx != 0 || dy != 0) && is_open(next) &&
              (known == distance_.end() || to < known->second)) {
            distance_[next] = to;
            open.insert({to, next});
          }
        }
      }
    }
  }
  double operator()(const Vec3& p) const {
    const auto known = distance_.find(column(p));
    return known == distance_.end() ? kInfinity : known->second;
  }

 private:
  Column column(const Vec3& p) const {
    const Vec3 at = (p - request_.volume.min) / kCell;
    return {int(at.x()), int(at.y())};
  }
  bool is_open(const Column& at) const {
    const Vec3 centre(request_.volume.min + kCell * Vec3(at.first + 0.5, at.second + 0.5, 0));
    // The border columns begin on the volume's border, and their centres lie outside.
    return at == column(request_.start.position) || at == column(request_.goal.position) ||
           (request_.volume.contains(centre) && !request_.world->blocked(centre, centre, 5));
  }
  double through_air(const Vec3& leg) const {
    double fastest = request_.wind.is_calm() ? 20 : 0;
    for (const Wind::Layer& layer : request_.wind.layers) {
      fastest = std::max(fastest, ground_speed(leg, 20, layer.velocity).value_or(0));
    }
    return leg.norm() / fastest * 20;
  }

  const Request& request_;
  std::map<Column, double> distance_;
};

TEST(HybridAstarColumns, AreThoseOfDijkstraInWhateverOrderTheyAreAskedFor) {
  RandomStream random(11);
  int finite = 0;
  for (int n = 0; n < 60; ++n) {
    Request request = among_towers(random);
    for (int layer = 0; layer < n % 3; ++layer) {
      request.wind.layers.push_back(
          {layer == 0 ? -kInfinity : 50, 9 * unit_heading(random.uniform(-kPi, kPi))});
    }
    const std::vector<Pose> starts{{request.start.position, 0}};
    const std::vector<Pose> goals{{request.goal.position, 0}};
    const Plain plain(request);
    Columns columns(request, kCell, starts, goals);
    BudgetWatch watch(request.budget);
    columns.begin(watch);
    for (int asked = 0; asked < 50; ++asked) {
      const Vec3 p = asked == 0 ? request.start.position : random.in(request.volume);
      const double straight = columns.straight(p);
      const double expected = std::max(straight, plain(p) - 2 * std::numbers::sqrt2 * kCell);
      const double got = columns(p);
      if (expected == kInfinity) {
        EXPECT_EQ(got, kInfinity) << n;
      } else {
        EXPECT_NEAR(got, expected, 1e-5 * expected) << n;
        ++finite;
      }
    }
  }
  EXPECT_GT(finite, 1500);
}

TEST(HybridAstarColumns, BelowTheLowestWindItIsCalm) {
  RandomStream random(3);
  Request request = among_towers(random);
  request.level_m.reset();
  request.volume.min.z() = 0;
  const Vec3 leg = request.goal.position - request.start.position;
  request.wind.layers = {{200, -9 * leg.normalized()}};
  const std::vector<Pose> starts{{request.start.position, 0}};
  const std::vector<Pose> goals{{request.goal.position, 0}};
  const double length = leg.head<2>().norm();
  EXPECT_NEAR(Columns(request, kCell, starts, goals).straight(request.start.position), length,
              1e-9 * length);
  request.wind.layers[0].above_m = 0;
  EXPECT_GT(Columns(request, kCell, starts, goals).straight(request.start.position), length + 1);
}
}  // namespace
}  // namespace altiplan::hybrid_astar::hybrid_astar_columns_test
