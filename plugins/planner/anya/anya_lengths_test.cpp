// SPDX-License-Identifier: Apache-2.0
// Lengths of anya compared with the shortest way in the graph of corners that see each other.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "reference/cell_corners.hpp"

namespace altiplan::anya_lengths_test {
namespace {

using reference::CellCorners;
using testing::Map;
using testing::pick;
using testing::random_map;
using testing::serpentine;
using testing::shortest;

std::unique_ptr<Planner> anya(bool pinched) {
  return testing::make_planner("anya", pinched ? "{corner: any}" : "{corner: one_free}");
}

/// Plans between points of maps, and counts the outcomes.
class Against {
 public:
  explicit Against(std::uint64_t seed) : random_(seed) {}

  /// Under both corner rules: the length is the graph's, every leg is valid, and if there is no
  /// route, that is proved.
  void corners(const Map& map, int queries) {
    const std::vector<int> free = map.free_cells();
    if (free.empty()) {
      return;
    }
    Request request = map.request(free.front(), free.front());
    for (const bool pinched : {false, true}) {
      const CellCorners graph(map, pinched);
      for (int n = 0; n < queries; ++n) {
        const CellCorners::Point from = point(map, free, n);
        const CellCorners::Point to = point(map, free, n / 3);
        request.start.position = position(map, from);
        request.goal.position = position(map, to);
        const PlanResult result = planners_[pinched]->plan(request);
        SCOPED_TRACE(std::to_string(map.width) + " x " + std::to_string(map.height) + ", from " +
                     text(from) + " to " + text(to) + (pinched ? ", any" : ", one_free"));
        hold(result, graph.shortest(from, to), request);
        if (::testing::Test::HasFatalFailure()) {
          return;
        }
      }
    }
  }

  SplitMix64& random() { return random_; }
  int solved() const { return solved_; }
  int bent() const { return bent_; }
  int unreachable() const { return unreachable_; }

 private:
  static constexpr int kUnit = CellCorners::kUnit;

  static std::string text(const CellCorners::Point& p) {
    return std::to_string(p.x) + ", " + std::to_string(p.y);
  }

  /// In or beside a free cell: its centre, a corner, on an edge, anywhere.
  CellCorners::Point point(const Map& map, const std::vector<int>& free, int kind) {
    const int cell = pick(random_, free);
    CellCorners::Point p{std::int64_t{cell % map.width} * kUnit,
                         std::int64_t{cell / map.width} * kUnit};
    const auto corner = [&] { return random_.integer(0, 1) * kUnit; };
    const auto within = [&] { return random_.integer(1, kUnit - 1); };
    switch (kind % 5) {
      case 0:
        return {p.x + kUnit / 2, p.y + kUnit / 2};
      case 1:
        return {p.x + corner(), p.y + corner()};
      case 2:
        return {p.x + corner(), p.y + within()};
      case 3:
        return {p.x + within(), p.y + corner()};
      default:
        return {p.x + within(), p.y + within()};
    }
  }
  static Vec3 position(const Map& map, const CellCorners::Point& p) {
    return {map.origin.x() + double(p.x) / kUnit * map.cell.x(),
            map.origin.y() + double(p.y) / kUnit * map.cell.y(), map.centre(0).z()};
  }

  void hold(const PlanResult& result, double expected, const Request& request) {
    if (expected == kInfinity) {
      ++unreachable_;
      ASSERT_EQ(result.status, PlanStatus::no_route) << result.message;
      ASSERT_TRUE(result.proved);
      return;
    }
    ++solved_;
    bent_ += result.route.size() > 2;
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    ASSERT_NEAR(length(result.route), expected, 1e-9 * expected);
    ASSERT_EQ(result.route.front(), request.start.position);
    ASSERT_EQ(result.route.back(), request.goal.position);
    const CheckResult judged = check(result.route, request);
    ASSERT_TRUE(judged.ok()) << judged.violations.front().message;
  }

  SplitMix64 random_;
  std::unique_ptr<Planner> planners_[2] = {anya(false), anya(true)};
  int solved_ = 0;
  int bent_ = 0;
  int unreachable_ = 0;
};

TEST(AnyaLengths, RandomMapsOfAllDensities) {
  Against against(1);
  for (int n = 0; n < 2500; ++n) {
    const int width = against.random().integer(1, 13);
    const int height = against.random().integer(1, 13);
    const Map map = random_map(against.random(), width, height, 0.65 * against.random().uniform());
    against.corners(map, 15);
    ASSERT_FALSE(HasFatalFailure()) << "map " << n;
  }
  EXPECT_GT(against.solved(), 30000);
  EXPECT_GT(against.bent(), 10000);
  EXPECT_GT(against.unreachable(), 10000);
}

TEST(AnyaLengths, CellsOfAnySizeAnywhere) {
  Against against(2);
  for (int n = 0; n < 600; ++n) {
    Map map = random_map(against.random(), against.random().integer(2, 12),
                         against.random().integer(2, 12), 0.5 * against.random().uniform());
    map.cell = {0.3 + 30 * against.random().uniform(), 0.1 + 10 * against.random().uniform(), 7};
    map.origin = {1e4 * (against.random().uniform() - 0.5), 1e4 * against.random().uniform(), -3};
    against.corners(map, 15);
    ASSERT_FALSE(HasFatalFailure()) << "map " << n;
  }
  EXPECT_GT(against.bent(), 2000);
}

TEST(AnyaLengths, BlocksAndRooms) {
  Against against(3);
  for (int n = 0; n < 60; ++n) {
    Map map(against.random().integer(20, 40), against.random().integer(20, 40));
    for (int block = 0; block < 3 + n % 12; ++block) {
      const int x0 = against.random().integer(0, map.width - 1);
      const int y0 = against.random().integer(0, map.height - 1);
      const int x1 = against.random().integer(x0, std::min(x0 + 12, map.width - 1));
      const int y1 = against.random().integer(y0, std::min(y0 + 12, map.height - 1));
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          // Every other block is a room: walls with gaps.
          const bool wall = x == x0 || x == x1 || y == y0 || y == y1;
          map.at(x, y) = n % 2 == 0 || (wall && against.random().uniform() < 0.9);
        }
      }
    }
    against.corners(map, 20);
    ASSERT_FALSE(HasFatalFailure()) << "map " << n;
  }
  EXPECT_GT(against.bent(), 1000);
}

TEST(AnyaLengths, WidthsAroundTheWordsOfAScan) {
  Against against(4);
  for (const int around : {56, 64, 112, 128}) {
    for (int width = around - 2; width <= around + 2; ++width) {
      for (const double density : {0.0, 0.01, 0.06, 0.2}) {
        against.corners(random_map(against.random(), width, 5, density), 10);
        ASSERT_FALSE(HasFatalFailure()) << width << ", density " << density;
      }
      against.corners(serpentine(width, 5), 10);
      ASSERT_FALSE(HasFatalFailure()) << width << ", serpentine";
    }
  }
  EXPECT_GT(against.bent(), 500);
}

TEST(AnyaLengths, SingleRowsAndColumns) {
  Against against(5);
  for (int width = 1; width <= 130; ++width) {
    const Map row = random_map(against.random(), width, 1, width % 2 == 0 ? 0.0 : 0.02);
    against.corners(row, 6);
    against.corners(row.transposed(), 6);
    ASSERT_FALSE(HasFatalFailure()) << width;
  }
  EXPECT_GT(against.solved(), 2000);
  EXPECT_GT(against.unreachable(), 100);
}

/// On maps too large for the graph: whichever way the map lies, and from the other end.
TEST(AnyaLengths, MirroredTransposedAndBackward) {
  SplitMix64 random(6);
  int solved = 0;
  for (int n = 0; n < 150; ++n) {
    Map map =
        random_map(random, random.integer(30, 200), random.integer(30, 140), 0.1 + 0.1 * (n % 4));
    map.cell.y() = n % 2 == 0 ? 1 : 1.3;
    const std::vector<int> free = map.free_cells();
    const int from = pick(random, free);
    const int to = pick(random, free);
    const auto mirror = [&](int i) {
      return i / map.width * map.width + map.width - 1 - i % map.width;
    };
    const auto transpose = [&](int i) { return i % map.width * map.height + i / map.width; };
    const auto planner = anya(n % 4 < 2);
    const PlanResult plain = planner->plan(map.request(from, to));
    solved += plain.status == PlanStatus::solved;
    for (const Request& request :
         {map.request(to, from), map.mirrored().request(mirror(from), mirror(to)),
          map.transposed().request(transpose(from), transpose(to))}) {
      const PlanResult other = planner->plan(request);
      ASSERT_EQ(other.status, plain.status) << n;
      ASSERT_NEAR(length(other.route), length(plain.route), 1e-9 * length(plain.route)) << n;
    }
  }
  EXPECT_GT(solved, 100);
}

/// Steps over the grid are legs of any angle, and reach what those reach.
TEST(AnyaLengths, NeverLongerThanTheGrid) {
  SplitMix64 random(7);
  int solved = 0;
  for (int n = 0; n < 60; ++n) {
    const Map map = random_map(random, 120, 90, 0.05 * (n % 9));
    const std::vector<int> free = map.free_cells();
    const int from = pick(random, free);
    for (const bool pinched : {false, true}) {
      const auto planner = anya(pinched);
      const std::vector<double> grid = shortest(map, from, !pinched);
      for (int query = 0; query < 5; ++query) {
        const int to = pick(random, free);
        const PlanResult result = planner->plan(map.request(from, to));
        if (grid[std::size_t(to)] < kInfinity) {
          ++solved;
          ASSERT_EQ(result.status, PlanStatus::solved) << n << ": " << result.message;
          ASSERT_LE(length(result.route), grid[std::size_t(to)] * (1 + 1e-12)) << n;
        } else {
          ASSERT_EQ(result.status, PlanStatus::no_route) << n;
        }
      }
    }
  }
  EXPECT_GT(solved, 400);
}
}  // namespace
}  // namespace altiplan::anya_lengths_test
