// SPDX-License-Identifier: Apache-2.0
#include "spline.hpp"

#include <gtest/gtest.h>

#include "altiplan/random.hpp"

namespace altiplan::bspline::spline_test {
namespace {

/// Cox and de Boor's recursion on whole knots: basis function n of degree 3 at t.
double basis(int n, int degree, double t) {
  if (degree == 0) {
    return t >= n && t < n + 1 ? 1 : 0;
  }
  return (t - n) / degree * basis(n, degree - 1, t) +
         (n + degree + 1 - t) / degree * basis(n + 1, degree - 1, t);
}

TEST(CubicSpline, EqualsTheRecursionOfCoxAndDeBoor) {
  SplitMix64 random(5);
  std::vector<Vec3> control;
  for (int i = 0; i < 7; ++i) {
    control.emplace_back(random.uniform(), random.uniform(), random.uniform());
  }
  const CubicSpline spline(control);
  ASSERT_EQ(spline.pieces(), 6u);
  std::vector<Vec3> all = control;
  all.insert(all.begin(), 2 * control[0] - control[1]);
  all.push_back(2 * control[6] - control[5]);
  for (std::size_t piece = 0; piece < 6; ++piece) {
    for (const double u : {0.0, 0.25, 0.6, 0.999}) {
      Vec3 expected(0, 0, 0);
      for (int i = 0; i < 9; ++i) {
        expected += basis(i, 3, double(piece) + 3 + u) * all[std::size_t(i)];
      }
      EXPECT_NEAR((spline.at(piece, u) - expected).norm(), 0, 1e-12);
    }
  }
}

TEST(CubicSpline, BeginsAndEndsAtItsEndsAndIsSmooth) {
  const CubicSpline spline({{0, 0, 0}, {10, 0, 0}, {10, 10, 5}, {0, 10, 0}});
  EXPECT_NEAR((spline.at(0, 0) - Vec3(0, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((spline.at(2, 1) - Vec3(0, 10, 0)).norm(), 0, 1e-12);
  for (std::size_t piece = 1; piece < 3; ++piece) {
    const double h = 1e-5;
    const Vec3 left = (spline.at(piece - 1, 1) - spline.at(piece - 1, 1 - h)) / h;
    const Vec3 right = (spline.at(piece, h) - spline.at(piece, 0)) / h;
    EXPECT_NEAR((left - right).norm(), 0, 1e-3);
  }
}
}  // namespace
}  // namespace altiplan::bspline::spline_test
