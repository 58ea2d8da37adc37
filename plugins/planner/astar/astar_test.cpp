// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <queue>
#include <thread>

#include "altiplan/error.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan {
namespace {

using testing::draw;
using testing::Drawn;
using testing::make_planner;

std::int64_t counter(const PlanResult& result, const std::string& name) {
  for (const Counter& c : result.counters) {
    if (c.name == name) {
      return c.value;
    }
  }
  return -1;
}

/// Length of the shortest way over cells by Dijkstra's algorithm; infinite where there is none.
double shortest(const Cell& counts, const Vec3& cell, const Cell& start, const Cell& goal,
                int neighbours, const std::function<bool(const Cell&, const Cell&)>& step_free) {
  const auto id = [&](const Cell& c) { return (c[2] * counts[1] + c[1]) * counts[0] + c[0]; };
  std::vector<double> best(std::size_t(counts[0] * counts[1] * counts[2]), kInfinity);
  using Entry = std::pair<double, Cell>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({0, start});
  best[std::size_t(id(start))] = 0;
  while (!queue.empty()) {
    const auto [g, c] = queue.top();
    queue.pop();
    if (c == goal) {
      return g;
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
  return kInfinity;
}

/// Levels of random cells, start and goal free.
std::vector<std::string> random_levels(SplitMix64& random, int nx, int ny, int nz, double density) {
  const std::size_t row = std::size_t(nx) + 1;
  std::vector<std::string> levels;
  for (int k = 0; k < nz; ++k) {
    std::string level(std::size_t(ny) * row, '\n');
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (i % row != std::size_t(nx)) {
        level[i] = random.uniform() < density ? '#' : '.';
      }
    }
    levels.push_back(level);
  }
  const auto place = [&](char what) {
    auto& level = levels[std::size_t(random.integer(0, nz - 1))];
    std::size_t at = 0;
    do {
      at = std::size_t(random.integer(0, ny - 1)) * row + std::size_t(random.integer(0, nx - 1));
    } while (level[at] == 'S');
    level[at] = what;
  };
  place('S');
  place('G');
  return levels;
}

/// Whether every cell that the step's box (or only its ends) spans is free.
bool cells_free(const VoxelGrid& grid, const Cell& a, const Cell& b, bool box) {
  if (grid.blocked(a) || grid.blocked(b)) {
    return false;
  }
  for (int corner = 0; box && corner < 8; ++corner) {
    if (grid.blocked(corner & 1 ? a[0] : b[0], corner & 2 ? a[1] : b[1],
                     corner & 4 ? a[2] : b[2])) {
      return false;
    }
  }
  return true;
}

TEST(AStar, EqualsDijkstraOnRandomCells) {
  SplitMix64 random(1);
  int solved = 0;
  for (int world = 0; world < 400; ++world) {
    const bool level = world % 2 == 0;
    const double densities[] = {0.1, 0.3, 0.45, 0.6};
    const auto levels = level ? random_levels(random, 14, 11, 1, densities[world / 2 % 4])
                              : random_levels(random, 7, 8, 6, densities[world / 2 % 4]);
    Drawn drawn = draw(levels, 10);
    if (level) {
      drawn.request.level_m = drawn.request.start.position.z();
    }
    GridSpec spec = *drawn.world->native_grid();
    spec.rule = GridSpec::Rule::native;
    const auto grid = drawn.world->voxels(spec);
    for (const bool box : {false, true}) {
      for (const int neighbours : {6, 26}) {
        const double expected =
            shortest(spec.counts, spec.cell, spec.cell_of(drawn.request.start.position),
                     spec.cell_of(drawn.request.goal.position), neighbours,
                     [&](const Cell& a, const Cell& b) { return cells_free(*grid, a, b, box); });
        for (const char* heuristic : {"octile", "euclidean", "zero"}) {
          const auto planner =
              make_planner("astar", std::string("{corner: ") + (box ? "free_box" : "any") +
                                        ", neighbours: " + std::to_string(neighbours) +
                                        ", heuristic: " + heuristic + "}");
          const PlanResult result = planner->plan(drawn.request);
          if (expected == kInfinity) {
            EXPECT_EQ(result.status, Status::no_route) << result.message;
            EXPECT_TRUE(result.proved);
          } else {
            ++solved;
            ASSERT_EQ(result.status, Status::solved) << result.message;
            EXPECT_NEAR(length(result.route), expected, 1e-9 * expected);
            EXPECT_TRUE(check(result.route, drawn.request).ok());
          }
        }
      }
    }
  }
  EXPECT_GT(solved, 1000);
}

TEST(AStar, ByCellsEqualsDijkstraWhereStepsAreRuledOut) {
  SplitMix64 random(8);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Drawn drawn = draw(random_levels(random, 9, 8, 7, 0.2), 10);
    if (world % 3 == 0) {
      drawn.request.limits.min_leg = 12;  // along one axis
    } else if (world % 3 == 1) {
      drawn.request.limits.max_leg = 15;  // along all three
    } else {
      drawn.request.limits.max_climb = radians(40);
    }
    const GridSpec spec = *drawn.world->native_grid();
    GridSpec native = spec;
    native.rule = GridSpec::Rule::native;
    const auto grid = drawn.world->voxels(native);
    const double expected = shortest(
        spec.counts, spec.cell, spec.cell_of(drawn.request.start.position),
        spec.cell_of(drawn.request.goal.position), 26, [&](const Cell& a, const Cell& b) {
          const double length = (spec.centre(b) - spec.centre(a)).norm();
          return cells_free(*grid, a, b, false) && length >= drawn.request.limits.min_leg &&
                 length <= drawn.request.limits.max_leg &&
                 climb_angle(spec.centre(b) - spec.centre(a)) <= drawn.request.limits.max_climb;
        });
    const PlanResult result = make_planner("astar")->plan(drawn.request);
    ASSERT_EQ(result.status == Status::solved, expected < kInfinity) << result.message;
    if (expected < kInfinity) {
      ++solved;
      EXPECT_NEAR(length(result.route), expected, 1e-6 * expected);
    }
  }
  EXPECT_GT(solved, 20);
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
    double least = kInfinity;
    for (const Vec3& c : centres) {
      least = std::min(least, (c - p).norm() - radius);
    }
    return least;
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    for (const Vec3& c : centres) {
      if (point_leg_distance(c, a, b) < radius + r - kLengthTolerance) {
        return true;
      }
    }
    return false;
  }
  double do_slack() const override { return 0; }
};

std::shared_ptr<Balls> random_balls(SplitMix64& random, int count) {
  auto balls = std::make_shared<Balls>();
  balls->radius = 12;
  for (int i = 0; i < count; ++i) {
    balls->centres.push_back(
        Vec3(random.uniform() * 100, random.uniform() * 90, random.uniform() * 40));
  }
  return balls;
}

Request among(std::shared_ptr<const Environment> environment) {
  Request request = testing::request_in(testing::world_of(std::move(environment)), {5, 5, 5},
                                        {95, 85, 35}, {{0, 0, 0}, {100, 90, 40}});
  request.limits.min_clearance = request.vehicle.radius_m = 1.5;
  return request;
}

TEST(AStar, ExactMovesEqualDijkstraUnderTheJudge) {
  SplitMix64 random(2);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Request request = among(random_balls(random, 4 + world % 20));
    request.limits.max_climb = world % 3 == 0 ? radians(35) : kPi / 2;
    const Cell counts = {10, 9, 9};  // centres at 0, 5 … 40 m of height
    const Vec3 cell(10, 10, 5);
    const auto at = [&](const Cell& c) { return Vec3(5 + 10 * c[0], 5 + 10 * c[1], 5.0 * c[2]); };
    const double expected = shortest(
        counts, cell, {0, 0, 1}, {9, 8, 7}, 26,
        [&](const Cell& a, const Cell& b) { return leg_ok(std::nullopt, at(a), at(b), request); });
    const auto planner = make_planner("astar", "{cell_m: [10, 10, 5]}");
    const PlanResult result = planner->plan(request);
    if (result.status == Status::invalid_problem) {
      continue;
    }
    ASSERT_EQ(result.status == Status::solved, expected < kInfinity) << result.message;
    if (expected < kInfinity) {
      ++solved;
      EXPECT_NEAR(length(result.route), expected, 1e-9 * expected);
      EXPECT_TRUE(check(result.route, request).ok());
    } else {
      EXPECT_TRUE(result.proved);
    }
    // Whole cells only: never shorter, and still sound.
    const PlanResult blocky =
        make_planner("astar", "{cell_m: [10, 10, 5], moves: cells}")->plan(request);
    if (blocky.status == Status::solved) {
      EXPECT_GE(length(blocky.route), length(result.route) - 1e-9);
      EXPECT_TRUE(check(blocky.route, request).ok());
    }
  }
  EXPECT_GT(solved, 30);
}

TEST(AStar, KeepsTurnAndClimbLimits) {
  SplitMix64 random(3);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Request request = among(random_balls(random, 6));
    request.limits.max_turn_horizontal = radians(55);
    request.limits.max_climb = radians(30);
    request.start.velocity = {10, 2, 0};
    request.goal.position = {93, 82, 33};  // no centre of a cell
    const PlanResult result = make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request);
    if (result.status == Status::solved) {
      ++solved;
      const CheckResult judged = check(result.route, request);
      EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
      EXPECT_EQ(result.route.back(), request.goal.position);
    }
  }
  EXPECT_GT(solved, 20);
}

TEST(AStar, EmptyMapOfThePaper) {
  Request request = testing::request_in(World(), {25e3, 70e3, 2e3}, {55e3, 10e3, 2.8e3},
                                        {{0, 0, 1e3}, {100e3, 100e3, 4e3}});
  request.limits.max_climb = radians(15);
  request.limits.max_turn_horizontal = radians(55);
  for (const char* heuristic : {"octile", "euclidean", "zero"}) {
    const PlanResult result =
        make_planner("astar",
                     std::string("{cell_m: [1000, 1000, 200], heuristic: ") + heuristic + "}")
            ->plan(request);
    ASSERT_EQ(result.status, Status::solved) << result.message;
    EXPECT_NEAR(length(result.route), 72482.7, 1) << heuristic;
    EXPECT_TRUE(check(result.route, request).ok());
  }
  request.limits.max_turn_horizontal = kPi;
  const auto octile = make_planner("astar", "{cell_m: [1000, 1000, 200]}")->plan(request);
  EXPECT_EQ(counter(octile, "expanded"), 61);  // straight there: 60 steps, all free
}

TEST(AStar, LengthIsInvariantUnderSwapMirrorAndTranslation) {
  SplitMix64 random(4);
  const auto planner = make_planner("astar", "{cell_m: [10, 10, 5]}");
  for (int world = 0; world < 20; ++world) {
    const auto balls = random_balls(random, 12);
    const PlanResult plain = planner->plan(among(balls));
    Request swapped = among(balls);
    std::swap(swapped.start.position, swapped.goal.position);
    auto mirrored = std::make_shared<Balls>(*balls);
    auto moved = std::make_shared<Balls>(*balls);
    for (std::size_t i = 0; i < balls->centres.size(); ++i) {
      mirrored->centres[i].x() = 100 - balls->centres[i].x();
      moved->centres[i] += Vec3(1000, -500, 250);
    }
    Request mirror = among(mirrored);
    mirror.start.position.x() = 95;
    mirror.goal.position.x() = 5;
    Request shift = among(moved);
    shift.start.position += Vec3(1000, -500, 250);
    shift.goal.position += Vec3(1000, -500, 250);
    shift.volume = {{1000, -500, 250}, {1100, -410, 290}};
    auto more = std::make_shared<Balls>(*balls);
    more->centres.push_back({50, 45, 20});
    for (const Request& request : {swapped, mirror, shift}) {
      const PlanResult other = planner->plan(request);
      ASSERT_EQ(other.status, plain.status);
      EXPECT_NEAR(length(other.route), length(plain.route), 1e-9 * length(plain.route));
    }
    const PlanResult fuller = planner->plan(among(more));
    if (fuller.status == Status::solved) {
      EXPECT_GE(length(fuller.route), length(plain.route) - 1e-9);
    }
  }
}

TEST(AStar, BudgetCancellationSealedGoalAndCorridor) {
  const auto planner = make_planner("astar");
  Drawn corridor =
      draw({"#########\n#S..#...#\n###.#.#.#\n#...#.#.#\n#.###.#.#\n#.....#G#\n#########"});
  corridor.request.level_m = 0.5;
  const PlanResult through = planner->plan(corridor.request);
  ASSERT_EQ(through.status, Status::solved) << through.message;
  EXPECT_TRUE(check(through.route, corridor.request).ok());

  corridor.request.budget.max_iterations = 0;
  const PlanResult none = planner->plan(corridor.request);
  EXPECT_EQ(none.status, Status::timed_out);
  EXPECT_TRUE(none.budget_hit);
  corridor.request.budget.max_iterations = 5;
  EXPECT_EQ(counter(planner->plan(corridor.request), "expanded"), 5);

  std::stop_source stop;
  stop.request_stop();
  corridor.request.budget = {};
  corridor.request.budget.stop = stop.get_token();
  EXPECT_EQ(planner->plan(corridor.request).status, Status::cancelled);

  Drawn sealed = draw({"S....\n.....\n..###\n..#G#\n..###"});
  sealed.request.level_m = 0.5;
  const PlanResult shut = planner->plan(sealed.request);
  EXPECT_EQ(shut.status, Status::no_route);
  EXPECT_TRUE(shut.proved);
  EXPECT_NE(shut.message.find("blocked cells"), std::string::npos) << shut.message;

  sealed.request.goal = {sealed.request.start.position, 0};
  EXPECT_EQ(planner->plan(sealed.request).route.size(), 1u);
}

/// Rows of a corridor one cell wide that fills a square in turns.
std::string serpentine(int edge) {
  std::string text;
  for (int row = 0; row < edge; ++row) {
    std::string line(std::size_t(edge), row % 2 == 0 ? '.' : '#');
    if (row % 2 == 1) {
      (row % 4 == 1 ? line.back() : line.front()) = '.';
    }
    text += line + "\n";
  }
  text.front() = 'S';
  text[text.size() - 2] = 'G';
  return text;
}

TEST(AStar, WaysFarLongerThanTheMapIsWide) {
  const int edge = 1001;
  const int corridor = (edge + 1) / 2 * edge + edge / 2;  // cells: too many for the finest costs
  Drawn drawn = draw({serpentine(edge)});
  drawn.request.level_m = 0.5;
  const PlanResult result = make_planner("astar", "{corner: free_box}")->plan(drawn.request);
  ASSERT_EQ(result.status, Status::solved) << result.message;
  EXPECT_NEAR(length(result.route), corridor - 1, 1e-6);
  EXPECT_EQ(counter(result, "expanded"), corridor);
}

TEST(AStar, IntegerCostsAreWithinTheirError) {
  SplitMix64 random(6);
  const std::string exact = "{neighbours: 26}";
  const std::string integer = "{neighbours: 26, costs: integer}";
  double worst = 0;
  for (int world = 0; world < 100; ++world) {
    Drawn drawn = draw(random_levels(random, 20, 20, world % 2 == 0 ? 1 : 12, 0.3));
    if (world % 2 == 0) {
      drawn.request.level_m = 0.5;
    }
    const PlanResult best = make_planner("astar", exact)->plan(drawn.request);
    const PlanResult near = make_planner("astar", integer)->plan(drawn.request);
    ASSERT_EQ(near.status, best.status);
    if (best.status == Status::solved) {
      EXPECT_TRUE(check(near.route, drawn.request).ok());
      const double error = length(near.route) / length(best.route) - 1;
      EXPECT_LE(error, world % 2 == 0 ? 1.2e-4 : 1e-3);
      worst = std::max(worst, error);
      EXPECT_NE(near.message.find("% off"), std::string::npos) << near.message;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_FALSE(make_planner("astar", integer)->traits().optimal);
}

TEST(AStar, TraceByCellsIsATreeOfSteps) {
  struct Kept final : Trace {
    std::vector<TraceEvent> events;
    void add(const TraceEvent& event) override { events.push_back(event); }
  } trace;
  SplitMix64 random(7);
  Drawn drawn = draw(random_levels(random, 15, 15, 8, 0.3), 10);
  drawn.request.trace = &trace;
  const PlanResult result = make_planner("astar")->plan(drawn.request);
  ASSERT_EQ(result.status, Status::solved);
  ASSERT_EQ(std::int64_t(trace.events.size()), counter(result, "expanded"));
  std::map<std::int64_t, Vec3> expanded;
  for (const TraceEvent& event : trace.events) {
    if (!expanded.empty()) {
      ASSERT_TRUE(expanded.contains(event.parent)) << event.node;
      EXPECT_LT((expanded[event.parent] - event.position).norm(), 17.4);
    }
    EXPECT_TRUE(expanded.emplace(event.node, event.position).second);
  }
}

TEST(AStar, EndsWithinTheToleranceOfAGoalThatCannotBeReached) {
  Drawn drawn = draw({"S.........\n..........\n..........\n.......###\n.......#G.\n.......###"});
  drawn.request.level_m = 0.5;
  drawn.request.goal.tolerance_m = 2.1;
  const PlanResult result = make_planner("astar")->plan(drawn.request);
  ASSERT_EQ(result.status, Status::solved) << result.message;
  EXPECT_EQ(result.route.back(), Vec3(6.5, 1.5, 0.5));
  EXPECT_TRUE(check(result.route, drawn.request).ok());
}

TEST(AStar, RefusalsNameTheRule) {
  Request request = among(std::make_shared<Balls>());
  request.limits.max_climb = radians(1);
  const PlanResult result = make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request);
  EXPECT_EQ(result.status, Status::no_route);
  EXPECT_TRUE(result.proved);
  EXPECT_NE(result.message.find("climb_angle rules out 18 of 26"), std::string::npos)
      << result.message;
}

TEST(AStar, RouteLengthCutsTheSearch) {
  Request request = among(std::make_shared<Balls>());
  const double direct = (request.goal.position - request.start.position).norm();
  request.limits.max_route_length = direct * 1.001;
  const PlanResult result = make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request);
  EXPECT_EQ(result.status, Status::no_route);
  request.limits.max_route_length = direct * 1.1;
  EXPECT_EQ(make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request).status, Status::solved);
}

TEST(AStar, MemoryIsCheckedBeforeItIsTaken) {
  Request request = among(std::make_shared<Balls>());
  const auto planner = make_planner("astar", "{cell_m: [0.001, 0.001, 0.001]}");
  try {
    planner->plan(request);
    FAIL() << "a lattice of 3.6e14 cells was accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "cell_m");
    EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
  }
}

TEST(AStar, CellsBeyondTheMemoryOfABudgetAreAResult) {
  Drawn drawn = draw({"S...", "....", "...G"});
  drawn.request.budget.max_memory_bytes = 20;
  for (const char* moves : {"{moves: cells}", "{moves: exact}"}) {
    const PlanResult result = make_planner("astar", moves)->plan(drawn.request);
    EXPECT_EQ(result.status, Status::timed_out);
    EXPECT_TRUE(result.budget_hit);
    EXPECT_NE(result.message.find("the budget is 0 MiB"), std::string::npos) << result.message;
  }
}

TEST(AStar, HundredthCallEqualsTheFirstOnAnyThread) {
  SplitMix64 random(5);
  const auto planner = make_planner("astar", "{cell_m: [10, 10, 5]}");
  const Request request = among(random_balls(random, 12));
  const Request other = among(random_balls(random, 5));
  const PlanResult first = planner->plan(request);
  const auto same = [&](const PlanResult& again) {
    return again.route == first.route && again.message == first.message &&
           counter(again, "expanded") == counter(first, "expanded");
  };
  for (int call = 0; call < 99; ++call) {
    planner->plan(other);
    ASSERT_TRUE(same(planner->plan(request))) << call;
  }
  std::array<bool, 4> equal{};
  std::vector<std::thread> threads;
  for (bool& flag : equal) {
    threads.emplace_back([&] { flag = same(planner->plan(request)); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(equal, (std::array<bool, 4>{true, true, true, true}));
}

TEST(AStar, TraitsFollowTheParameters) {
  EXPECT_TRUE(make_planner("astar")->traits().optimal);
  EXPECT_TRUE(make_planner("astar", "{weight_g: 0.7, weight_h: 0.3, heuristic: manhattan}")
                  ->traits()
                  .optimal);
  EXPECT_FALSE(make_planner("astar", "{heuristic: manhattan}")->traits().optimal);
  EXPECT_FALSE(make_planner("astar", "{weight_g: 0.3, weight_h: 0.7}")->traits().optimal);
  EXPECT_NE(testing::parameter_problems("planner", "astar", "{neighbours: 8}"), "");
  EXPECT_NE(testing::parameter_problems("planner", "astar", "{cell_m: [1, 0, 1]}"), "");
}
}  // namespace
}  // namespace altiplan
