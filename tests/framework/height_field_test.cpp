// SPDX-License-Identifier: Apache-2.0
#include "altiplan/height_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "altiplan/error.hpp"

namespace altiplan::height_field_test {
namespace {

const float kVoid = std::numeric_limits<float>::quiet_NaN();

struct Draw {
  std::mt19937_64 engine;
  double operator()(double low, double high) {
    return low + (high - low) * double(engine() >> 11) * 0x1p-53;
  }
};

HeightField rough(int columns, int rows, unsigned seed, double amplitude = 300) {
  Draw draw{std::mt19937_64(seed)};
  std::vector<float> heights(std::size_t(columns) * std::size_t(rows));
  for (float& height : heights) {
    height = float(draw(0, amplitude));
  }
  return {{1000, -500}, {90, 71}, columns, rows, heights};
}

// Independent of the cell walk: dense samples, each refined by ternary search around the lowest.
double sampled_gap(const HeightField& field, const Vec3& a, const Vec3& b, int samples,
                   double sign = 1) {
  const auto gap = [&](double t) {
    const Vec3 p = a + t * (b - a);
    const std::optional<double> ground = field.at(p.x(), p.y());
    return ground ? sign * (p.z() - *ground) : -kInfinity;
  };
  double least = kInfinity;
  double where = 0;
  for (int n = 0; n <= samples; ++n) {
    const double t = double(n) / samples;
    if (gap(t) < least) {
      least = gap(t);
      where = t;
    }
  }
  double low = std::max(0.0, where - 1.0 / samples);
  double high = std::min(1.0, where + 1.0 / samples);
  for (int n = 0; n < 100; ++n) {
    const double third = (high - low) / 3;
    (gap(low + third) < gap(high - third) ? high : low) +=
        gap(low + third) < gap(high - third) ? -third : third;
  }
  return std::min({least, gap(low), gap((low + high) / 2)});
}

TEST(HeightField, GapEqualsDenseSampling) {
  const HeightField field = rough(60, 45, 11);
  Draw draw{std::mt19937_64(3)};
  for (int n = 0; n < 300; ++n) {
    const Vec3 a(draw(1000, 6310), draw(-500, 2624), draw(0, 900));
    const Vec3 b(draw(1000, 6310), draw(-500, 2624), draw(0, 900));
    const double expected = sampled_gap(field, a, b, 20000);
    EXPECT_NEAR(field.gap(a, b), expected, 1e-6) << a.transpose() << " to " << b.transpose();
    EXPECT_LE(field.gap(a, b), expected + 1e-9);
    EXPECT_EQ(field.gap(a, b), field.gap(b, a));
    EXPECT_NEAR(field.gap_max(a, b), -sampled_gap(field, a, b, 20000, -1), 1e-6);
    for (const double enough : {-100.0, 50.0, 400.0}) {
      const double gap = field.gap(a, b, enough);
      EXPECT_TRUE(expected < enough - 1e-6 ? std::abs(gap - expected) < 1e-6 : gap >= enough - 1e-6)
          << gap << ' ' << expected << ' ' << enough;
    }
  }
}

TEST(HeightField, PartAnswersAsTheWholeToTheLastBit) {
  constexpr int kColumns = 200;
  constexpr int kRows = 170;
  std::vector<float> heights(std::size_t(kColumns) * kRows);
  Draw draw{std::mt19937_64(21)};
  for (float& height : heights) {
    height = draw(0, 1) < 0.01 ? kVoid : float(draw(0, 300));
  }
  const std::array<double, 2> origin{1000.3, -500.7};
  const std::array<double, 2> spacing{90.1, 71.3};
  const HeightField whole(origin, spacing, kColumns, kRows, heights);
  const HeightField::Part part{48, 64, 65, 49};
  std::vector<float> some;
  for (int j = 0; j < part.rows; ++j) {
    const auto row = heights.begin() + (part.row + j) * kColumns + part.column;
    some.insert(some.end(), row, row + part.columns);
  }
  const HeightField field(origin, spacing, part, some);
  EXPECT_EQ(field.origin()[0], origin[0] + 48 * spacing[0]);
  EXPECT_EQ(field.columns(), 65);
  EXPECT_EQ(field.rows(), 49);
  const auto x = [&] { return origin[0] + spacing[0] * draw(49, 111); };
  const auto y = [&] { return origin[1] + spacing[1] * draw(65, 111); };
  int with_ground = 0;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 a(x(), y(), draw(0, 400));
    const Vec3 b = n % 3 == 0 ? Vec3(x(), y(), draw(0, 400))
                              : Vec3(a + Vec3(draw(-1, 1), draw(-1, 1), draw(-50, 50)));
    ASSERT_EQ(field.at(a.x(), a.y()), whole.at(a.x(), a.y())) << n;
    ASSERT_EQ(field.gap(a, b), whole.gap(a, b)) << n;
    ASSERT_EQ(field.gap_max(a, b), whole.gap_max(a, b)) << n;
    const Vec3 low = a.cwiseMin(b);
    const Vec3 high = a.cwiseMax(b);
    ASSERT_EQ(field.max_slope(low.x(), low.y(), high.x(), high.y()),
              whole.max_slope(low.x(), low.y(), high.x(), high.y()))
        << n;
    ASSERT_EQ(field.max_height(low.x(), low.y(), high.x(), high.y()),
              whole.max_height(low.x(), low.y(), high.x(), high.y()))
        << n;
    with_ground += whole.gap(a, b) > -kInfinity ? 1 : 0;
  }
  EXPECT_GT(with_ground, 1000);
  EXPECT_LT(with_ground, 4500);
  EXPECT_FALSE(field.at(origin[0] + 40 * spacing[0], origin[1] + 70 * spacing[1]));
  EXPECT_THROW(HeightField(origin, spacing, HeightField::Part{-1, 0, 65, 49}, some), Error);
}

TEST(HeightField, GapOfLegsAlongPostsAxesVerticalsAndTheBorder) {
  const HeightField field = rough(40, 40, 5);
  Draw draw{std::mt19937_64(4)};
  for (int n = 0; n < 40; ++n) {
    const double x = 1000 + 90 * n;
    const double y = -500 + 71 * n;
    const Vec3 a(x, -500, draw(0, 800));
    const Vec3 b(x, -500 + 39 * 71, draw(0, 800));
    EXPECT_NEAR(field.gap(a, b), sampled_gap(field, a, b, 39 * 8), 1e-6) << n;
    const Vec3 c(1000, y, draw(0, 800));
    const Vec3 d(1000 + 39 * 90, y, draw(0, 800));
    EXPECT_NEAR(field.gap(c, d), sampled_gap(field, c, d, 39 * 8), 1e-6) << n;
    const Vec3 foot(x, y, 500);
    EXPECT_EQ(field.gap(foot, foot + Vec3(0, 0, 700)), 500 - *field.at(x, y));
    // Through posts, on the diagonal.
    const Vec3 e(1000, -500, draw(0, 800));
    const Vec3 f(x, y, draw(0, 800));
    EXPECT_NEAR(field.gap(e, f), sampled_gap(field, e, f, 4 * 8 * 39 * 7), 1e-3) << n;
  }
  EXPECT_EQ(field.gap_max({1000, 0, 0}, {1000, 0, 900}), 900 - *field.at(1000, 0));
  EXPECT_EQ(field.gap_max({999.99, 0, 5000}, {1500, 0, 5000}), kInfinity);
  EXPECT_EQ(field.gap({999.99, 0, 5000}, {1500, 0, 5000}), -kInfinity);
  EXPECT_EQ(field.gap({1200, 0, 5000}, {1200, 9000, 5000}, 10), -kInfinity);
}

TEST(HeightField, AVoidTakesFourCellsAway) {
  std::vector<float> heights(25, 10);
  heights[2 * 5 + 2] = kVoid;
  const HeightField field({0, 0}, {10, 10}, 5, 5, heights);
  EXPECT_EQ(field.void_posts(), 1U);
  EXPECT_FALSE(field.at(15, 15));
  EXPECT_FALSE(field.at(20, 20));
  EXPECT_EQ(field.at(10, 20), 10);  // on the border of a cell that has ground
  EXPECT_EQ(field.at(30, 30), 10);
  EXPECT_EQ(field.gap({5, 15, 50}, {35, 15, 50}, 1), -kInfinity);
  EXPECT_EQ(field.gap({10, 0, 50}, {10, 40, 50}), 40);
  EXPECT_EQ(field.gap({30, 0, 50}, {30, 40, 50}), 40);
  EXPECT_EQ(field.gap({5, 20, 50}, {10, 20, 50}), 40);
  EXPECT_EQ(field.gap({10, 20, 50}, {5, 17, 50}), 40);
  EXPECT_EQ(field.gap({0, 20, 50}, {20, 0, 50}), 40);  // touches the void's corner only
  EXPECT_EQ(field.max_height(0, 0, 10, 40), kInfinity);
  EXPECT_EQ(field.max_height(0, 0, 9, 40), 10);
}

TEST(HeightField, MaximaOverBoxesBoundTheSurface) {
  const HeightField field = rough(70, 50, 9);
  Draw draw{std::mt19937_64(8)};
  for (int n = 0; n < 200; ++n) {
    const double x0 = draw(1000, 7200);
    const double y0 = draw(-500, 2970);
    const double x1 = std::min(7210.0, x0 + draw(0, 2000));
    const double y1 = std::min(2979.0, y0 + draw(0, 1500));
    const double slope = field.max_slope(x0, y0, x1, y1);
    const double top = field.max_height(x0, y0, x1, y1);
    double seen = -kInfinity;
    for (int s = 0; s < 300; ++s) {
      const double x = draw(x0, x1);
      const double y = draw(y0, y1);
      seen = std::max(seen, *field.at(x, y));
      const double h = 1e-4;
      if (x + h < x1 && y + h < y1) {
        const double east = (*field.at(x + h, y) - *field.at(x, y)) / h;
        const double north = (*field.at(x, y + h) - *field.at(x, y)) / h;
        EXPECT_LE(std::hypot(east, north), slope + 1e-5);
      }
    }
    EXPECT_LE(seen, top + 1e-9);
    EXPECT_LE(top, field.max_height() + 1e-9);
    EXPECT_LE(slope, field.max_slope());
  }
  EXPECT_EQ(field.max_slope(-1e9, -1e9, 1e9, 1e9), field.max_slope());
  EXPECT_EQ(field.max_height(1000, -500, 1000 + 69 * 90.0, -500 + 49 * 71.0), field.max_height());
  EXPECT_EQ(field.max_height(990, 0, 2000, 100), kInfinity);
}

TEST(HeightField, SlopeOfAPlaneIsExact) {
  std::vector<float> heights;
  for (int j = 0; j < 30; ++j) {
    for (int i = 0; i < 30; ++i) {
      heights.push_back(float(3 * i + 4 * j));
    }
  }
  const HeightField field({0, 0}, {10, 10}, 30, 30, heights);
  EXPECT_NEAR(field.max_slope(), 0.5, 1e-12);
  EXPECT_NEAR(field.max_slope(55, 55, 60, 60), 0.5, 1e-12);
  EXPECT_NEAR(field.gap({0, 0, 100}, {290, 290, 100 + 203}), 100, 1e-9);
}

TEST(HeightField, RefusesWhatIsNoField) {
  EXPECT_THROW(HeightField({0, 0}, {1, 1}, 1, 5, std::vector<float>(5)), Error);
  EXPECT_THROW(HeightField({0, 0}, {1, 0}, 2, 2, std::vector<float>(4)), Error);
  EXPECT_THROW(HeightField({0, 0}, {1, 1}, 2, 2, std::vector<float>(5)), Error);
  EXPECT_THROW(HeightField({0, 0}, {1, 1}, 2, 2, {0, 0, 0, float(kInfinity)}), Error);
}
}  // namespace
}  // namespace altiplan::height_field_test
