// SPDX-License-Identifier: Apache-2.0
// Straight runs over empty space, which a search takes as one step, compared with Dijkstra's
// algorithm over all cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/measures.hpp"
#include "astar_worlds_test.hpp"

namespace altiplan::astar_runs_test {
namespace {

using testing::make_planner;
using testing::shortest;

/// Halls with walls across them, each with a gap, and single blocked cells.
struct Halls {
  Cell counts{};
  Vec3 edges;
  bool free_box = false;
  std::vector<bool> blocked;

  std::size_t id(const Cell& c) const {
    return std::size_t((c[2] * counts[1] + c[1]) * counts[0] + c[0]);
  }
  Vec3 centre(const Cell& c) const {
    return edges.cwiseProduct(Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5));
  }
  bool step_free(const Cell& a, const Cell& b) const {
    bool is_free = !blocked[id(a)] && !blocked[id(b)];
    for (int corner = 0; free_box && corner < 8; ++corner) {
      is_free = is_free && !blocked[id({corner & 1 ? a[0] : b[0], corner & 2 ? a[1] : b[1],
                                        corner & 4 ? a[2] : b[2]})];
    }
    return is_free;
  }
  double shortest_to(const Cell& start, const Cell& goal) const {
    return shortest(counts, edges, start, goal, 26,
                    [&](const Cell& a, const Cell& b) { return step_free(a, b); });
  }
  std::vector<double> lengths_from(const Cell& start) const {
    return testing::shortest_lengths(counts, edges, start, 26,
                                     [&](const Cell& a, const Cell& b) { return step_free(a, b); });
  }
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) {
          visit(Cell{i, j, k});
        }
      }
    }
  }
  template <class Visit>
  void for_each_neighbour(const Cell& c, const Visit& visit) const {
    for_each_cell([&](const Cell& n) {
      if (n != c && std::abs(n[0] - c[0]) <= 1 && std::abs(n[1] - c[1]) <= 1 &&
          std::abs(n[2] - c[2]) <= 1) {
        visit(n);
      }
    });
  }
  Request request(const Cell& start, const Cell& goal) const {
    std::vector<Shape> boxes;
    for_each_cell([&](const Cell& c) {
      if (blocked[id(c)]) {
        boxes.push_back(BoxShape{{centre(c) - 0.4 * edges, centre(c) + 0.4 * edges}});
      }
    });
    const Vec3 size = edges.cwiseProduct(Vec3(counts[0], counts[1], counts[2]));
    return testing::request_in(testing::world_of(std::move(boxes)), centre(start), centre(goal),
                               {{0, 0, 0}, size});
  }
  std::string planner(const char* heuristic) const {
    return "{cell_m: [" + std::to_string(edges.x()) + ", " + std::to_string(edges.y()) + ", " +
           std::to_string(edges.z()) + "], corner: " + (free_box ? "free_box" : "any") +
           ", moves: cells, heuristic: " + heuristic + "}";
  }
};

int below(SplitMix64& random, int end) { return int(random.uniform() * end); }

Halls random_halls(SplitMix64& random, int number) {
  Halls halls;
  halls.counts = {4 + below(random, 8), 4 + below(random, 8), 4 + below(random, 8)};
  const auto along = std::size_t(number % 3);
  halls.counts[along] = 50 + below(random, 100);  // longer than the longest run, or not
  halls.edges = number / 3 % 2 == 0 ? Vec3(1, 1, 1) : Vec3(2.5, 1.25, 0.75);
  halls.free_box = number / 6 % 2 == 0;
  const int total = halls.counts[0] * halls.counts[1] * halls.counts[2];
  halls.blocked.resize(std::size_t(total));
  for (int wall = 0; wall < 4; ++wall) {
    const std::size_t axis = random.uniform() < 0.7 ? along : std::size_t(below(random, 3));
    const int at = 1 + below(random, halls.counts[axis] - 2);
    const Cell gap{below(random, halls.counts[0]), below(random, halls.counts[1]),
                   below(random, halls.counts[2])};
    halls.for_each_cell([&](const Cell& c) {
      bool in_gap = true;
      for (std::size_t other = 0; other < 3; ++other) {
        in_gap = in_gap && (other == axis || std::abs(c[other] - gap[other]) <= 1);
      }
      if (c[axis] == at && !in_gap) {
        halls.blocked[halls.id(c)] = true;
      }
    });
  }
  for (int n = below(random, total / 50); n > 0; --n) {
    halls.blocked[std::size_t(below(random, total))] = true;
  }
  return halls;
}

Cell random_free_cell(SplitMix64& random, const Halls& halls) {
  Cell c{};
  do {
    c = {below(random, halls.counts[0]), below(random, halls.counts[1]),
         below(random, halls.counts[2])};
  } while (halls.blocked[halls.id(c)]);
  return c;
}

TEST(AStarRuns, EqualDijkstra) {
  SplitMix64 random(11);
  int solved = 0;
  for (int number = 0; number < 120; ++number) {
    const Halls halls = random_halls(random, number);
    const Cell start = random_free_cell(random, halls);
    const Cell goal = random_free_cell(random, halls);
    const Request request = halls.request(start, goal);
    const double expected = halls.shortest_to(start, goal);
    for (const char* heuristic : {"octile", "euclidean", "zero"}) {
      const PlanResult result = make_planner("astar", halls.planner(heuristic))->plan(request);
      ASSERT_EQ(result.status == PlanStatus::solved, expected < kInfinity) << result.message;
      if (expected < kInfinity) {
        ++solved;
        ASSERT_NEAR(length(result.route), expected, 1e-6 * expected) << number;
        EXPECT_TRUE(check(result.route, request).ok());
      } else {
        EXPECT_TRUE(result.proved);
      }
    }
  }
  EXPECT_GT(solved, 200);
}

TEST(AStarRuns, AreCellByCellIfToldSo) {
  SplitMix64 random(14);
  double by_runs = 0;
  double by_cells = 0;
  for (int number = 0; number < 24; ++number) {
    const Halls halls = random_halls(random, number);
    const Request request =
        halls.request(random_free_cell(random, halls), random_free_cell(random, halls));
    std::string parameters = halls.planner("octile");
    const PlanResult runs = make_planner("astar", parameters)->plan(request);
    parameters.insert(1, "runs: false, ");
    const PlanResult cells = make_planner("astar", parameters)->plan(request);
    ASSERT_EQ(runs.status, cells.status);
    EXPECT_NEAR(length(runs.route), length(cells.route), 1e-6 * length(cells.route));
    by_runs += double(testing::counter(runs, "expanded"));
    by_cells += double(testing::counter(cells, "expanded"));
  }
  EXPECT_LT(by_runs, by_cells / 2);
}

TEST(AStarRuns, EndAtEveryCellWithinTheGoalsTolerance) {
  SplitMix64 random(12);
  int solved = 0;
  for (int number = 0; number < 12; ++number) {
    Halls halls = random_halls(random, number);
    const Cell start = random_free_cell(random, halls);
    const Cell goal = random_free_cell(random, halls);
    halls.for_each_neighbour(goal, [&](const Cell& c) { halls.blocked[halls.id(c)] = c != start; });
    Request request = halls.request(start, goal);
    request.goal.tolerance_m = halls.edges.maxCoeff() * (2 + 2 * random.uniform());
    const std::vector<double> lengths = halls.lengths_from(start);
    double expected = kInfinity;
    halls.for_each_cell([&](const Cell& c) {
      if (request.goal.reached_at(halls.centre(c))) {
        expected = std::min(expected, lengths[halls.id(c)]);
      }
    });
    const PlanResult result = make_planner("astar", halls.planner("octile"))->plan(request);
    ASSERT_EQ(result.status == PlanStatus::solved, expected < kInfinity) << result.message;
    if (expected < kInfinity) {
      ++solved;
      ASSERT_NEAR(length(result.route), expected, 1e-6 * expected + 1e-9) << number;
    }
  }
  EXPECT_GT(solved, 6);
}

TEST(AStarRuns, NameTheNearestCellThatIsReached) {
  SplitMix64 random(13);
  int shut = 0;
  for (int number = 0; number < 40; ++number) {
    const Halls halls = random_halls(random, number);
    const Cell start = random_free_cell(random, halls);
    const Cell goal = random_free_cell(random, halls);
    const Request request = halls.request(start, goal);
    const std::vector<double> lengths = halls.lengths_from(start);
    if (lengths[halls.id(goal)] < kInfinity) {
      continue;
    }
    ++shut;
    std::vector<std::pair<double, Cell>> by_distance;
    halls.for_each_cell([&](const Cell& c) {
      by_distance.push_back({(halls.centre(c) - request.goal.position).norm(), c});
    });
    std::sort(by_distance.begin(), by_distance.end());
    const double nearest =
        std::find_if(by_distance.begin(), by_distance.end(), [&](const auto& at) {
          return lengths[halls.id(at.second)] < kInfinity;
        })->first;
    const PlanResult result = make_planner("astar", halls.planner("octile"))->plan(request);
    EXPECT_NE(result.message.find(", " + std::to_string(std::llround(nearest)) + " m from it"),
              std::string::npos)
        << result.message << "; expected " << nearest;
  }
  EXPECT_GT(shut, 3);
}
}  // namespace
}  // namespace altiplan::astar_runs_test
