// SPDX-License-Identifier: Apache-2.0
// Lengths of jps compared with Dijkstra's algorithm and with astar.
#include <gtest/gtest.h>

#include "jps_maps_test.hpp"

namespace altiplan::jps_lengths_test {
namespace {

using testing::jps;
using testing::Map;
using testing::pick;
using testing::random_map;
using testing::serpentine;
using testing::shortest;

/// Plans between random free cells of maps, and counts the outcomes.
class Against {
 public:
  explicit Against(std::uint64_t seed) : random_(seed) {}

  /// Under both corner rules: the length is Dijkstra's, every leg lies in the free cells, and if
  /// there is no path, that is proved.
  void dijkstra(const Map& map, int goals) {
    const std::vector<int> free = map.free_cells();
    if (free.empty()) {
      return;
    }
    const int from = pick(random_, free);
    Request request = map.request(from, from);
    for (const bool free_box : {false, true}) {
      const std::vector<double> expected = shortest(map, from, free_box);
      for (int n = 0; n < goals; ++n) {
        const int to = pick(random_, free);
        request.goal.position = map.centre(to);
        const PlanResult result = planners_[free_box]->plan(request);
        SCOPED_TRACE(std::to_string(map.width) + " x " + std::to_string(map.height) + ", from " +
                     std::to_string(from) + " to " + std::to_string(to) +
                     (free_box ? ", free_box" : ", any"));
        hold(result, expected[std::size_t(to)], request);
      }
    }
  }

  SplitMix64& random() { return random_; }
  int solved() const { return solved_; }
  int unreachable() const { return unreachable_; }

 private:
  void hold(const PlanResult& result, double expected, const Request& request) {
    if (expected == kInfinity) {
      ++unreachable_;
      ASSERT_EQ(result.status, PlanStatus::no_route) << result.message;
      ASSERT_TRUE(result.proved);
      return;
    }
    ++solved_;
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    ASSERT_NEAR(length(result.route), expected, 1e-9 * expected);
    const CheckResult judged = check(result.route, request);
    ASSERT_TRUE(judged.ok()) << judged.violations.front().message;
  }

  SplitMix64 random_;
  std::unique_ptr<Planner> planners_[2] = {jps(false), jps(true)};
  int solved_ = 0;
  int unreachable_ = 0;
};

TEST(JpsLengths, RandomMapsOfAllDensities) {
  Against against(1);
  for (int n = 0; n < 1500; ++n) {
    const int width = against.random().integer(1, 24);
    const int height = against.random().integer(1, 24);
    Map map = random_map(against.random(), width, height, 0.6 * against.random().uniform());
    if (n % 4 == 0) {
      map.cell.y() = 0.3 + 2.7 * against.random().uniform();
    }
    against.dijkstra(map, 3);
    ASSERT_FALSE(HasFatalFailure()) << "map " << n;
  }
  EXPECT_GT(against.solved(), 5000);
  EXPECT_GT(against.unreachable(), 1000);
}

TEST(JpsLengths, BlocksAndRooms) {
  Against against(2);
  for (int n = 0; n < 300; ++n) {
    Map map(against.random().integer(20, 90), against.random().integer(20, 90));
    for (int block = 0; block < 3 + n % 40; ++block) {
      const int x0 = against.random().integer(0, map.width - 1);
      const int y0 = against.random().integer(0, map.height - 1);
      const int x1 = against.random().integer(x0, std::min(x0 + 20, map.width - 1));
      const int y1 = against.random().integer(y0, std::min(y0 + 20, map.height - 1));
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          // Every other block is a room: walls with gaps.
          const bool wall = x == x0 || x == x1 || y == y0 || y == y1;
          map.at(x, y) = n % 2 == 0 || (wall && against.random().uniform() < 0.9);
        }
      }
    }
    against.dijkstra(map, 6);
    ASSERT_FALSE(HasFatalFailure()) << "map " << n;
  }
  EXPECT_GT(against.solved(), 2000);
}

TEST(JpsLengths, WidthsAroundTheWordsOfAScan) {
  Against against(3);
  for (const int around : {54, 64, 110, 128, 192}) {
    for (int width = around - 3; width <= around + 3; ++width) {
      for (const double density : {0.0, 0.004, 0.03, 0.2}) {
        const Map map = random_map(against.random(), width, 9, density);
        against.dijkstra(map, 4);
        against.dijkstra(map.transposed(), 4);
        ASSERT_FALSE(HasFatalFailure()) << width << ", density " << density;
      }
    }
  }
  EXPECT_GT(against.solved(), 1500);
}

TEST(JpsLengths, SingleRowsAndColumns) {
  Against against(4);
  for (int width = 1; width <= 140; ++width) {
    for (const double density : {0.0, 0.01}) {
      const Map row = random_map(against.random(), width, 1, density);
      against.dijkstra(row, 3);
      against.dijkstra(row.transposed(), 3);
      ASSERT_FALSE(HasFatalFailure()) << width;
    }
  }
  EXPECT_GT(against.solved(), 1000);
}

TEST(JpsLengths, MazesWithWaysLongerThanTheFirstCostsAllow) {
  Against against(5);
  against.dijkstra(serpentine(31, 30), 10);
  Map unlike = serpentine(80, 81);
  unlike.cell.y() = 0.7;
  against.dijkstra(unlike, 10);
  const Map square = serpentine(260, 261);
  against.dijkstra(square, 3);
  EXPECT_EQ(against.unreachable(), 0);

  // From end to end: 130 rows of 259 steps and 129 turns around a wall's end.
  const int last = 260 * 261 - 1;
  const Request request = square.request(0, last);
  const double expected = shortest(square, 0, true)[std::size_t(last)];
  EXPECT_GT(expected, 33'000);
  EXPECT_NEAR(length(jps(true)->plan(request).route), expected, 1e-9 * expected);
}

TEST(JpsLengths, MirroredTransposedAndBackward) {
  SplitMix64 random(6);
  for (int n = 0; n < 60; ++n) {
    Map map = random_map(random, random.integer(30, 140), random.integer(30, 70), 0.15);
    map.cell.y() = n % 2 == 0 ? 1 : 1.3;
    const std::vector<int> free = map.free_cells();
    const int from = pick(random, free);
    const int to = pick(random, free);
    const auto mirror = [&](int i) {
      return i / map.width * map.width + map.width - 1 - i % map.width;
    };
    const auto transpose = [&](int i) { return i % map.width * map.height + i / map.width; };
    const auto planner = jps(n % 4 < 2);
    const PlanResult plain = planner->plan(map.request(from, to));
    for (const Request& request :
         {map.request(to, from), map.mirrored().request(mirror(from), mirror(to)),
          map.transposed().request(transpose(from), transpose(to))}) {
      const PlanResult other = planner->plan(request);
      ASSERT_EQ(other.status, plain.status) << n;
      EXPECT_NEAR(length(other.route), length(plain.route), 1e-9 * length(plain.route)) << n;
    }
  }
}

TEST(JpsLengths, EndsOffTheCentresAsAstarHasThem) {
  SplitMix64 random(7);
  int solved = 0;
  for (int n = 0; n < 400; ++n) {
    Map map =
        random_map(random, random.integer(3, 40), random.integer(3, 40), 0.5 * random.uniform());
    map.cell.y() = n % 3 == 0 ? 1.5 : 1;
    const std::string rule = n % 2 == 0 ? "corner: any" : "corner: free_box";
    const auto planner = testing::make_planner("jps", "{" + rule + "}");
    const auto astar = testing::make_planner("astar", "{moves: cells, " + rule + "}");
    const std::vector<int> free = map.free_cells();
    Request request = map.request(0, 0);
    for (int end = 0; end < 4; ++end) {
      const auto place = [&](bool off) {
        Vec3 p = map.centre(pick(random, free));
        if (off) {
          p.x() += map.cell.x() * (random.uniform() - 0.5);
          p.y() += random.uniform() < 0.3 ? 0 : map.cell.y() * (random.uniform() - 0.5);
        }
        return p;
      };
      request.start.position = place(end != 1);
      request.goal.position = place(end != 0);
      const PlanResult expected = astar->plan(request);
      const PlanResult result = planner->plan(request);
      ASSERT_EQ(result.status, expected.status) << n << ": " << result.message;
      if (result.status == PlanStatus::solved) {
        ++solved;
        EXPECT_NEAR(length(result.route), length(expected.route), 1e-5) << n;
        const CheckResult judged = check(result.route, request);
        ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
        EXPECT_EQ(result.route.front(), request.start.position);
        EXPECT_EQ(result.route.back(), request.goal.position);
      }
    }
  }
  EXPECT_GT(solved, 800);
}

TEST(JpsLengths, IntegerCostsComeWithinTheirError) {
  SplitMix64 random(8);
  const auto planner = testing::make_planner("jps", "{costs: integer}");
  for (int n = 0; n < 20; ++n) {
    const Map map = random_map(random, 200, 200, 0.2);
    const std::vector<int> free = map.free_cells();
    const std::vector<double> expected = shortest(map, free.front(), false);
    const PlanResult result = planner->plan(map.request(free.front(), free.back()));
    if (expected[std::size_t(free.back())] < kInfinity) {
      ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
      EXPECT_LE(length(result.route), expected[std::size_t(free.back())] * (1 + 1e-4));
    }
  }
}
}  // namespace
}  // namespace altiplan::jps_lengths_test
