// SPDX-License-Identifier: Apache-2.0
#include "altiplan/energy.hpp"

#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "support/support.hpp"

namespace altiplan::energy_objective_test {
namespace {
using testing::make_objective;

Request request_at(double speed_mps) {
  Request request =
      testing::request_in({}, {0, 0, 100}, {1000, 0, 100}, {{0, 0, 0}, {1000, 1000, 400}});
  request.vehicle.speed_mps = speed_mps;
  return request;
}

TEST(EnergyObjective, IsPowerTimesTime) {
  const Request request = request_at(20);
  const auto energy = make_objective("energy", "{power_w: 180}");
  // 500 m at 20 m/s are 25 s.
  EXPECT_NEAR(energy->cost(Leg::straight({0, 0, 100}, {300, 400, 100}), 0, request),
              180.0 * 25 / 3600, 1e-12);
  EXPECT_LE(energy->bound({0, 0, 100}, {300, 400, 100}, request), 180.0 * 25 / 3600);
  EXPECT_EQ(energy->unit(), "Wh");
}

TEST(EnergyObjective, StopsAreCountedOfAWholeRoute) {
  Request request = request_at(10);
  request.vehicle.acceleration.mps2 = 2;
  const auto energy = make_objective("energy", "{power_w: 180}");
  const Route route(Polyline{{0, 0, 100}, {500, 0, 100}, {1000, 0, 100}});
  // Each of two legs takes 50 s, and v / a = 5 s more from rest to rest.
  EXPECT_NEAR(energy->cost(route, request), 180.0 * 110 / 3600, 1e-9);
}

TEST(EnergyObjective, NeedsAPower) { EXPECT_THROW(make_objective("energy", "{}"), Error); }
}  // namespace
}  // namespace altiplan::energy_objective_test
