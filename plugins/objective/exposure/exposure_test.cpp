// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "exposure_worlds_test.hpp"

namespace altiplan::exposure_test {
namespace {

/// The field at a place, by the definition; `elsewhere` where it has no value.
double field(const Values& values, const Vec3& p, double elsewhere) {
  const double x = (p.x() - values.south_west.x()) / values.step;
  const double y = (p.y() - values.south_west.y()) / values.step;
  const int i = int(std::floor(x));
  const int j = int(std::floor(y));
  if (i < 0 || j < 0 || i + 1 >= values.columns || j + 1 >= values.rows) {
    return elsewhere;
  }
  const double u = x - i;
  const double v = y - j;
  const double value = (1 - u) * (1 - v) * values.at(i, j) + u * (1 - v) * values.at(i + 1, j) +
                       (1 - u) * v * values.at(i, j + 1) + u * v * values.at(i + 1, j + 1);
  return std::isnan(value) ? elsewhere : value;
}

/// By the midpoints of many pieces.
double sampled(const Values& values, const Leg& leg, double elsewhere) {
  constexpr int kPieces = 40'000;
  double sum = 0;
  for (int n = 0; n < kPieces; ++n) {
    const double step = (leg.at((n + 1.0) / kPieces) - leg.at(double(n) / kPieces)).norm();
    sum += step * field(values, leg.at((n + 0.5) / kPieces), elsewhere);
  }
  return sum;
}

const Box kAround{{-60, -60, 0}, {200, 170, 60}};  // of the posts, and beyond them

TEST(Exposure, EqualsFineSampling) {
  SplitMix64 draws(1);
  RandomStream random(2);
  const Request request = testing::request_in({}, {0, 0, 0}, {100, 0, 0}, kAround);
  for (int world = 0; world < 20; ++world) {
    const Values values = random_values(draws, world % 2 == 0);
    const auto exposure = objective_of(values, ", elsewhere: 3");
    for (int n = 0; n < 20; ++n) {
      const Vec3 a = random.in(kAround);
      const Leg leg = n % 5 == 4 ? Leg::turning({a, random.uniform(0, 6)}, 1.5, 30, 10)
                                 : Leg::straight(a, random.in(kAround));
      const double expected = sampled(values, leg, 3);
      // A sample on the other side of a border to no value is off by a whole piece's length.
      EXPECT_NEAR(exposure->cost(leg, 0, request), expected, 2e-4 * expected + 0.02);
    }
  }
}

TEST(Exposure, AMetreCostsTheSameAtAllHeights) {
  SplitMix64 draws(6);
  RandomStream random(7);
  const Request request = testing::request_in({}, {0, 0, 0}, {100, 0, 0}, kAround);
  for (int n = 0; n < 200; ++n) {
    const auto exposure = objective_of(random_values(draws, n % 2 == 0), ", elsewhere: 3");
    const auto* mean = dynamic_cast<const kit::MeanCost*>(exposure.get());
    ASSERT_NE(mean, nullptr);
    const Vec3 a = random.in(kAround);
    const Vec3 b = n % 10 == 0 ? Vec3(a + Vec3(0, 0, 7)) : random.in(kAround);
    const double cost = exposure->cost(Leg::straight(a, b), 0, request);
    const double above = mean->per_metre({a.x(), a.y(), 500}, {b.x(), b.y(), -3});
    EXPECT_NEAR((b - a).norm() * above, cost, 1e-12 * cost);
  }
}

TEST(Exposure, AlongTheLinesOfPostsAndUpright) {
  Values values;
  values.values.assign(std::size_t(values.columns * values.rows), 2);
  values.values[3 * 8 + 4] = 6;  // at (70, 45)
  const auto exposure = objective_of(values);
  const Request request = testing::request_in({}, {0, 0, 0}, {100, 0, 0}, kAround);
  const auto cost = [&](const Vec3& a, const Vec3& b) {
    return exposure->cost(Leg::straight(a, b), 0, request);
  };
  EXPECT_DOUBLE_EQ(cost({50, 45, 0}, {90, 45, 0}), 40 * 4);
  EXPECT_DOUBLE_EQ(cost({90, 45, 0}, {50, 45, 0}), 40 * 4);
  EXPECT_DOUBLE_EQ(cost({70, 25, 9}, {70, 65, 9}), 40 * 4);
  EXPECT_DOUBLE_EQ(cost({70, 45, 0}, {70, 45, 10}), 60);
  EXPECT_DOUBLE_EQ(cost({-10, -15, 0}, {130, -15, 0}), 140 * 2);  // along the edge
  EXPECT_EQ(cost({70, 45, 0}, {70, 45, 0}), 0);
}

TEST(Exposure, NoRouteLeadsWhereTheFieldHasNoValue) {
  SplitMix64 draws(3);
  const auto objective = objective_of(random_values(draws, false));
  Request request = testing::request_in({}, {0, 0, 10}, {120, 100, 10}, kAround);
  request.objective = objective;
  const CheckResult beyond = check(Route{{0, 0, 10}, {0, 160, 10}, {120, 100, 10}}, request);
  ASSERT_EQ(beyond.violations.size(), 2u);
  EXPECT_EQ(beyond.violations[0].constraint, "objective");
  EXPECT_TRUE(check(Route{{0, 0, 10}, {120, 100, 10}}, request).ok());
  // Out of a corner, where all ways lead beyond the posts.
  request.goal.position = {-40, -40, 10};
  for (const char* planner : {"astar", "bidirectional_astar", "theta_star", "lazy_theta_star"}) {
    const PlanResult result =
        testing::make_planner(planner, "{cell_m: [10, 10, 10]}")->plan(request);
    EXPECT_EQ(result.status, PlanStatus::no_route) << planner << ": " << result.message;
    const char* says = "legs without a cost by the objective left out, such as one to (";
    EXPECT_NE(result.message.find(says), std::string::npos) << planner << ": " << result.message;
  }
}

TEST(Exposure, BoundsAreAdmissibleAndKnowARidge) {
  SplitMix64 draws(4);
  RandomStream random(5);
  const Request request = testing::request_in({}, {0, 0, 0}, {100, 0, 0}, kAround);
  for (int world = 0; world < 30; ++world) {
    const auto exposure =
        objective_of(random_values(draws, world % 3 == 0), world % 2 == 0 ? ", elsewhere: 1" : "");
    for (int n = 0; n < 200; ++n) {
      Polyline route(std::size_t(2 + n % 4));
      double cost = 0;
      for (std::size_t i = 0; i < route.size(); ++i) {
        route[i] = random.in(kAround);
        cost += i == 0 ? 0 : exposure->cost(Leg::straight(route[i - 1], route[i]), 0, request);
      }
      EXPECT_LE(exposure->bound(route.front(), route.back(), request), cost * (1 + 1e-9));
    }
  }
  Values ridge;
  ridge.values.assign(std::size_t(ridge.columns * ridge.rows), 0);
  for (int j = 0; j < ridge.rows; ++j) {
    ridge.values[std::size_t(j * ridge.columns + 4)] = 5;  // the whole column: no way round
  }
  const auto exposure = objective_of(ridge);
  const double bound = exposure->bound({0, 0, 0}, {120, 90, 0}, request);
  EXPECT_NEAR(bound, 5 * 20, 1e-6);  // a triangle of 40 m
  EXPECT_LE(bound, exposure->cost(Leg::straight({0, 0, 0}, {120, 90, 0}), 0, request));
}

TEST(Exposure, BadFilesAreRefusedByName) {
  const testing::TempFolder folder;
  const auto refusal = [&](const std::string& text) -> std::string {
    const std::string file = folder.write("field.asc", text).string();
    try {
      testing::make_objective("exposure", "{file: '" + file + "'}");
    } catch (const ParameterError& error) {
      EXPECT_EQ(error.key(), "file");
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(file + ": ", 0), 0u) << message;
      return message.substr(file.size() + 2);
    }
    return "";
  };
  const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  EXPECT_EQ(refusal(head + "1 2\n3 4\n"), "");
  EXPECT_EQ(refusal(head + "1 2\n3\n"),
            "line 8: expected the value of a cell, found the end of the file");
  EXPECT_EQ(refusal(head + "1 2\n3 x4\n"), "line 7: expected the value of a cell, found 'x4'");
  EXPECT_EQ(refusal(head + "1 2\n3 4 5\n"), "line 7: more values than ncols times nrows");
  EXPECT_EQ(
      refusal(head + "1 2\n-3 4\n"),
      "the value of column 0, row 1 (from the north) is -3.000000, expected a finite number of "
      "at least 0");
  EXPECT_EQ(refusal("ncols 2\nnrows 2\nyllcorner 0\ncellsize 10\n1 2 3 4"),
            "the header has no xllcorner: expected an ESRI ASCII grid");
  EXPECT_EQ(refusal("ncols 2.5\nnrows 2\n"),
            "ncols is 2.500000, expected a whole number from 2 to 1,000,000");
  EXPECT_EQ(refusal("ncols 999999\nnrows 999999\nxllcorner 0\nyllcorner 0\ncellsize 10\n"),
            "has 999998000001 cells, expected at most 100000000");
  EXPECT_EQ(refusal("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n"),
            "cellsize is not positive");
  EXPECT_EQ(refusal(head + "NODATA_value 1\n1 1\n1 1\n"), "has no value at all");
  EXPECT_EQ(refusal(""), "the header has no ncols: expected an ESRI ASCII grid");
}
}  // namespace
}  // namespace altiplan::exposure_test
