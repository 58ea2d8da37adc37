// SPDX-License-Identifier: Apache-2.0
// The radius on which a track turns, as far as its samples tell.
#include <gtest/gtest.h>

#include "altiplan/random.hpp"
#include "host/flight/track_judge.hpp"
#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan::host::track_radius_test {
namespace {

double radius_of(const Polyline& track) { return track_radius(track, {}).radius_m.value(); }

/// The route with points in between, as a flight writes them: one a step, and each waypoint.
Polyline flown(const Polyline& route, double step) {
  Polyline track = {route.front()};
  double left = step;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Vec3 leg = route[i + 1] - route[i];
    double s = left;
    for (; s < leg.norm(); s += step) {
      track.push_back(route[i] + s / leg.norm() * leg);
    }
    left = s - leg.norm();
    track.push_back(route[i + 1]);
  }
  return track;
}

TEST(TrackRadius, IsThatOfACircleHoweverItIsSampled) {
  RandomStream random(3);
  for (const double radius : {20.0, 250.0, 4000.0}) {
    Polyline track;
    for (double angle = 0; angle < 3; angle += random.uniform(0.01, 0.3)) {
      track.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), 100 + 0.1 * radius * angle});
    }
    // A helix is a little wider than its circle: by the square of its slope.
    EXPECT_NEAR(radius_of(track), 1.01 * radius, 0.01 * radius);
    EXPECT_GE(radius_of(track), radius);
  }
}

TEST(TrackRadius, OfARouteWithTurnsIsTheRoutes) {
  const Polyline route = {{0, 0, 100}, {1000, 0, 100}, {1000, 1000, 100}, {0, 1000, 100}};
  Request request = testing::open_request(route);
  request.limits.min_turn_radius = 250;
  const Route turning = testing::make_smoother("arc")->smooth(route, request).route;
  ASSERT_EQ(turning.leg_count(), 5u);
  for (const double step : {1.0, 7.3, 25.0, 84.7}) {
    Polyline track;
    double s = 0;
    for (std::size_t i = 0; i < turning.leg_count(); ++i) {
      const Leg leg = turning.leg(i);
      for (; s < leg.length(); s += step) {
        track.push_back(leg.at(s / leg.length()));
      }
      s -= leg.length();
    }
    EXPECT_GE(radius_of(track), 250 - 1e-3) << step;
  }
}

TEST(TrackRadius, OfASharpCornerIsItsFillet) {
  const Polyline route = {{0, 0, 100}, {400, 0, 100}, {400, 400, 100}};
  for (const double step : {0.5, 10.0, 33.3}) {
    EXPECT_NEAR(radius_of(flown(route, step)), 200, 1e-3) << step;
  }
  // Straight back is no curve at all.
  EXPECT_EQ(radius_of({{0, 0, 0}, {100, 0, 0}, {50, 0, 0}}), 0);
  EXPECT_FALSE(track_radius(flown({{0, 0, 0}, {3, 4, 5}}, 0.1), {}).radius_m);
}

TEST(TrackRadius, ATurnOnTheSpotHasNone) {
  const Polyline track = flown({{0, 0, 100}, {500, 0, 100}, {500, 0, 600}, {500, 500, 600}}, 20);
  EXPECT_EQ(radius_of(track), 0);
  Vehicle vehicle;
  vehicle.turns_on_the_spot = true;
  EXPECT_NEAR(track_radius(track, vehicle).radius_m.value(), 250, 1e-3);
}
}  // namespace
}  // namespace altiplan::host::track_radius_test
