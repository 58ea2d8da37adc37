// SPDX-License-Identifier: Apache-2.0
// What ant colonies promise, in small random levels of all kinds, with parameters up to the ends of
// their ranges.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "reference/colonies.hpp"
#include "reference/random_levels.hpp"
#include "reference/random_problem.hpp"

namespace altiplan::random_colonies_test {
namespace {

using testing::counter;
using testing::equal;

/// No leg is more than twice and a half as long as the one before.
class SlowGrowth final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    return !leg.before || (leg.to - leg.from).norm() <= 2.5 * (leg.from - *leg.before).norm();
  }
};

void draw_rules(oracle::Draw& draw, double edge, Request& request) {
  Limits& limits = request.limits;
  const double way = (request.goal.position - request.start.position).norm();
  if (draw.below(3) == 0) {
    limits.max_turn_horizontal = radians(draw(20, 170));
  }
  if (draw.below(5) == 0) {
    limits.max_turn_space = radians(draw(20, 170));
  }
  if (draw.below(6) == 0) {
    limits.min_turn_radius = edge * draw(0.2, 2);
  }
  if (draw.below(3) == 0) {
    request.start.velocity = draw.within({-20, -20, 0}, {20, 20, 0});
  }
  if (draw.below(5) == 0) {
    limits.max_leg = edge * draw(0.8, 9);
  }
  if (draw.below(6) == 0) {
    limits.min_leg = edge * draw(0.2, 3);
  }
  if (draw.below(5) == 0) {
    limits.max_route_length = way * draw(0.9, 2);
  }
  if (draw.below(6) == 0) {
    request.constraints.push_back({"slow_growth", std::make_shared<SlowGrowth>()});
  }
}

struct Case {
  Request request;
  std::unique_ptr<reference::Problem> kept;
};

Case among_solids(std::uint64_t seed) {
  Case world{{}, reference::random_problem(seed, {.limits = false, .max_cells = 20})};
  Request& request = world.request;
  request = world.kept->request;
  request.goal.position.z() = request.start.position.z();
  request.level_m = request.start.position.z();
  oracle::Draw draw(seed + 1000);
  if (draw.below(2) == 0) {
    draw_rules(draw, 1, request);
  }
  if (world.kept->scene.ground && draw.below(2) == 0) {
    request.limits.min_ground_clearance = draw(0, 1);
  }
  if (draw.below(4) == 0) {
    request.limits.altitude.push_back(
        {AltitudeBand::Datum::sea, *request.level_m - draw(0, 1), *request.level_m + draw(0, 1)});
  }
  if (draw.below(6) == 0) {
    request.start.position.x() = request.volume.min.x();
  }
  if (draw.below(6) == 0) {
    request.goal.position.head<2>() = request.volume.max.head<2>();
  }
  return world;
}

/// A layer with cells of its own; ends off their centres.
Case among_cells(std::uint64_t seed) {
  oracle::Draw draw(seed + 2000);
  SplitMix64 random(seed);
  const int wide = draw.below(24) + 2;
  const int deep = draw.below(24) + 1;
  const auto levels = testing::random_levels(random, wide, deep, 1, draw(0.05, 0.35));
  Case world{testing::draw(levels, 1).request, nullptr};
  Request& request = world.request;
  for (Vec3* end : {&request.start.position, &request.goal.position}) {
    if (draw.below(2) == 0) {
      *end += draw.within({-0.49, -0.49, 0}, {0.49, 0.49, 0});
    }
  }
  request.level_m = request.start.position.z();
  if (draw.below(3) == 0) {
    request.vehicle.radius_m = draw(0.05, 0.6);
  }
  if (draw.below(4) == 0) {
    request.goal.tolerance_m = draw(0.1, 3);
  }
  if (draw.below(3) == 0) {
    draw_rules(draw, 1, request);
  }
  return world;
}

/// Boxes near and far from the origin.
Case among_boxes(std::uint64_t seed) {
  oracle::Draw draw(seed + 3000);
  const Vec3 off = draw.below(2) == 0 ? Vec3(5e6, -5e6, 0) : Vec3(0.3, 0.7, 0);
  std::vector<Shape> shapes;
  for (int n = draw.below(5); n > 0; --n) {
    const Vec3 low = off + draw.within({0, 0, -5}, {18, 18, -4});
    shapes.push_back(BoxShape{{low, low + draw.within({0.5, 0.5, 9}, {6, 6, 10})}});
  }
  Case world{testing::request_in(
                 testing::world_of(std::move(shapes)), off + draw.within({0, 0, 0}, {20, 20, 0}),
                 off + draw.within({0, 0, 0}, {20, 20, 0}), {off, off + Vec3(20, 20, 0)}),
             nullptr};
  world.request.level_m = 0;
  world.request.limits.min_clearance = draw.below(2) == 0 ? 0 : draw(0.01, 1);
  return world;
}

std::string text(const char* format, double a, double b = 0, double c = 0) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, a, b, c);
  return text.data();
}

/// A number from a range, at its ends as often as within.
double extreme(oracle::Draw& draw, double low, double high) {
  const int which = draw.below(4);
  return which == 0 ? low : which == 1 ? high : draw(low, high);
}

std::string random_settings(oracle::Draw& draw, int ants, bool improved) {
  std::string all = text("{cell_m: [%.17g, %.17g, 1]", draw.below(2) == 0 ? 1 : draw(0.4, 3),
                         draw.below(2) == 0 ? 1 : draw(0.4, 3));
  all += text(", ants: %g, iterations: %g", ants, 1 + draw.below(12));
  if (draw.below(2) == 0) {
    all += text(", alpha: %.17g, beta: %.17g, evaporation: %.17g", extreme(draw, 0, 20),
                extreme(draw, 0, 20), extreme(draw, 0, 1));
  }
  if (draw.below(3) == 0) {
    all += text(", deposit_q: %.17g, initial_pheromone: %.17g", draw.below(2) == 0 ? 1e-9 : 1e9,
                draw.below(2) == 0 ? 1e-9 : 1e9);
  }
  if (draw.below(4) == 0) {
    all += text(", max_length_m: %.17g", draw(1, 60));
  }
  const auto word = [&](const std::string& key, const std::vector<std::string>& words) {
    if (draw.below(2) == 0) {
      all += ", " + key + ": " + words[std::size_t(draw.below(int(words.size())))];
    }
  };
  if (!improved) {
    word("heuristic", {"leg", "goal", "goal_scaled"});
    return all + "}";
  }
  const int reach = draw.below(8) == 0 ? 40 : 1 + draw.below(7);
  all += text(", reach_cells: %g, spacing_cells: %g", reach,
              reach == 40 ? 6 + draw.below(100) : draw.below(4));
  if (draw.below(6) == 0) {
    all += text(", min_steps: %g", 1 + draw.below(100));
  }
  word("leg_test", {"remembered", "guard_zone", "always"});
  word("tilt", {"0", "0.999", "0.9"});
  word("region_radius", {"0", "1", "20"});
  word("region_decay", {"0", "1"});
  word("heuristic", {"euclidean", "geodesic"});
  word("trim", {"false"});
  word("longest_stride", {"4", "100000"});
  word("shortest_stride", {"2", "3"});
  word("deposit", {"cells", "nodes"});
  return all + "}";
}

/// "a route of 12.345678 m after ...".
double told_length(const PlanResult& result) {
  double metres = -1;
  std::sscanf(result.message.c_str(), "a route of %lf", &metres);
  return metres;
}

void expect_sound(const PlanResult& result, const Request& request) {
  ASSERT_EQ(result.status == PlanStatus::solved, !result.route.empty());
  if (result.status != PlanStatus::solved) {
    return;
  }
  const CheckResult judged = check(result.route, request);
  EXPECT_TRUE(judged.ok()) << judged.violations.front().message << "; " << result.message;
  EXPECT_EQ(result.route.front(), request.start.position);
  if (result.route.size() > 1) {
    EXPECT_EQ(result.route.back(), request.goal.position);
  }
  if (const double told = told_length(result); told >= 0) {
    EXPECT_NEAR(told, length(result.route), 2e-6);
  }
}

void expect_counters_add_up(const PlanResult& result, std::int64_t ants) {
  const std::int64_t alive = counter(result, "alive");
  if (alive < 0) {
    return;  // no ant was needed
  }
  const std::int64_t ended = alive + counter(result, "stuck") + counter(result, "too_long");
  EXPECT_TRUE(result.budget_hit ? ended <= ants : ended == ants) << result.message;
  EXPECT_EQ(counter(result, "mean_length_m") >= 0,
            alive > 0 && result.status == PlanStatus::solved);
  if (result.status == PlanStatus::solved) {
    const std::int64_t best = counter(result, "best_settled_at");
    EXPECT_TRUE(best >= 1 && best <= counter(result, "iterations"));
  }
}

void expect_budgets_kept(const Planner& planner, const Request& request, const PlanResult& whole) {
  const std::int64_t all = counter(whole, "expanded");
  double shortest = kInfinity;
  for (std::int64_t most = 0; most <= all + 1; most += 1 + (most < 30 ? 0 : all / 30)) {
    Request cut = request;
    cut.budget.max_iterations = std::uint64_t(most);
    const PlanResult part = planner.plan(cut);
    expect_sound(part, cut);
    EXPECT_EQ(counter(part, "expanded"), std::min(most, all));
    EXPECT_TRUE(part.budget_hit || equal(part, whole)) << most << part.message << whole.message;
    EXPECT_FALSE(part.status == PlanStatus::no_route && part.budget_hit) << part.message;
    if (part.status == PlanStatus::solved) {
      EXPECT_LE(length(part.route), shortest + kLengthTolerance);  // ends may be that far off
      shortest = length(part.route);
    } else {
      EXPECT_EQ(shortest, kInfinity);
    }
    cut.threads = 3;
    const PlanResult by_three = planner.plan(cut);
    EXPECT_TRUE(equal(part, by_three)) << part.message << "; " << by_three.message;
  }
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1000}, std::size_t{30000}}) {
    Request little = request;
    little.budget.max_memory_bytes = bytes;
    expect_sound(planner.plan(little), little);
  }
  Request stopped = request;
  std::stop_source source;
  source.request_stop();
  stopped.budget.stop = source.get_token();
  const PlanResult cancelled = planner.plan(stopped);
  expect_sound(cancelled, stopped);
  stopped.budget.stop = {};
  stopped.budget.deadline = Budget::Clock::now();
  expect_sound(planner.plan(stopped), stopped);
}

void expect_promises_kept(const Planner& planner, const Request& request, std::int64_t ants,
                          std::map<std::string, int>& counts) {
  PlanResult result;
  try {
    result = planner.plan(request);
  } catch (const ParameterError&) {
    return;  // min_steps can ask for too many candidates
  }
  ++counts[name(result.status)];
  expect_sound(result, request);
  if (result.counters.size() < 2) {
    return;
  }
  expect_counters_add_up(result, ants);
  EXPECT_TRUE(equal(result, planner.plan(request)));
  for (const int threads : {2, 8, 100}) {
    Request shared = request;
    shared.threads = threads;
    const PlanResult by_many = planner.plan(shared);
    EXPECT_TRUE(equal(result, by_many)) << result.message << "; " << by_many.message;
  }
  expect_budgets_kept(planner, request, result);
}

/// Rounds of six worlds each, one planner over all of them.
void hold_promises(int from, int to) {
  std::map<std::string, int> counts;
  for (int round = from; round < to; ++round) {
    for (const std::string planner : {"ant_colony", "improved_ant_colony"}) {
      oracle::Draw draw(std::uint64_t(round) * 2 + (planner == "ant_colony" ? 0 : 1));
      const int ants = 1 + draw.below(12);
      const std::string settings = random_settings(draw, ants, planner != "ant_colony");
      if (!testing::parameter_problems("planner", planner, settings).empty()) {
        continue;
      }
      const auto colony = testing::make_planner(planner, settings);
      for (int n = 0; n < 6; ++n) {
        const auto seed = std::uint64_t(round * 6 + n);
        Case world = n % 3 == 0   ? among_solids(seed)
                     : n % 3 == 1 ? among_cells(seed)
                                  : among_boxes(seed);
        world.request.random = RandomStream(seed);
        SCOPED_TRACE(planner + " " + std::to_string(seed) + " " + settings);
        expect_promises_kept(*colony, world.request, ants, counts);
      }
    }
  }
  EXPECT_GT(counts["solved"], 4 * (to - from));
  EXPECT_GT(counts["no_route"], 2 * (to - from));
}
TEST(RandomColonies, KeepTheirPromises) { hold_promises(0, 4); }
TEST(NightlyRandomColonies, KeepTheirPromises) { hold_promises(1000, 1300); }
}  // namespace
}  // namespace altiplan::random_colonies_test
