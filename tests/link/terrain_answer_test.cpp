// SPDX-License-Identifier: Apache-2.0
#include "link/terrain_answer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/ground.hpp"

namespace altiplan::link::terrain_answer_test {
namespace {

/// Ground that rises by a metre in ten to the east and two in ten to the north, up to 5 km away.
class Slope final : public Environment, public Ground {
 public:
  static double height_of(double x, double y) { return 500 + 0.1 * x + 0.2 * y; }

 private:
  Box do_bounds() const override { return {{-5000, -5000, -kInfinity}, {5000, 5000, 2000}}; }
  double do_clearance(const Vec3& p) const override { return p.z() - height_of(p.x(), p.y()); }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override {
    const bool is_inside = std::abs(x) <= 5000 && std::abs(y) <= 5000;
    return is_inside ? std::optional(height_of(x, y)) : std::nullopt;
  }
  double do_gap(const Vec3& a, const Vec3& b, double /*enough*/) const override {
    return std::min(do_clearance(a), do_clearance(b));
  }
  double do_slope(const Box& /*box*/) const override { return 0.3; }
};

World world() {
  return World()
      .with_frame(Frame::geographic(8, 47, 47))
      .with({"slope", "slope", std::make_shared<Slope>(), true});
}

TerrainRequest request(std::uint64_t mask) {
  TerrainRequest request;
  request.lat = 470'000'000;
  request.lon = 80'000'000;
  request.grid_spacing = 100;
  request.mask = mask;
  return request;
}

TEST(TerrainAnswer, HasTheGroundOfEachBlockThatIsAskedFor) {
  const World all = world();
  // The blocks of the corner, of the first row's end, and of the second row's begin.
  const Messages answer = terrain_answer(request(1 | 1 << 7 | 1 << 8), all);
  ASSERT_EQ(answer.size(), 3u);
  const int bits[] = {0, 7, 8};
  for (std::size_t n = 0; n < answer.size(); ++n) {
    const auto& data = std::get<TerrainData>(answer[n]);
    EXPECT_EQ(data.lat, 470'000'000);
    EXPECT_EQ(data.lon, 80'000'000);
    EXPECT_EQ(data.grid_spacing, 100);
    ASSERT_EQ(data.gridbit, bits[n]);
    for (int i = 0; i < 16; ++i) {
      const double north = 100.0 * (bits[n] / 8 * 4 + i / 4);
      const double east = 100.0 * (bits[n] % 8 * 4 + i % 4);
      EXPECT_NEAR(data.data[std::size_t(i)], Slope::height_of(east, north), 3) << n << " " << i;
    }
  }
}

TEST(TerrainAnswer, LeavesOutWhereTheWorldHasNoGround) {
  TerrainRequest far = request(1);
  far.lat = 480'000'000;
  EXPECT_TRUE(terrain_answer(far, world()).empty());
  EXPECT_TRUE(terrain_answer(request(1), World()).empty());
}
}  // namespace
}  // namespace altiplan::link::terrain_answer_test
