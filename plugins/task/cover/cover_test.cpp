// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/environment.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/kit/tour.hpp"
#include "altiplan/world.hpp"
#include "support/posts.hpp"
#include "support/support.hpp"

namespace altiplan::cover_task_test {
namespace {

const char* const kIslands =
    "holes_m: [[[30, 30], [32, 55], [50, 52], [45, 28]], [[65, 60], [60, 75], [80, 85], [85, 66]]]";

Request copter() {
  Request request = testing::request_in({}, {0, 0, 0}, {0, 0, 0}, {{-1e3, -1e3, 0}, {1e3, 1e3, 0}});
  request.vehicle.speed_mps = 3;
  request.vehicle.acceleration.mps2 = 1;
  return request;
}

Polyline waypoints(const TaskOrder& order, const TaskEnds& ends) {
  return order.route(ends, copter()).waypoints();
}

/// Share of the free places of a hectare that the passes alone come within 1.5 m of.
double covered(const TaskOrder& order, const Environment* islands) {
  RandomStream random(7);
  int free = 0;
  int near = 0;
  while (free < 40'000) {
    const Vec3 p = random.in({{0, 0, 0}, {100, 100, 0}});
    if (islands != nullptr && islands->clearance(p) <= 0) {
      continue;
    }
    ++free;
    near += std::any_of(order.passes.begin(), order.passes.end(), [&](const Pass& pass) {
      for (std::size_t i = 1; i < pass.points.size(); ++i) {
        if (point_leg_distance(p, pass.points[i - 1], pass.points[i]) <= 1.5) {
          return true;
        }
      }
      return false;
    });
  }
  return double(near) / free;
}

TEST(Cover, CoversAroundIslandsAndComesBack) {
  const auto task = testing::make_task("cover", "{" + std::string(kIslands) + "}");
  const TaskOrder order = task->order(copter(), {});
  ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
  const auto islands = task->obstacles();
  EXPECT_GE(covered(order, islands.get()), 0.9997);  // 99.99 %, but for the noise of samples
  const Polyline route = waypoints(order, {});
  EXPECT_EQ(route.front(), route.back());
  for (std::size_t i = 1; i < route.size(); ++i) {
    EXPECT_FALSE(islands->blocked(route[i - 1], route[i], 0)) << i;
  }
  EXPECT_NEAR(order.time_s, flown_time(route, copter()), 1e-6);
  EXPECT_GE(order.bound_s, 0.8 * order.time_s);
  EXPECT_LE(order.bound_s, order.time_s);
}

/// The best published tour of the empty square takes 1,385.18 s.
TEST(Cover, ComesBackAlongAStripThatItCovers) {
  const TaskOrder order = testing::make_task("cover")->order(copter(), {});
  EXPECT_LT(order.time_s, 1370);
  EXPECT_GE(covered(order, nullptr), 0.9997);
}

TEST(Cover, BeginsAndEndsWhereItIsAsked) {
  const auto task = testing::make_task("cover", "{" + std::string(kIslands) + "}");
  const TaskEnds corner{Vec3(0, 0, 5), {}};
  const TaskOrder around = task->order(copter(), corner);
  EXPECT_EQ(waypoints(around, corner).front(), Vec3(0, 0, 5));
  EXPECT_EQ(waypoints(around, corner).back(), Vec3(0, 0, 5));
  const TaskEnds across{Vec3(0, 0, 0), Vec3(100, 100, 0)};
  const TaskOrder over = task->order(copter(), across);
  EXPECT_EQ(waypoints(over, across).front(), Vec3(0, 0, 0));
  EXPECT_EQ(waypoints(over, across).back(), Vec3(100, 100, 0));
  EXPECT_GE(covered(over, task->obstacles().get()), 0.9997);
  const TaskEnds beside{Vec3(-50, 20, 0), {}};
  const TaskOrder from_beside = task->order(copter(), beside);
  EXPECT_EQ(waypoints(from_beside, beside)[1], Vec3(0, 20, 0));  // where it enters the area
  EXPECT_EQ(waypoints(from_beside, beside).back(), Vec3(-50, 20, 0));
  const TaskEnds within{Vec3(40, 40, 0), {}};
  EXPECT_EQ(task->order(copter(), within).status, PlanStatus::invalid_problem);
  const auto open = testing::make_task("cover", "{closed: false, " + std::string(kIslands) + "}");
  EXPECT_LT(open->order(copter(), {}).time_s, around.time_s);
}

TEST(Cover, FlightsKeepTheCapacityAndShareAPlace) {
  const auto task = testing::make_task("cover", "{capacity_s: 500, " + std::string(kIslands) + "}");
  const TaskOrder order = task->order(copter(), {});
  ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
  const Vec3 home = order.passes[0].points[0];
  const Polyline route = waypoints(order, {});
  Polyline flight{home};
  int flights = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    flight.push_back(route[i]);
    if (route[i] == home) {
      EXPECT_LE(flown_time(Route(flight), copter()), 500 + 1e-6);
      flight = {home};
      ++flights;
    }
  }
  EXPECT_EQ(flight.size(), 1U);
  EXPECT_GE(flights, 3);
  EXPECT_EQ(std::count_if(order.passes.begin(), order.passes.end(),
                          [](const Pass& pass) { return pass.takes_off; }),
            flights);
  EXPECT_GE(covered(order, task->obstacles().get()), 0.9997);
  const auto small = testing::make_task("cover", "{capacity_s: 20}");
  EXPECT_EQ(small->order(copter(), {}).status, PlanStatus::no_route);
}

/// Three squares of 40 m in a row, the middle one last.
const char* const kSquares =
    "outline_m: [[0, 0], [40, 0], [40, 40], [0, 40]], name: west, more_areas: ["
    "{outline_m: [[400, 0], [440, 0], [440, 40], [400, 40]], name: east}, "
    "{outline_m: [[200, 0], [240, 0], [240, 40], [200, 40]], "
    "holes_m: [[[210, 10], [210, 30], [230, 20]]], name: middle}]";

/// Share of the squares, but for the island, that the passes come within 1.5 m of.
double squares_covered(const TaskOrder& order, const Environment& island) {
  RandomStream random(7);
  int free = 0;
  int near = 0;
  while (free < 20'000) {
    const Vec3 p = random.in({{0, 0, 0}, {440, 40, 0}});
    if (std::fmod(p.x(), 200) > 40 || island.clearance(p) <= 0) {
      continue;
    }
    ++free;
    near += std::any_of(order.passes.begin(), order.passes.end(), [&](const Pass& pass) {
      for (std::size_t i = 1; i < pass.points.size(); ++i) {
        if (point_leg_distance(p, pass.points[i - 1], pass.points[i]) <= 1.5) {
          return true;
        }
      }
      return false;
    });
  }
  return double(near) / free;
}

TEST(Cover, CoversSeveralAreasInAGoodOrder) {
  const auto task = testing::make_task("cover", "{" + std::string(kSquares) + "}");
  const auto island = task->obstacles();
  for (const TaskEnds& ends :
       {TaskEnds{}, TaskEnds{Vec3(-50, 20, 0), {}}, TaskEnds{Vec3(-50, 20, 0), Vec3(500, 20, 0)}}) {
    const TaskOrder order = task->order(copter(), ends);
    ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
    EXPECT_GE(squares_covered(order, *island), 0.9997);
    const Polyline route = waypoints(order, ends);
    EXPECT_EQ(route.back(), ends.goal.value_or(route.front()));
    double between = 0;  // the squares
    for (std::size_t i = 1; i < route.size(); ++i) {
      EXPECT_FALSE(island->blocked(route[i - 1], route[i], 0)) << i;
      between += (route[i] - route[i - 1]).norm() > 100 ? (route[i] - route[i - 1]).norm() : 0;
    }
    EXPECT_NEAR(between, ends.goal ? 320 : ends.start ? 770 : 680, 15);
    EXPECT_NEAR(order.time_s, flown_time(route, copter()), 1e-6);
  }
}

TEST(Cover, FlightsOverSeveralAreasBeginBesideThem) {
  const auto task = testing::make_task("cover", "{capacity_s: 450, " + std::string(kSquares) + "}");
  const TaskEnds ends{Vec3(-50, 20, 0), {}};
  const TaskOrder order = task->order(copter(), ends);
  ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
  EXPECT_GE(squares_covered(order, *task->obstacles()), 0.9997);
  const Polyline route = waypoints(order, ends);
  Polyline flight{*ends.start};
  int flights = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    flight.push_back(route[i]);
    if (route[i] == *ends.start) {
      EXPECT_LE(flown_time(Route(flight), copter()), 450 + 1e-6);
      flight = {*ends.start};
      ++flights;
    }
  }
  EXPECT_EQ(flight.size(), 1U);
  EXPECT_GE(flights, 3);
  EXPECT_EQ(task->order(copter(), {}).status, PlanStatus::solved);  // from a place of its own
}

TEST(Cover, NamesTheAreaThatCannotBeFlown) {
  const auto said = [](const std::string& more) {
    try {
      return testing::make_task("cover", "{name: home, more_areas: [" + more + "]}")
          ->order(copter(), {})
          .message;
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(said("{name: pond, outline_m: [[90, 50], [200, 50], [200, 90]]}")
                .find("the area 'home' and the area 'pond' overlap"),
            std::string::npos);
  EXPECT_NE(said("{name: pond, outline_m: [[200, 0], [300, 90], [300, 0], [200, 90]]}")
                .find("the area 'pond': the outline meets itself"),
            std::string::npos);
  EXPECT_NE(said("{outline_m: [[200, 0], [200.1, 0], [200.1, 0.1]]}")
                .find("area 1 is too small for a line"),
            std::string::npos);
  // Within an island there is no way in.
  EXPECT_THROW(testing::make_task("cover",
                                  "{holes_m: [[[10, 10], [90, 10], [90, 90], [10, 90]]], "
                                  "more_areas: [{outline_m: [[20, 20], [60, 20], [60, 60]]}]}"),
               Error);
  // Fields that share an edge, to a millimetre.
  EXPECT_EQ(said("{outline_m: [[99.999, 0], [200, 0], [200, 100], [99.999, 100]]}"), "");
}

TEST(Cover, EndsWithItsBudget) {
  const auto task = testing::make_task("cover");
  Request request = copter();
  request.budget.max_iterations = 0;
  EXPECT_EQ(task->order(request, {}).status, PlanStatus::timed_out);
  request.budget.max_iterations = 10;
  const TaskOrder first = task->order(request, {});
  EXPECT_EQ(first.status, PlanStatus::solved);
  EXPECT_TRUE(first.budget_hit);
  EXPECT_LE(task->order(copter(), {}).time_s, first.time_s);
}

/// Ground of ridges and hollows, 20 m between posts.
World hills() {
  constexpr int kPosts = 9;
  std::vector<float> heights;
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      heights.push_back(float(200 + 15 * std::sin(1.3 * i) * std::cos(0.9 * j)));
    }
  }
  return testing::world_of(std::make_shared<testing::Posts>(
      HeightField({-30, -30}, {20, 20}, kPosts, kPosts, std::move(heights))));
}

TEST(Cover, FollowsTheGroundWithinTheTolerance) {
  const World world = hills();
  const auto task = testing::make_task(
      "cover",
      "{above_ground_m: 60, tolerance_m: 1.5, spacing_m: 12, " + std::string(kIslands) + "}",
      world);
  const TaskOrder order = task->order(copter(), {});
  ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
  const Polyline route = waypoints(order, {});
  std::size_t level = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    EXPECT_GE(world.ground_gap(route[i - 1], route[i]), 58.5 - 1e-6) << i;
    EXPECT_LE(world.ground_gap_max(route[i - 1], route[i]), 61.5 + 1e-6) << i;
    level += route[i - 1].z() == route[i].z();
  }
  EXPECT_LT(level, route.size() / 2);
  EXPECT_NEAR(order.time_s, flown_time(route, copter()), 1e-6);
  EXPECT_LE(order.bound_s, order.time_s);
  // Beyond the model there is no ground.
  const auto wide = testing::make_task(
      "cover", "{above_ground_m: 60, outline_m: [[0, 0], [300, 0], [300, 100]]}", world);
  EXPECT_THROW(static_cast<void>(wide->order(copter(), {})), Error);
}

TEST(Cover, KeepsClearOfIslands) {
  const auto task = testing::make_task("cover", "{clearance_m: 2, " + std::string(kIslands) + "}");
  const TaskOrder order = task->order(copter(), {});
  ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
  const auto islands = task->obstacles();
  const Polyline route = waypoints(order, {});
  double nearest = kInfinity;
  for (std::size_t i = 1; i < route.size(); ++i) {
    EXPECT_FALSE(islands->blocked(route[i - 1], route[i], 2 - 1e-6)) << i;
    nearest = std::min(nearest, islands->clearance(route[i]));
  }
  EXPECT_LT(nearest, 2.1);
  EXPECT_THROW(testing::make_task(
                   "cover", "{clearance_m: 5, holes_m: [[[2, 40], [98, 40], [98, 60], [2, 60]]]}"),
               Error);
}

/// Turns of 40 m.
Request aeroplane() {
  Request request = testing::request_in({}, {0, 0, 0}, {0, 0, 0}, {{-1e3, -1e3, 0}, {1e3, 1e3, 0}});
  Wing wing;
  wing.airspeed_mps = 15.05;
  request.vehicle.speed_mps = wing.airspeed_mps;
  request.vehicle.wing = wing;
  return request;
}

const char* const kField =
    "outline_m: [[0, 0], [500, 60], [460, 380], [-40, 300]], "
    "holes_m: [[[180, 140], [240, 150], [230, 200]]], spacing_m: 30, clearance_m: 45, "
    "beyond_m: 60";

TEST(Cover, AnAeroplaneFliesStraightRowsBeyondTheArea) {
  const auto task = testing::make_task("cover", "{closed: false, " + std::string(kField) + "}");
  const TaskOrder order = task->order(aeroplane(), {});
  ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
  const auto islands = task->obstacles();
  const Vec3 along = (order.passes[0].points.back() - order.passes[0].points[0]).normalized();
  double joins = 0;
  for (std::size_t i = 0; i < order.passes.size(); ++i) {
    const Polyline& row = order.passes[i].points;
    ASSERT_GE(row.size(), 2U);
    for (std::size_t j = 1; j < row.size(); ++j) {
      EXPECT_NEAR(std::abs((row[j] - row[j - 1]).normalized().dot(along)), 1, 1e-9);
    }
    for (double t = 0; t <= 1; t += 0.001) {
      const Vec3 p = row[0] + t * (row.back() - row[0]);
      EXPECT_GE(islands->clearance(p), 0.894 * 45) << i << ": " << p.transpose();
    }
    joins += i > 0 ? (row[0] - order.passes[i - 1].points.back()).norm() : 0;
  }
  // Neighbours are too near to turn from one to the next: others are flown in between.
  EXPECT_GT(joins, double(order.passes.size() - 1) * 50);
  RandomStream random(3);
  int places = 0;
  const Polyline corners{{0, 0, 0}, {500, 60, 0}, {460, 380, 0}, {-40, 300, 0}};
  const auto is_within = [&](const Vec3& p) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 way = corners[(i + 1) % corners.size()] - corners[i];
      const Vec3 off = p - corners[i];
      if (way.x() * off.y() - way.y() * off.x() < 0) {
        return false;
      }
    }
    return islands->clearance(p) > 120;  // beyond corners of its clearance, and a strip
  };
  while (places < 20'000) {
    const Vec3 p = random.in({{-40, 0, 0}, {500, 380, 0}});
    if (!is_within(p)) {
      continue;
    }
    ++places;
    EXPECT_TRUE(std::any_of(order.passes.begin(), order.passes.end(), [&](const Pass& pass) {
      const Vec3 way = (pass.points.back() - pass.points[0]).normalized();
      const double at = (p - pass.points[0]).dot(way);
      const double end = (pass.points.back() - pass.points[0]).norm();
      return (p - pass.points[0] - at * way).norm() <= 15 + 1e-6 && at >= 0 && at <= end;
    })) << p.transpose();
  }
  // Each has its beginning and its end, and where it goes on beyond the outline those of its leads.
  for (const Pass& pass : order.passes) {
    const Polyline& row = pass.points;
    for (const bool begins : {true, false}) {
      const Vec3& end = begins ? row.front() : row.back();
      if (islands->clearance(end) > 100) {
        ASSERT_GE(row.size(), 3U);
        EXPECT_NEAR((end - (begins ? row[1] : row[row.size() - 2])).norm(), 60, 1e-9);
        EXPECT_FALSE(is_within(end));
      }
    }
  }
}

/// Of a strip whose middle lies outside, or beyond a gap, each part has its row.
TEST(Cover, AnAeroplaneCoversAreasWithArms) {
  const Polyline corners{{0, 0, 0},     {400, 0, 0},    {400, 300, 0},  {600, 300, 0},
                         {600, 160, 0}, {1000, 160, 0}, {1000, 400, 0}, {0, 400, 0}};
  std::string ring;
  for (const Vec3& p : corners) {
    ring +=
        (ring.empty() ? "[" : ", [") + std::to_string(p.x()) + ", " + std::to_string(p.y()) + "]";
  }
  for (const char* beyond : {"60", "0"}) {
    const auto task = testing::make_task(
        "cover", "{closed: false, spacing_m: 100, beyond_m: " + std::string(beyond) +
                     ", outline_m: [" + ring + "]}");
    const TaskOrder order = task->order(aeroplane(), {});
    ASSERT_EQ(order.status, PlanStatus::solved) << order.message;
    RandomStream random(4);
    for (int n = 0; n < 20'000; ++n) {
      const Vec3 p = random.in({{0, 0, 0}, {1000, 400, 0}});
      bool is_within = false;
      for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
        const Vec3& a = corners[i];
        const Vec3& b = corners[j];
        is_within ^= (a.y() > p.y()) != (b.y() > p.y()) &&
                     p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      }
      EXPECT_TRUE(!is_within || std::any_of(order.passes.begin(), order.passes.end(),
                                            [&](const Pass& pass) {
                                              return point_leg_distance(p, pass.points.front(),
                                                                        pass.points.back()) <=
                                                     50 + 1e-6;
                                            }))
          << beyond << ": " << p.transpose();
    }
  }
}

/// Dubins's paths there and back are equal but for rounding, which local search must not chase.
TEST(Cover, AnAeroplanesRowsAreOrderedInTheEnd) {
  RandomStream random(5);
  for (int n = 0; n < 60; ++n) {
    std::string ring;
    for (const Vec3& corner :
         {Vec3(0, 0, 0), Vec3(500, 0, 0), Vec3(500, 400, 0), Vec3(0, 400, 0)}) {
      const Vec3 p = corner + random.in({{-60, -60, 0}, {60, 60, 0}});
      ring +=
          (ring.empty() ? "[" : ", [") + std::to_string(p.x()) + ", " + std::to_string(p.y()) + "]";
    }
    const auto task = testing::make_task(
        "cover",
        "{closed: false, clearance_m: 48, beyond_m: 60, spacing_m: " + std::to_string(20 + 2 * n) +
            ", outline_m: [" + ring + "], holes_m: [[[220, 180], [280, 185], [260, 240]]]}");
    const TaskOrder order = task->order(aeroplane(), {});
    EXPECT_EQ(order.status, PlanStatus::solved) << order.message;
  }
}

/// A cost that is rounded one way otherwise than the other is no gain, there and back for ever.
TEST(Tour, EndsOnCostsThatDifferByDirection) {
  constexpr std::size_t kEnds = 24;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SplitMix64 random(seed);
    std::vector<Vec3> at(kEnds);
    std::generate(at.begin(), at.end(), [&] {
      return Vec3(std::floor(4 * random.uniform()), std::floor(4 * random.uniform()), 0);
    });
    std::vector<double> cost(kEnds * kEnds);
    for (std::size_t n = 0; n < cost.size(); ++n) {
      cost[n] = (at[n / kEnds] - at[n % kEnds]).norm() + 1e-6 * random.uniform();
    }
    kit::Tour tour(kEnds / 2, std::move(cost));
    tour.construct();
    EXPECT_GT(tour.cost(), 0);
  }
}

/// Dams a metre wide, between two stations of a row, are as much ground as hills are.
TEST(Cover, AnAeroplaneKeepsItsHeightOverDams) {
  constexpr int kPosts = 400;
  std::vector<float> heights(kPosts * kPosts, 300);
  for (int k = 0; k < kPosts; ++k) {
    heights[std::size_t(162 * kPosts + k)] = heights[std::size_t(k * kPosts + 162)] = 310;
  }
  const World world = testing::world_of(std::make_shared<testing::Posts>(
      HeightField({-100, -100}, {1, 1}, kPosts, kPosts, std::move(heights))));
  const TaskOrder order =
      testing::make_task("cover",
                         "{closed: false, above_ground_m: 60, tolerance_m: 2, spacing_m: 40, "
                         "beyond_m: 20, outline_m: [[0, 0], [200, 0], [200, 200], [0, 200]]}",
                         world)
          ->order(aeroplane(), {});
  EXPECT_EQ(order.status, PlanStatus::no_route);
  EXPECT_NE(order.message.find("is too rough"), std::string::npos) << order.message;
}

TEST(Cover, AnAeroplaneClimbsNoSteeperThanItCan) {
  constexpr int kPosts = 40;
  std::vector<float> heights;  // ridges from south to north: slopes of 25 % across
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      heights.push_back(float(200 + 25 * std::abs(i % 10 - 5) + 2 * std::abs(j % 7 - 3)));
    }
  }
  const World world = testing::world_of(std::make_shared<testing::Posts>(
      HeightField({-1000, -1000}, {100, 100}, kPosts, kPosts, std::move(heights))));
  const auto order_of = [&](const char* tolerance, const Request& request) {
    return testing::make_task(
               "cover",
               std::string("{closed: false, above_ground_m: 200, outline_m: [[0, 0], "
                           "[900, 0], [900, 400], [0, 400]], spacing_m: 80, "
                           "beyond_m: 60, tolerance_m: ") +
                   tolerance + "}",
               world)
        ->order(request, {});
  };
  const auto steepest = [&](const TaskOrder& order, double tolerance) {
    double slope = 0;
    for (const Pass& pass : order.passes) {
      for (std::size_t i = 1; i < pass.points.size(); ++i) {
        const Vec3 way = pass.points[i] - pass.points[i - 1];
        slope = std::max(slope, std::abs(way.z()) / way.head<2>().norm());
        EXPECT_GE(world.ground_gap(pass.points[i - 1], pass.points[i]), 200 - tolerance - 1e-6);
        EXPECT_LE(world.ground_gap_max(pass.points[i - 1], pass.points[i]), 200 + tolerance + 1e-6);
      }
    }
    return slope;
  };
  const double limit = std::tan(aeroplane().vehicle.wing->climb);  // 17.6 %
  const TaskOrder across = order_of("40", aeroplane());
  ASSERT_EQ(across.status, PlanStatus::solved) << across.message;
  EXPECT_LE(steepest(across, 40), limit);
  // Rows across the ridges are shorter in all, but only those along them keep 5 m.
  const TaskOrder along = order_of("5", aeroplane());
  ASSERT_EQ(along.status, PlanStatus::solved) << along.message;
  EXPECT_GT(along.passes.size(), across.passes.size());
  EXPECT_LE(steepest(along, 5), limit);
  // With the wind it climbs less by the metre.
  Request windy = aeroplane();
  windy.wind.layers = {{-kInfinity, {8, 0, 0}}};
  const TaskOrder slow = order_of("40", windy);
  ASSERT_EQ(slow.status, PlanStatus::solved) << slow.message;
  EXPECT_LE(steepest(slow, 40), limit * 15.05 / 23.05);
  Request weak = aeroplane();
  weak.vehicle.wing->climb = radians(0.5);
  const TaskOrder none = order_of("0.2", weak);
  EXPECT_EQ(none.status, PlanStatus::no_route);
  EXPECT_NE(none.message.find("is too steep"), std::string::npos) << none.message;
}

TEST(Cover, RefusesAreasThatAreNone) {
  const auto tiny =
      testing::make_task("cover", "{outline_m: [[0, 0], [1, 0], [1, 1]], spacing_m: 30}");
  const TaskOrder none = tiny->order(copter(), {});
  EXPECT_EQ(none.status, PlanStatus::no_route);
  EXPECT_NE(none.message.find("too small"), std::string::npos) << none.message;
  EXPECT_THROW(testing::make_task("cover", "{outline_m: [[0, 0], [9, 9], [9, 0], [0, 9]]}"), Error);
  EXPECT_THROW(testing::make_task("cover", "{holes_m: [[[90, 90], [110, 90], [95, 95]]]}"), Error);
  EXPECT_NE(testing::parameter_problems("task", "cover", "{spacing_m: 0}"), "");
  EXPECT_NE(testing::parameter_problems("task", "cover", "{closed: false, capacity_s: 9}"), "");
}
}  // namespace
}  // namespace altiplan::cover_task_test
