// SPDX-License-Identifier: Apache-2.0
// Planners and smoothers under objectives: astar against Dijkstra's algorithm, written here, over
// every edge of the lattice.
#include <gtest/gtest.h>

#include <map>
#include <queue>

#include "altiplan/error.hpp"
#include "exposure_worlds_test.hpp"

namespace altiplan::exposure_planners_test {
namespace {
using exposure_test::objective_of;
using exposure_test::random_values;
using testing::make_planner;

constexpr double kCell = 10;

/// A weighted sum that also depends on the direction of flight: climbing costs, sinking does not.
class Mixed final : public Objective {
 public:
  Mixed(std::shared_ptr<const Objective> exposure, std::shared_ptr<const Objective> altitude)
      : exposure_(std::move(exposure)), altitude_(std::move(altitude)) {}

 private:
  double do_cost(const Leg& leg, double time_s, const Request& request) const override {
    return exposure_->cost(leg, time_s, request) + altitude_->cost(leg, time_s, request) / 50 +
           leg.length() / 4 + 2 * std::max(0.0, leg.to.z() - leg.from.z());
  }
  double do_bound(const Vec3& from, const Vec3& to, const Request& request) const override {
    return exposure_->bound(from, to, request) + altitude_->bound(from, to, request) / 50 +
           (to - from).norm() / 4 + 2 * std::max(0.0, to.z() - from.z());
  }
  std::string do_unit() const override { return ""; }
  Traits do_traits() const override { return {.heading = true}; }

  std::shared_ptr<const Objective> exposure_;
  std::shared_ptr<const Objective> altitude_;
};

/// Of what the balls leave: prices by clearance, of a world that stays alive meanwhile.
std::shared_ptr<const Objective> by_clearance(const Request& request) {
  Site site;
  site.before = request.world.get();
  site.volume = request.volume;
  return testing::make_objective(
      "exposure", "{of: clearance, cell_m: [13, 11, 9], price: [[0, 6], [12, 1], [40, 0.2]]}",
      site);
}

/// Among balls over a field; the objective by turns: none, exposure, altitude, the sum, some
/// by the clearance.
Request random_request(SplitMix64& random, int number) {
  const auto centre = [&](int cells) { return kCell * (random.integer(0, cells - 1) + 0.5); };
  std::vector<Shape> balls;
  for (int n = random.integer(0, 12); n > 0; --n) {
    balls.emplace_back(
        Sphere{{120 * random.uniform(), 90 * random.uniform(), 40 * random.uniform()},
               5 + 15 * random.uniform()});
  }
  Request request =
      testing::request_in(testing::world_of(std::move(balls)), {centre(12), centre(9), centre(4)},
                          {centre(12), centre(9), centre(4)}, {{0, 0, 0}, {120, 90, 40}});
  const bool voids = number % 8 < 4;
  const auto exposure =
      objective_of(random_values(random, voids), number % 3 == 0 ? "" : ", elsewhere: 4");
  const std::shared_ptr<const Objective> altitude = testing::make_objective("altitude");
  const std::shared_ptr<const Objective> all[] = {nullptr, exposure, altitude,
                                                  std::make_shared<Mixed>(exposure, altitude)};
  request.objective =
      number % 16 == 2 || number % 16 == 9 ? by_clearance(request) : all[number % 4];
  return request;
}

/// Least cost of a path over the cells, whose edges join neighbours; infinite if there is none.
double dijkstra(const Request& request) {
  using Key = std::array<int, 3>;
  const auto place = [](const Key& k) {
    return Vec3(kCell * (k[0] + 0.5), kCell * (k[1] + 0.5), kCell * (k[2] + 0.5));
  };
  const auto key = [](const Vec3& p) {
    return Key{int(p.x() / kCell), int(p.y() / kCell), int(p.z() / kCell)};
  };
  const Key goal = key(request.goal.position);
  std::map<Key, double> best{{key(request.start.position), 0}};
  std::priority_queue<std::pair<double, Key>, std::vector<std::pair<double, Key>>, std::greater<>>
      open;
  open.push({0, best.begin()->first});
  while (!open.empty()) {
    const auto [cost, from] = open.top();
    open.pop();
    if (from == goal) {
      return cost;
    }
    if (cost > best.at(from)) {
      continue;
    }
    for (int d = 0; d < 27; ++d) {
      const Key to{from[0] + d % 3 - 1, from[1] + d / 3 % 3 - 1, from[2] + d / 9 - 1};
      if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= 12 || to[1] >= 9 || to[2] >= 4) {
        continue;
      }
      const double there = cost + cost_of(Leg::straight(place(from), place(to)), request);
      const auto known = best.find(to);
      if (there < kInfinity && (known == best.end() || there < known->second) &&
          leg_ok(std::nullopt, place(from), place(to), request)) {
        best[to] = there;
        open.push({there, to});
      }
    }
  }
  return kInfinity;
}

void hold_to_dijkstra(int first, int worlds) {
  SplitMix64 random(std::uint64_t(first) + 7);
  int solved = 0;
  for (int world = first; world < first + worlds; ++world) {
    const Request request = random_request(random, world);
    if (impossible_ends(request)) {
      continue;
    }
    const double minimum = dijkstra(request);
    for (const char* planner : {"astar", "bidirectional_astar"}) {
      for (const char* more : {"", ", heuristic: zero", ", anytime: true",
                               ", state: cell_and_heading, max_memory_mb: 64"}) {
        SCOPED_TRACE(std::to_string(world) + " " + planner + more);
        const PlanResult result =
            make_planner(planner, "{cell_m: [10, 10, 10]" + std::string(more) + "}")->plan(request);
        if (minimum == kInfinity) {
          EXPECT_EQ(result.status, PlanStatus::no_route) << result.message;
          continue;
        }
        ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
        const double cost = cost_of(result.route, request);
        EXPECT_NEAR(cost, minimum, 1e-7 * minimum);
        EXPECT_LE(min_cost(request), cost * (1 + 1e-9));
        EXPECT_TRUE(check(result.route, request).ok());
        ++solved;
      }
    }
  }
  EXPECT_GT(solved, 4 * worlds);
}

TEST(Objectives, AStarEqualsDijkstra) { hold_to_dijkstra(0, 60); }
TEST(NightlyObjectives, AStarEqualsDijkstra) { hold_to_dijkstra(60, 1000); }

TEST(Objectives, OtherPlannersKeepTheBoundAndApproachIt) {
  SplitMix64 random(11);
  int solved = 0;
  for (int world = 0; world < 40; ++world) {
    Request request = random_request(random, world);
    if (impossible_ends(request) || !request.objective) {
      continue;
    }
    const double minimum = dijkstra(request);
    for (const char* planner : {"theta_star", "lazy_theta_star", "rrt_star", "informed_rrt_star"}) {
      SCOPED_TRACE(std::to_string(world) + " " + planner);
      const bool by_cells = std::string(planner).ends_with("theta_star");
      const PlanResult result =
          make_planner(planner, by_cells ? "{cell_m: [10, 10, 10]}" : "{max_iterations: 3000}")
              ->plan(request);
      if (result.status != PlanStatus::solved) {
        EXPECT_TRUE(minimum == kInfinity || !by_cells) << result.message;
        continue;
      }
      ++solved;
      EXPECT_TRUE(check(result.route, request).ok());
      const double cost = cost_of(result.route, request);
      EXPECT_LE(min_cost(request), cost * (1 + 1e-9));
      EXPECT_LE(cost, 2 * minimum + 1);
    }
  }
  EXPECT_GT(solved, 60);
}

void hold_turns(int worlds) {
  SplitMix64 random(19);
  int solved = 0;
  double by_objective = 0;
  double by_length = 0;
  for (int world = 0; world < worlds; ++world) {
    Request request = random_request(random, world);
    if (impossible_ends(request) || !request.objective) {
      continue;
    }
    request.limits.max_climb = radians(30);
    Request shortest = request;
    shortest.objective = nullptr;
    const auto planner = make_planner("hybrid_astar", "{cell_m: 5, radius_m: 6}");
    const PlanResult result = planner->plan(request);
    const PlanResult plain = planner->plan(shortest);
    const double plain_cost =
        plain.status == PlanStatus::solved ? cost_of(plain.route, request) : kInfinity;
    if (result.status != PlanStatus::solved || plain_cost == kInfinity) {
      continue;
    }
    ++solved;
    EXPECT_TRUE(check(result.route, request).ok());
    const double cost = cost_of(result.route, request);
    EXPECT_LE(min_cost(request), cost * (1 + 1e-9));
    by_objective += cost;
    by_length += plain_cost;
  }
  EXPECT_GT(solved, worlds * 3 / 8);
  EXPECT_LT(by_objective, 0.9 * by_length);
}

TEST(Objectives, TurnsOfHybridAStarCostLessThanItsShortestRoute) { hold_turns(12); }
TEST(NightlyObjectives, TurnsOfHybridAStarCostLessThanItsShortestRoute) { hold_turns(40); }

TEST(Objectives, SmoothersNeverRaiseTheCost) {
  SplitMix64 random(13);
  int changed = 0;
  for (int world = 0; world < 80; ++world) {
    Request request = random_request(random, world);
    if (impossible_ends(request) || !request.objective) {
      continue;
    }
    const PlanResult plan = make_planner("astar", "{cell_m: [10, 10, 10]}")->plan(request);
    if (plan.status != PlanStatus::solved) {
      continue;
    }
    for (const char* smoother : {"prune", "shortcut", "bspline", "waypoint_reduction", "trim"}) {
      const PlanResult smooth = testing::make_smoother(smoother)->smooth(plan.route, request);
      EXPECT_FALSE(costs_more(cost_of(smooth.route, request), cost_of(plan.route, request)))
          << smoother;
      changed += smooth.route != plan.route ? 1 : 0;
    }
  }
  EXPECT_GT(changed, 60);
}

TEST(Objectives, PlannersThatMinimiseLengthRefuse) {
  SplitMix64 random(17);
  Request request = random_request(random, 1);
  for (const char* planner : {"jps", "rrt", "sipp", "anya", "dstar_lite"}) {
    const PlanResult result = make_planner(planner)->plan(request);
    EXPECT_EQ(result.status, PlanStatus::invalid_problem) << planner;
    EXPECT_NE(result.message.find("minimises length alone, not an objective"), std::string::npos)
        << result.message;
  }
  EXPECT_THROW(make_planner("astar", "{weight_altitude: 1}")->plan(request), ParameterError);
}
}  // namespace
}  // namespace altiplan::exposure_planners_test
