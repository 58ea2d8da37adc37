// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/support.hpp"

namespace altiplan::hills_test {
namespace {

using testing::make_environment;
using Made = std::unique_ptr<Environment>;

// Rows of spec/fusion_astar.md: x0, y0, h, sx, sy in kilometres.
constexpr double kFitted[12][5] = {{57, 33, 2.4, 6, 3}, {62, 53, 1.9, 9, 6}, {51, 34, 2.0, 9, 8},
                                   {24, 22, 3.2, 3, 3}, {35, 76, 2.2, 6, 5}, {55, 55, 3.4, 9, 7},
                                   {46, 27, 3.4, 2, 9}, {74, 23, 3.1, 4, 6}, {59, 33, 2.7, 4, 4},
                                   {33, 42, 2.4, 9, 6}, {26, 74, 2.6, 2, 3}, {44, 19, 2.1, 6, 7}};

struct Row {
  double x, y, h, sx, sy;  // metres
};

std::vector<Row> fitted(bool mirrored = false) {
  std::vector<Row> rows;
  for (const auto& r : kFitted) {
    rows.push_back({(mirrored ? 100 - r[0] : r[0]) * 1000, r[1] * 1000, r[2] * 1000, r[3] * 1000,
                    r[4] * 1000});
  }
  return rows;
}

std::string yaml(const std::vector<Row>& rows) {
  std::string text = "{base_m: 500, cap_m: 4000, peaks: [";
  for (const Row& r : rows) {
    text += "{at_m: [" + std::to_string(r.x) + ", " + std::to_string(r.y) +
            "], height_m: " + std::to_string(r.h) + ", sigma_m: [" + std::to_string(r.sx) + ", " +
            std::to_string(r.sy) + "]}, ";
  }
  return text + "]}";
}

double height(const std::vector<Row>& rows, double x, double y) {
  double sum = 500;
  for (const Row& r : rows) {
    sum += r.h * std::exp(-std::pow((x - r.x) / r.sx, 2) / 2 - std::pow((y - r.y) / r.sy, 2) / 2);
  }
  return std::min(4000.0, sum);
}

// Minimum of the leg's heights above the ground (sign -1: maximum) by dense sampling, refined
// around every sample that is no higher than its neighbours.
double sampled_gap(const std::vector<Row>& rows, const Vec3& a, const Vec3& b, double sign = 1) {
  const auto gap = [&](double t) {
    const Vec3 p = a + std::clamp(t, 0.0, 1.0) * (b - a);
    return sign * (p.z() - height(rows, p.x(), p.y()));
  };
  constexpr int kSamples = 2000;
  double best = kInfinity;
  for (int k = 0; k <= kSamples; ++k) {
    double at = double(k) / kSamples;
    double step = 1.0 / kSamples;
    if (gap(at) > std::min(gap(at - step), gap(at + step)) || gap(at) > best + 5) {
      continue;
    }
    while (step > 1e-12) {  // halves towards the minimum
      step /= 2;
      for (const double side : {at - step, at + step}) {
        at = gap(side) < gap(at) ? side : at;
      }
    }
    best = std::min(best, gap(at));
  }
  return sign * best;
}

const Box kOver{{0, 0, 300}, {100000, 100000, 5000}};

TEST(Hills, FittedTerrainOfThePage) {
  const auto rows = fitted();
  const Made hills = make_environment("hills", yaml(rows));
  RandomStream random(1);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random.in(kOver);
    EXPECT_NEAR(*hills->ground()->height(p.x(), p.y()), height(rows, p.x(), p.y()), 1e-9);
  }
  EXPECT_DOUBLE_EQ(*hills->ground()->height(56000, 54000), 4000) << "a plateau";
  EXPECT_LT(*hills->ground()->height(25000, 70000), 2000) << "below the start";
  EXPECT_LT(*hills->ground()->height(55000, 10000), 2800) << "below the goal";
  EXPECT_NEAR(*hills->ground()->height(-400000, 0), 500, 1e-9);
}

// An independent implementation of the generator, by the specification page.
std::vector<Row> generated(std::uint64_t state, int count, const Vec3& start, const Vec3& goal) {
  const auto u = [&] {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return double(z >> 11) / 9007199254740992.0;
  };
  const auto i = [&](int a, int b) { return a + std::floor(u() * (b - a + 1)); };
  while (true) {
    std::vector<Row> rows;
    for (int n = 0; n < count; ++n) {
      const double x = i(5, 95) * 1000;
      const double y = i(5, 95) * 1000;
      const double h = i(10, 38) / 10 * 1000;
      const double sx = i(3, 8) * 1000;
      rows.push_back({x, y, h, sx, i(3, 8) * 1000});
    }
    if (height(rows, start.x(), start.y()) < start.z() &&
        height(rows, goal.x(), goal.y()) < goal.z()) {
      return rows;
    }
  }
}

TEST(Hills, DrawsThePublishedTerrains) {
  Site site;
  site.start = Vec3(25000, 70000, 2000);
  site.goal = Vec3(55000, 10000, 2800);
  int redrawn = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const int count = seed % 2 ? 45 : 16;
    const Made hills = make_environment(
        "hills", "{seed: " + std::to_string(seed) + ", count: " + std::to_string(count) + "}",
        site);
    const auto rows = generated(seed, count, *site.start, *site.goal);
    const auto anywhere = generated(seed, count, {0, 0, 9000}, {0, 0, 9000});
    redrawn += rows[0].x != anywhere[0].x;
    for (int x = 0; x <= 100000; x += 7000) {
      for (int y = 0; y <= 100000; y += 9000) {
        ASSERT_NEAR(*hills->ground()->height(x, y), height(rows, x, y), 1e-6) << seed;
      }
    }
  }
  EXPECT_GT(redrawn, 3);
  EXPECT_LT(redrawn, 37);
}

TEST(Hills, TakesTheRunsSeedWithoutOneOfItsOwn) {
  Site one;
  one.random = RandomStream(1);
  Site two;
  two.random = RandomStream(2);
  const Made a = make_environment("hills", "{count: 5}", one);
  const Made again = make_environment("hills", "{count: 5}", one);
  const Made b = make_environment("hills", "{count: 5}", two);
  double difference = 0;
  for (int x = 0; x < 100000; x += 5000) {
    EXPECT_EQ(*a->ground()->height(x, x), *again->ground()->height(x, x));
    difference += std::abs(*a->ground()->height(x, x) - *b->ground()->height(x, x));
  }
  EXPECT_GT(difference, 100);
}

TEST(Hills, RefusesWhatCannotBeMeant) {
  const auto problems = [](const char* text) {
    return testing::parameter_problems("environment", "hills", text);
  };
  EXPECT_NE(problems("{seed: 1, peaks: [{at_m: [0, 0], height_m: 1, sigma_m: [9, 9]}]}")
                .find("either peaks"),
            std::string::npos);
  EXPECT_NE(problems("{base_m: 10, cap_m: 10}").find("cap_m must be greater"), std::string::npos);
  EXPECT_NE(problems("{peaks: [{at_m: [0, 0], height_m: 1, sigma_m: [9, 0]}]}").find("sigma_m"),
            std::string::npos);
  Site buried;
  buried.start = Vec3(0, 0, 499);
  EXPECT_THROW(make_environment("hills", "{seed: 1}", buried), Error);
}

TEST(Hills, GapIsExact) {
  for (const bool drawn : {false, true}) {
    const auto rows = drawn ? generated(9, 45, {0, 0, 9000}, {0, 0, 9000}) : fitted();
    const Made hills = make_environment("hills", yaml(rows));
    RandomStream random(4);
    int capped = 0;
    for (int n = 0; n < 150; ++n) {
      const Vec3 a = random.in(kOver);
      const Vec3 b =
          n % 3 ? Vec3(random.in(kOver)) : Vec3(a + random.uniform() * Vec3(800, -500, 90));
      const double gap = hills->ground()->gap(a, b);
      EXPECT_NEAR(gap, sampled_gap(rows, a, b), 1e-6);
      EXPECT_EQ(gap, hills->ground()->gap(a, b, gap + 1)) << "enough is not reached";
      EXPECT_GE(hills->ground()->gap(a, b, gap - 1), gap - 1);
      EXPECT_NEAR(hills->ground()->gap_max(a, b), sampled_gap(rows, a, b, -1), 1e-6);
      const double share = random.uniform();
      const Vec3 on = a + share * (b - a);
      capped += height(rows, on.x(), on.y()) == 4000;
    }
    EXPECT_GT(capped, 2);
    EXPECT_NEAR(hills->ground()->gap({100, 200, 900}, {100, 200, 700}),
                700 - height(rows, 100, 200), 1e-9);
  }
}

TEST(Hills, SpikeBetweenSamplesIsSeen) {
  // A needle one metre wide on a plain, between the samples at the leg's quarters, 1 cm too high.
  const std::vector<Row> rows{{31234.5, 5000, 50, 1, 1}};
  const Made hills = make_environment("hills", yaml(rows));
  const Vec3 up(0, 0, 0.02);
  const Vec3 a(0, 5000, 549.99);
  const Vec3 b(90000, 5000, 549.99);
  EXPECT_NEAR(hills->ground()->gap(a, b), -0.01, 1e-6);
  EXPECT_TRUE(hills->blocked(a, b, 0));
  EXPECT_FALSE(hills->blocked(a + up, b + up, 0));
  // Touching the plateau is free, exactly.
  const auto plateau = fitted();
  const Made capped = make_environment("hills", yaml(plateau));
  EXPECT_FALSE(capped->blocked({0, 54000, 4000}, {100000, 54000, 4000}, 0));
  EXPECT_TRUE(capped->blocked({0, 54000, 3999.99}, {100000, 54000, 3999.99}, 0));
  EXPECT_FALSE(capped->blocked({0, 54000, 4005}, {100000, 54000, 4005}, 5));
}

TEST(Hills, MirroredSceneGivesMirroredAnswers) {
  const Made hills = make_environment("hills", yaml(fitted()));
  const Made mirror = make_environment("hills", yaml(fitted(true)));
  const auto mirrored = [](const Vec3& p) { return Vec3(100000 - p.x(), p.y(), p.z()); };
  RandomStream random(6);
  for (int n = 0; n < 300; ++n) {
    const Vec3 a = random.in(kOver);
    const Vec3 b = random.in(kOver);
    EXPECT_NEAR(hills->ground()->gap(a, b), mirror->ground()->gap(mirrored(a), mirrored(b)), 1e-6);
    EXPECT_NEAR(hills->clearance(a), mirror->clearance(mirrored(a)), 60);  // slopes: within 1 %
    EXPECT_EQ(hills->blocked(a, b, 0), mirror->blocked(mirrored(a), mirrored(b), 0));
  }
}

TEST(Hills, LawsHold) {
  const auto rows = generated(3, 45, {0, 0, 9000}, {0, 0, 9000});
  const Made hills = make_environment("hills", yaml(rows));
  RandomStream random(8);
  int in_doubt = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 a = random.in(kOver);
    const Vec3 b = a + random.uniform(0, 8) * Vec3(random.normal() * 1000, random.normal() * 1000,
                                                   random.normal() * 100);
    const double clearance = hills->clearance(a);
    EXPECT_LE(std::abs(clearance - hills->clearance(b)), (a - b).norm() * (1 + 1e-12) + 1e-9);
    EXPECT_EQ(clearance < 0, a.z() < height(rows, a.x(), a.y()));
    double minimum = kInfinity;
    hills->near(a, 10000, [&](const Nearby& nearby) {
      minimum = nearby.distance;
      if (minimum > 0) {
        const Vec3& q = nearby.point;
        EXPECT_NEAR(q.z(), height(rows, q.x(), q.y()), 1e-6);
        EXPECT_NEAR((q + nearby.normal * minimum - a).norm(), 0, 1e-6);
      }
    });
    EXPECT_GE(minimum, clearance - 1e-6);
    const double r = random.uniform(0, 300);
    const bool blocked = hills->blocked(a, b, r);
    EXPECT_EQ(blocked, hills->blocked(b, a, r));
    EXPECT_LE(hills->blocked(a, b, r / 2), blocked);
    double lowest = kInfinity;
    for (int k = 0; k <= 60; ++k) {
      const Vec3 on = a + (b - a) * k / 60;
      lowest = std::min(lowest, hills->clearance(on));
      const Vec3 side(random.normal(), random.normal(), -std::abs(random.normal()));
      const Vec3 near_it = on + random.uniform(0, r) * side.normalized();
      EXPECT_TRUE(blocked || near_it.z() > height(rows, near_it.x(), near_it.y()) - 1e-5) << n;
      if (minimum > 0 && a.z() - height(rows, a.x(), a.y()) > 0) {
        // No sampled ground around a is nearer than near's point by more than 5 %.
        const Vec3 way = random.uniform(0, 1.5 * minimum) * side.normalized();
        const Vec3 ground(a.x() + way.x(), a.y() + way.y(),
                          height(rows, a.x() + way.x(), a.y() + way.y()));
        EXPECT_GT((ground - a).norm(), minimum * 0.95 - 1e-6);
      }
    }
    if (lowest > r + (b - a).norm() / 120) {
      EXPECT_FALSE(blocked) << n;
    } else if (!blocked) {
      ++in_doubt;
    }
  }
  EXPECT_GT(in_doubt, 20) << "blocked is sharper than clearance";
}

TEST(Hills, RasterLeavesNoGroundFree) {
  const auto rows = fitted();
  const Made hills = make_environment("hills", yaml(rows));
  GridSpec spec;
  spec.origin = {500, 500, 900};
  spec.cell = {1000, 1000, 200};
  spec.counts = {60, 60, 16};
  VoxelGrid grid(spec);
  hills->rasterize(grid);
  int free = 0;
  int tight = 0;
  for (int j = 0; j < 60; ++j) {
    for (int i = 0; i < 60; ++i) {
      double highest = 0;
      const Box foot = spec.cell_box({i, j, 0});
      for (int n = 0; n <= 20; ++n) {
        for (int m = 0; m <= 20; ++m) {
          highest = std::max(highest, height(rows, foot.min.x() + n * 50, foot.min.y() + m * 50));
        }
      }
      for (int k = 0; k < 16; ++k) {
        const double low = spec.cell_box({i, j, k}).min.z();
        free += !grid.blocked(i, j, k);
        EXPECT_TRUE(grid.blocked(i, j, k) || highest <= low) << i << " " << j << " " << k;
        tight += grid.blocked(i, j, k) && highest < low - 30;
      }
    }
  }
  EXPECT_GT(free, 5000);
  EXPECT_EQ(tight, 0) << "blocked well above the ground";
}
}  // namespace
}  // namespace altiplan::hills_test
