// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "altiplan/height_field.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::testing::radar_test {
namespace {

/// Rolling ground with a wall-like ridge along y = 1000, of 20 m posts over 4 km.
class Hills final : public Environment, public Ground {
 public:
  Hills() : field_({-2000, -2000}, {20, 20}, 201, 201, heights()) {}
  const HeightField& field() const { return field_; }

 private:
  static std::vector<float> heights() {
    std::vector<float> result;
    for (int j = 0; j < 201; ++j) {
      for (int i = 0; i < 201; ++i) {
        const double x = -2000 + 20 * i;
        const double y = -2000 + 20 * j;
        result.push_back(float(30 * std::sin(x / 300) * std::cos(y / 250) +
                               150 * std::exp(-(y - 1000) * (y - 1000) / 20000)));
      }
    }
    return result;
  }
  Box do_bounds() const override { return {{-2000, -2000, -kInfinity}, {2000, 2000, 200}}; }
  double do_clearance(const Vec3&) const override { return kInfinity; }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override { return field_.at(x, y); }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return field_.gap(a, b, enough);
  }
  double do_slope(const Box& box) const override {
    return field_.max_slope(box.min.x(), box.min.y(), box.max.x(), box.max.y());
  }

  HeightField field_;
};

struct Place {
  std::shared_ptr<Hills> hills = std::make_shared<Hills>();
  World world = world_of(hills, "hills");
  Site site;

  Place() { site.before = &world; }
};

std::string refusal(const std::string& yaml, const Site& site) {
  try {
    make_environment("radar", yaml, site);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Radar, IsABallAroundItsAntenna) {
  const Place place;
  const auto radar =
      make_environment("radar", "{at_m: [100, 200], above_ground_m: 20, range_m: 500}", place.site);
  const double z = *place.hills->field().at(100, 200) + 20;
  EXPECT_NEAR(radar->clearance({100, 900, z}), 200, 1e-9);
  EXPECT_FALSE(radar->blocked({-900, 702, z}, {900, 702, z}, 2));
  EXPECT_TRUE(radar->blocked({-900, 702, z}, {900, 702, z}, 2.1));
  EXPECT_EQ(radar->over_approximation(), 0);
  ASSERT_EQ(radar->info().threats.size(), 1U);
  EXPECT_EQ(radar->info().threats[0].kind, "radar");
  EXPECT_EQ(radar->info().threats[0].radius, 500);
  EXPECT_NEAR(radar->info().threats[0].centre.z(), z, 1e-9);
}

// By hand: P_t G_t G_r λ² σ = 5e4 · 1e7 · 1e-2 · 0.1 = 5e8; (4π)³ = 1984.40;
// L_r L_t F_r D_d = 10^(0.2 + 0.3 + 0.4 + 1.3) = 158.489; k T B = 4.00388e-15;
// 5e8 / (1984.40 · 158.489 · 4.00388e-15) = 3.97063e17, its fourth root 25102.4 m.
TEST(Radar, FollowsTheRadarEquation) {
  const Place place;
  const std::string rest =
      "power_w: 50000, wavelength_m: 0.1, cross_section_m2: 0.1, receive_loss_db: 2,"
      " transmit_loss_db: 3, noise_figure_db: 4, temperature_k: 290, bandwidth_hz: 1.0e6,";
  const auto range = [&](const std::string& gains) {
    return make_environment("radar", "{at_m: [0, 0, 50], equation: {" + rest + gains + "}}",
                            place.site)
        ->info()
        .threats.at(0)
        .radius;
  };
  EXPECT_NEAR(range("transmit_gain_db: 35, detection_factor_db: 13"), 25102.4, 0.1);
  EXPECT_NEAR(range("transmit_gain: 3162.2776601683795, receive_gain_db: 35,"
                    " detection_factor: 19.952623149688797"),
              25102.4, 0.1);
  // Sixteen times the detection factor halves the range.
  EXPECT_NEAR(range("transmit_gain_db: 35, detection_factor: 319.2419703950208"), 12551.2, 0.1);
}

TEST(Radar, MaskedPointsAreThoseWithoutLineOfSight) {
  const Place place;
  const auto radar = make_environment(
      "radar", "{at_m: [0, 0], above_ground_m: 20, range_m: 1900, masking: true}", place.site);
  const Vec3 antenna(0, 0, *place.hills->field().at(0, 0) + 20);
  EXPECT_EQ(radar->over_approximation(), 1);
  RandomStream random;
  int hidden = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p(random.uniform(-2000, 2000), random.uniform(-2000, 2000), random.uniform(0, 400));
    // Line of sight by dense sampling.
    double gap = kInfinity;
    for (int m = 1; m <= 200; ++m) {
      const Vec3 q = antenna + m / 200.0 * (p - antenna);
      gap = std::min(gap, q.z() - *place.hills->field().at(q.x(), q.y()));
    }
    const bool covered = (p - antenna).norm() < 1899 && gap > 3;
    const bool masked = (p - antenna).norm() < 1899 && gap < -1e-6;
    hidden += masked;
    if (covered) {
      ASSERT_LE(radar->clearance(p), 0) << p.transpose();
      ASSERT_TRUE(radar->blocked(p, p, 1e-5)) << p.transpose();
    } else if (masked) {
      ASSERT_GT(radar->clearance(p), 0) << p.transpose();
    }
    // 1-Lipschitz, so no covered point is nearer than the clearance.
    const Vec3 q =
        p + Vec3(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
    ASSERT_LE(std::abs(radar->clearance(p) - radar->clearance(q)), (p - q).norm() + 1e-6);
  }
  EXPECT_GT(hidden, 1000);
}

TEST(Radar, MaskedLegsAreNeverFreeWhereAPlaceIsCovered) {
  const Place place;
  const auto radar = make_environment(
      "radar", "{at_m: [0, 0], above_ground_m: 20, range_m: 1900, masking: true}", place.site);
  RandomStream random;
  int free_legs = 0;
  int blocked_legs = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 a(random.uniform(-1900, 1900), random.uniform(1000, 1900), random.uniform(0, 200));
    const Vec3 b =
        a + Vec3(random.uniform(-600, 600), random.uniform(-50, 50), random.uniform(-40, 40));
    double minimum = kInfinity;
    for (int m = 0; m <= 500; ++m) {
      minimum = std::min(minimum, radar->clearance(a + m / 500.0 * (b - a)));
    }
    const double r = random.uniform(0, 20);
    const bool blocked = radar->blocked(a, b, r);
    (blocked ? blocked_legs : free_legs) += 1;
    if (minimum < r - 1e-6) {
      EXPECT_TRUE(blocked) << n;
    } else if (minimum > r + radar->over_approximation() + (b - a).norm() / 500) {
      EXPECT_FALSE(blocked) << n;
    }
    EXPECT_EQ(blocked, radar->blocked(b, a, r));
    EXPECT_LE(blocked, radar->blocked(a, b, r + 0.3));
  }
  EXPECT_GT(free_legs, 50);
  EXPECT_GT(blocked_legs, 50);
}

TEST(Radar, MaskedCellsCoverTheCoveredSpace) {
  const Place place;
  const auto radar = make_environment(
      "radar", "{at_m: [0, 0], above_ground_m: 20, range_m: 1500, masking: true}", place.site);
  const auto open =
      make_environment("radar", "{at_m: [0, 0], above_ground_m: 20, range_m: 1500}", place.site);
  GridSpec spec;
  spec.origin = {-2000, -2000, 0};
  spec.cell = {50, 50, 20};
  spec.counts = {80, 80, 20};
  VoxelGrid grid(spec);
  VoxelGrid all(spec);
  radar->rasterize(grid);
  open->rasterize(all);
  EXPECT_LT(grid.blocked_count() + 1000, all.blocked_count());
  RandomStream random;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p(random.uniform(-1999, 1999), random.uniform(-1999, 1999), random.uniform(0, 400));
    if (radar->clearance(p) < 0) {
      ASSERT_TRUE(grid.blocked(spec.cell_of(p))) << p.transpose();
    }
  }
}

TEST(Radar, RefusesWhatItCannotPlace) {
  const World nothing;
  Site bare;
  bare.before = &nothing;
  EXPECT_NE(refusal("{at_m: [0, 0], range_m: 5}", bare).find("height of its antenna"),
            std::string::npos);
  EXPECT_NE(refusal("{at_m: [0, 0, 5], range_m: 5, masking: true}", bare).find("layer with ground"),
            std::string::npos);
  const Place place;
  EXPECT_NE(refusal("{at_m: [0, 0, -500], range_m: 5, masking: true}", place.site).find("below"),
            std::string::npos);
  for (const char* wrong :
       {"{at_m: [0, 0, 5]}", "{at_m: [0, 0, 5], range_m: -2}",
        "{at_m: [0, 0, 5], range_m: 5, equation: {power_w: 5}}",
        "{at_m: [0, 0, 5], equation: {power_w: 5, wavelength_m: 1, cross_section_m2: 1,"
        " bandwidth_hz: 1, transmit_gain: 3, transmit_gain_db: 3, detection_factor: 1}}",
        "{at_m: [0, 0, 5], equation: {power_w: 5, wavelength_m: 1, cross_section_m2: 1,"
        " bandwidth_hz: 1, transmit_gain: 3}}"}) {
    EXPECT_NE(parameter_problems("environment", "radar", wrong), "") << wrong;
  }
}
}  // namespace
}  // namespace altiplan::testing::radar_test
