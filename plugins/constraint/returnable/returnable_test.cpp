// SPDX-License-Identifier: Apache-2.0
// Against a referee written here: ways home by Bellman and Ford over all legs between cells, routes
// by exhaustive fronts of what they cost and use.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/random.hpp"
#include "support/support.hpp"

namespace altiplan::testing::returnable_test {
namespace {

constexpr double kCell = 10;
constexpr std::array<int, 3> kCells{7, 5, 4};
constexpr int kCount = kCells[0] * kCells[1] * kCells[2];
constexpr double kPower = 100;

std::array<int, 3> cell(int n) {
  return {n % kCells[0], n / kCells[0] % kCells[1], n / kCells[0] / kCells[1]};
}
Vec3 place(int n) {
  const auto c = cell(n);
  return kCell * Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
}
int number(const Vec3& p) {
  const Vec3 c = p / kCell;
  return (int(c.z()) * kCells[1] + int(c.y())) * kCells[0] + int(c.x());
}

class Referee {
 public:
  Referee(const Request& request, const std::vector<Vec3>& homes)
      : request_(request), homes_(homes), home_(kCount, kInfinity) {
    for (int from = 0; from < kCount; ++from) {
      for (int to = 0; to < kCount; ++to) {
        const Vec3 way = (place(to) - place(from)) / kCell;
        if (from != to && way.cwiseAbs().maxCoeff() < 1.5 && flies(place(from), place(to))) {
          legs_.push_back({from, to, used(place(from), place(to))});
        }
      }
    }
    for (const Vec3& home : homes) {
      if (flies(home, home)) {
        home_[std::size_t(number(home))] = 0;
      }
    }
    for (bool changes = true; changes;) {
      changes = false;
      for (const Step& leg : legs_) {
        const double way = leg.wh + home_[std::size_t(leg.to)];
        changes = changes || way < home_[std::size_t(leg.from)];
        home_[std::size_t(leg.from)] = std::min(home_[std::size_t(leg.from)], way);
      }
    }
  }

  double used(const Vec3& a, const Vec3& b) const {
    return kPower * leg_duration(Leg::straight(a, b), request_) / 3600;
  }
  /// From anywhere, over cells at most one edge away.
  double home(const Vec3& p) const {
    double best = kInfinity;
    for (const Vec3& home : homes_) {
      best = std::min(best, flies(p, home) ? used(p, home) : kInfinity);
    }
    for (int n = 0; n < kCount; ++n) {
      const double apart = (place(n) - p).cwiseAbs().maxCoeff();
      if (apart < kCell && flies(p, place(n))) {
        best = std::min(best, (apart > 0 ? used(p, place(n)) : 0) + home_[std::size_t(n)]);
      }
    }
    return best;
  }

  /// The least cost of routes over cells that keep the maximum everywhere with the way home.
  double best(double maximum) const {
    std::vector<std::vector<std::array<double, 2>>> fronts(kCount);
    const auto add = [&](int to, const std::array<double, 2>& path) {
      auto& front = fronts[std::size_t(to)];
      if (costs_more(path[1] + home(place(to)), maximum) ||
          std::any_of(front.begin(), front.end(), [&](const auto& other) {
            return !costs_more(other[0], path[0]) && !costs_more(other[1], path[1]);
          })) {
        return false;
      }
      front.push_back(path);
      return true;
    };
    add(number(request_.start.position), {0, 0});
    for (bool changes = true; changes;) {
      changes = false;
      for (const Step& leg : legs_) {
        const double cost = cost_of(Leg::straight(place(leg.from), place(leg.to)), request_);
        for (const auto& path : std::vector(fronts[std::size_t(leg.from)])) {
          changes |= add(leg.to, {path[0] + cost, path[1] + leg.wh});
        }
      }
    }
    double best = kInfinity;
    for (const auto& path : fronts[std::size_t(number(request_.goal.position))]) {
      best = std::min(best, path[0]);
    }
    return best;
  }

  /// By how much a route uses more than it may, with the way home, where that is worst.
  double beyond(const Route& route, double maximum) const {
    double sum = 0;
    double worst = home(route.front());
    for (std::size_t i = 1; i < route.size(); ++i) {
      sum += used(route[i - 1], route[i]);
      worst = std::max(worst, sum + home(route[i]));
    }
    return worst - maximum;
  }

 private:
  struct Step {
    int from;
    int to;
    double wh;
  };
  bool flies(const Vec3& a, const Vec3& b) const { return leg_ok(std::nullopt, a, b, request_); }

  Request request_;
  std::vector<Vec3> homes_;
  std::vector<Step> legs_;
  std::vector<double> home_;
};

/// Among balls, in wind that blows harder above.
Request random_request(SplitMix64& random) {
  const auto centre = [&] { return place(int(random.integer(0, kCount - 1))); };
  std::vector<Shape> balls;
  for (int n = int(random.integer(2, 8)); n > 0; --n) {
    balls.emplace_back(Sphere{{70 * random.uniform(), 50 * random.uniform(), 40 * random.uniform()},
                              5 + 12 * random.uniform()});
  }
  Request request =
      request_in(world_of(std::move(balls)), centre(), centre(), {{0, 0, 0}, {70, 50, 40}});
  request.vehicle.speed_mps = 10;
  request.vehicle.climb_mps = 2;
  request.vehicle.sink_mps = 3;
  request.wind.layers = {{-kInfinity, {4 * random.uniform(), -2, 0}},
                         {20, {-7 * random.uniform(), 3, 0}}};
  return request;
}

std::string text_of(double maximum, const std::vector<Vec3>& homes) {
  std::string yaml = "{cell_m: [10, 10, 10], power_w: 100, maximum_wh: " + std::to_string(maximum);
  yaml += ", homes: [";
  for (const Vec3& home : homes) {
    yaml += "{at_m: [" + std::to_string(home.x()) + ", " + std::to_string(home.y()) + ", " +
            std::to_string(home.z()) + "]},";
  }
  return yaml + "]}";
}

void hold_to_referee(int first, int worlds) {
  SplitMix64 random(std::uint64_t(first) + 5);
  int changed = 0;
  int refused = 0;
  std::map<std::string, int> solved;
  for (int world = first; world < first + worlds; ++world) {
    SCOPED_TRACE(world);
    Request request = random_request(random);
    request.objective = world % 3 == 0   ? nullptr
                        : world % 3 == 1 ? make_objective("time")
                                         : make_objective("altitude");
    std::vector<Vec3> homes{request.start.position};
    if (world % 4 == 0) {
      homes.push_back(place(int(random.integer(0, kCount - 1))));
    }
    if (!start_problem(request).empty() || !goal_problem(request).empty() ||
        request.start.position == request.goal.position) {
      continue;
    }
    const Referee referee(request, homes);
    const auto planner = make_planner("astar", "{cell_m: [10, 10, 10]}");
    const PlanResult without = planner->plan(request);
    if (without.status != PlanStatus::solved) {
      EXPECT_EQ(referee.best(kInfinity), kInfinity);
      continue;
    }
    const double needed = referee.beyond(without.route, 0);
    const double maximum = std::max(
        1e-3, std::round(1e6 * std::min(needed, 1.0) * (0.5 + 0.7 * random.uniform())) / 1e6);
    apply_constraints(request,
                      {{"returnable", make_constraint("returnable", text_of(maximum, homes))}},
                      AppliesTo::route);
    // The judge refuses what the planner finds without it where the referee does.
    EXPECT_EQ(check(without.route, request).ok(), needed <= maximum * (1 + 1e-9));
    const double best = referee.best(maximum);
    const PlanResult found = planner->plan(request);
    if (best == kInfinity) {
      EXPECT_EQ(found.status, PlanStatus::no_route) << found.message;
      EXPECT_TRUE(found.proved);
      ++refused;
    } else {
      ASSERT_EQ(found.status, PlanStatus::solved) << found.message;
      EXPECT_NEAR(cost_of(found.route, request), best, 1e-6 * best);
      changed += best > cost_of(without.route, request) * (1 + 1e-9);
    }
    request.budget.max_iterations = 400;
    for (const char* name : {"astar", "theta_star", "lazy_theta_star", "rrt_star"}) {
      const bool is_lattice = std::string(name) != "rrt_star";
      const PlanResult result =
          make_planner(name, is_lattice ? "{cell_m: [10, 10, 10]}" : "{range_m: 25}")
              ->plan(request);
      if (result.status == PlanStatus::solved) {
        EXPECT_TRUE(check(result.route, request).ok()) << name;
        EXPECT_LE(referee.beyond(result.route, maximum), 1e-6 * maximum) << name;
        solved[name] += best < kInfinity;
      }
    }
  }
  EXPECT_GT(changed, worlds / 40);
  EXPECT_GT(refused, worlds / 40);
  EXPECT_GT(solved["theta_star"], solved["astar"] * 8 / 10);
  EXPECT_GT(solved["lazy_theta_star"], solved["astar"] * 8 / 10);
  EXPECT_GT(solved["rrt_star"], solved["astar"] / 2);
}

TEST(Returnable, PlansAreTheBestThatKeepIt) { hold_to_referee(0, 24); }
TEST(NightlyReturnable, PlansAreTheBestThatKeepIt) { hold_to_referee(24, 200); }

TEST(Returnable, TheJudgeNamesThePlaceWithoutAWayHome) {
  // Over a wall to the goal, where the wind lets nothing fly back.
  Request request = request_in({}, {5, 5, 5}, {95, 5, 5}, {{0, 0, 0}, {100, 10, 10}});
  request.vehicle.speed_mps = 10;
  Wing wing;
  wing.airspeed_mps = 10;
  request.vehicle.wing = wing;
  request.wind.layers = {{-kInfinity, {12, 0, 0}}};
  apply_constraints(
      request,
      {{"returnable",
        make_constraint("returnable", "{cell_m: [10, 10, 10], power_w: 100, maximum_wh: 90}")}},
      AppliesTo::route);
  const Route route{{5, 5, 5}, {55, 5, 5}, {95, 5, 5}};
  const CheckResult judged = check(route, request);
  ASSERT_EQ(judged.violations.size(), 1);
  EXPECT_EQ(judged.violations[0].constraint, "returnable");
  EXPECT_EQ(judged.violations[0].at, 1);
  EXPECT_NE(judged.violations[0].message.find("no way home"), std::string::npos);
  for (const char* planner : {"astar", "theta_star"}) {
    const PlanResult none = make_planner(planner, "{cell_m: [10, 10, 10]}")->plan(request);
    EXPECT_EQ(none.status, PlanStatus::no_route);
    EXPECT_NE(none.message.find("pruned by returnable"), std::string::npos) << none.message;
  }
}

TEST(Returnable, TreesNameItWhereItAloneRefusesThem) {
  // 0.25 Wh there and as much back.
  Request request = request_in({}, {5, 5, 5}, {95, 5, 5}, {{0, 0, 0}, {100, 10, 10}});
  request.vehicle.speed_mps = 10;
  request.budget.max_iterations = 400;
  apply_constraints(request, {{"returnable", make_constraint("returnable", text_of(0.3, {}))}},
                    AppliesTo::route);
  for (const char* planner : {"rrt_star", "informed_rrt_star"}) {
    const PlanResult none = make_planner(planner, "{range_m: 25}")->plan(request);
    EXPECT_NE(none.status, PlanStatus::solved);
    EXPECT_NE(none.message.find("refused by returnable ("), std::string::npos) << none.message;
  }
}

TEST(Returnable, NamesItselfWhereItsCellsDoNotFit) {
  Request request = request_in({}, {5, 5, 5}, {95, 5, 5}, {{0, 0, 0}, {100, 10, 10}});
  apply_constraints(request,
                    {{"returnable", make_constraint("returnable",
                                                    "{cell_m: [1e-3, 1e-3, 1e-3], power_w: 100, "
                                                    "maximum_wh: 90}")}},
                    AppliesTo::route);
  try {
    make_planner("astar", "{cell_m: [10, 10, 10]}")->plan(request);
    ADD_FAILURE();
  } catch (const ParameterError& error) {  // as if it were the planner's own
    ADD_FAILURE() << error.what();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'returnable': cell_m"), std::string::npos);
  }
}

TEST(Returnable, StopsCountUntilEachWaypoint) {
  Request request = request_in({}, {5, 5, 5}, {105, 5, 5}, {{0, 0, 0}, {110, 10, 10}});
  request.vehicle.speed_mps = 10;
  request.vehicle.acceleration.mps2 = 2;
  const Route route{{5, 5, 5}, {55, 5, 5}, {105, 5, 5}};
  // Two legs of 5 s and v / a = 5 s each; 10 s back.
  const double wh = 100 * 30.0 / 3600;
  const auto judged = [&](double maximum) {
    Request limited = request;
    apply_constraints(limited,
                      {{"returnable", make_constraint("returnable", text_of(maximum, {}))}},
                      AppliesTo::route);
    return check(route, limited).ok();
  };
  EXPECT_TRUE(judged(wh + 1e-4));
  EXPECT_FALSE(judged(wh - 1e-4));
}

TEST(Returnable, NeedsABatteryAndAPower) {
  EXPECT_THROW(make_constraint("returnable", "{power_w: 100}"), std::exception);
  EXPECT_THROW(make_constraint("returnable", "{maximum_wh: 100}"), std::exception);
}
}  // namespace
}  // namespace altiplan::testing::returnable_test
