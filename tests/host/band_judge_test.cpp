// SPDX-License-Identifier: Apache-2.0
#include "host/gate/band_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <tuple>

#include "support/support.hpp"

namespace altiplan::host::band_judge_test {
namespace {

/// A part of a flight that winds through the volume: strip after strip, as wings fly them.
FlownPart winding_part(std::mt19937& random) {
  std::uniform_real_distribution<double> step(-60, 60);
  std::uniform_real_distribution<double> rise(0, 20);
  std::uniform_int_distribution<int> count(1, 40);
  FlownPart part;
  Vec3 at(step(random) * 5, step(random) * 5, 100 + step(random));
  for (int n = count(random); n > 0; --n) {
    const Vec3 next = at + Vec3(step(random), step(random), step(random) / 10);
    part.strips.push_back(
        {at, next, at.z() + rise(random), next.z() + rise(random), rise(random) / 4});
    at = next;
  }
  return part;
}

std::vector<Shape> random_obstacles(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-500, 500);
  std::uniform_real_distribution<double> size(1, 60);
  std::vector<Shape> shapes;
  for (int n = 0; n < 60; ++n) {
    const Vec3 corner(place(random), place(random), 100 + place(random) / 5);
    shapes.emplace_back(
        BoxShape{{corner, corner + Vec3(size(random), size(random), size(random))}});
  }
  return shapes;
}

/// True if an obstacle is within reach of a point of the part, one of many at random.
bool is_hit(const FlownPart& part, const std::vector<Shape>& obstacles, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  for (const Strip& strip : part.strips) {
    for (int n = 0; n < 100; ++n) {
      const double along = share(random);
      const double up = share(random);
      Vec3 p = strip.from + along * (strip.to - strip.from);
      const double high = strip.from_high_m + along * (strip.to_high_m - strip.from_high_m);
      p.z() += up * (high - p.z());
      for (const Shape& shape : obstacles) {
        if (signed_distance(shape, p) < strip.reach_m - 1e-6) {
          return true;
        }
      }
    }
  }
  return false;
}

// Groups of strips are held against the obstacles as a whole: what one strip hits is found, and
// parts are valid whose strips are.
TEST(BandJudge, JudgesAPartAsItsStrips) {
  std::mt19937 random(7);
  int hit = 0;
  int valid = 0;
  constexpr int kParts = 400;
  for (int n = 0; n < kParts; ++n) {
    const Box volume{Vec3::Constant(-1e4), Vec3::Constant(1e4)};
    const std::vector<Shape> obstacles = random_obstacles(random);
    const Request request = altiplan::testing::request_in(altiplan::testing::world_of(obstacles),
                                                          {0, 0, 0}, {1, 0, 0}, volume);
    const BandJudge judge(request);
    const FlownPart part = winding_part(random);
    bool is_each_valid = true;
    for (const Strip& strip : part.strips) {
      FlownPart alone;
      alone.strips = {strip};
      is_each_valid = is_each_valid && judge.is_valid(alone);
    }
    const bool is_valid = judge.is_valid(part);
    EXPECT_EQ(judge.violations(part).empty(), is_valid) << "part " << n;
    if (is_each_valid) {
      EXPECT_TRUE(is_valid) << "part " << n;
    }
    if (is_hit(part, obstacles, random)) {
      EXPECT_FALSE(is_valid) << "part " << n;
      ++hit;
    }
    valid += is_valid;
  }
  EXPECT_GT(hit, kParts / 10);
  EXPECT_GT(valid, kParts / 10);
}

/// Ground at sea level with a hill across x = -500.
class Hill final : public Environment, public Ground {
 public:
  explicit Hill(double top) : top_(top) {}

 private:
  double height(double x) const { return std::max(0.0, top_ - std::abs(x + 500)); }
  Box do_bounds() const override { return {Vec3::Constant(-1e4), {1e4, 1e4, top_}}; }
  double do_clearance(const Vec3& p) const override { return p.z() - height(p.x()); }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double) const override { return height(x); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    double least = kInfinity;
    for (int n = 0; n <= 1000; ++n) {
      const Vec3 p = a + n / 1000.0 * (b - a);
      least = std::min(least, p.z() - height(p.x()));
    }
    return least;
  }
  double top_;
};

// A landing from 100 m above the runway, 1000 m before it, is 50 m above that where the hill is.
TEST(BandJudge, ALandingKeepsOffTheGroundByHalfOfItsHeight) {
  FlownPart landing;
  landing.ground = FlownPart::Ground::touched_along;
  landing.foot_m = 0;
  landing.strips = {{{-1000, 0, 100}, {0, 0, 0}, 105, 0, 8}};
  for (const auto& [top, limit, rule] :
       {std::tuple(20.0, 30.0, ""), std::tuple(30.0, 30.0, "ground_clearance"),
        std::tuple(30.0, 10.0, ""), std::tuple(45.0, 10.0, "ground_clearance"),
        std::tuple(30.0, 0.0, ""), std::tuple(60.0, 0.0, "ground")}) {
    Request request = altiplan::testing::request_in(
        altiplan::testing::world_of(std::make_shared<Hill>(top)), {0, 0, 0}, {1, 0, 0},
        {Vec3::Constant(-1e4), Vec3::Constant(1e4)});
    request.limits.min_ground_clearance = limit;
    const BandJudge judge(request);
    const auto found = judge.violations(landing);
    ASSERT_EQ(found.empty() ? "" : found.front().violation.constraint, rule)
        << top << " m, at least " << limit;
    EXPECT_EQ(judge.is_valid(landing), found.empty());
    if (!found.empty()) {
      EXPECT_NEAR(found.front().at.x(), -500, 15);
    }
  }
}

TEST(BandJudge, APartOfNothingIsValid) {
  const Request request = altiplan::testing::request_in(
      altiplan::testing::world_of({Shape(BoxShape{{{0, 0, 0}, {1, 1, 1}}})}), {0, 0, 0}, {1, 0, 0},
      {Vec3::Constant(-1e4), Vec3::Constant(1e4)});
  EXPECT_TRUE(BandJudge(request).is_valid({}));
}
}  // namespace
}  // namespace altiplan::host::band_judge_test
