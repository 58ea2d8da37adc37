// SPDX-License-Identifier: Apache-2.0
// Zones that are closed at times, to the judge and to sipp.
#include <gtest/gtest.h>

#include "altiplan/formats/iso_time.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "altiplan/measures.hpp"
#include "host/judge/judge.hpp"
#include "support/support.hpp"

namespace altiplan::zone_hours_test {
namespace {

constexpr double kStart = 1'781'672'400;  // 2026-06-17T05:00:00Z

std::string clock(double after_s) {
  char text[48];
  const int s = int(after_s);
  std::snprintf(text, sizeof text, "2026-06-17T%02d:%02d:%02dZ", 5 + s / 3600, s / 60 % 60, s % 60);
  return text;
}

Request request_with(const std::string& list, const std::string& more = ", in_time: true") {
  static const World nothing;
  Site site;
  site.before = &nothing;
  site.has_start_time = true;
  site.start_time_s = kStart;
  Request request = testing::request_in(
      testing::world_of(
          testing::make_environment("zones", "{list: [" + list + "]" + more + "}", site), "zones"),
      {5, 55, 5}, {95, 55, 5}, {{0, 0, 0}, {100, 100, 10}});
  request.vehicle.speed_mps = 5;
  request.limits.min_clearance = request.vehicle.radius_m = 1;
  return request;
}

/// A wall across the way with an opening in the north, closed as `when` says.
std::string wall(const std::string& when, double north = 70) {
  return "{polygon: {outline_m: [[40, 0], [50, 0], [50, " + std::to_string(north) + "], [40, " +
         std::to_string(north) + "]]}" + when + "}";
}

PlanResult plan_of(const Request& request) {
  return testing::make_planner("sipp", "{cell_m: [10, 10, 10]}")->plan(request);
}

double duration_of(const PlanResult& plan, const Request& request) {
  EXPECT_EQ(plan.status, PlanStatus::solved) << plan.message;
  return plan.status == PlanStatus::solved ? *measure(plan.route, request).duration_s : kInfinity;
}

TEST(ZoneHours, TheStartOfTheTestIsThatOfItsClock) {
  EXPECT_EQ(formats::parse_iso_time(clock(0)), kStart);
}

TEST(ZoneHours, WaitsGoesAroundOrPassesBefore) {
  const double straight = 18;
  const auto duration = [](const std::string& when) {
    const Request request = request_with(wall(when));
    const PlanResult plan = plan_of(request);
    EXPECT_TRUE(host::judge(plan.route, request, {}).ok()) << when;
    return duration_of(plan, request);
  };
  // The wall is 35 m from the start, less the radius and what a cell's centre lies before it.
  EXPECT_NEAR(duration(", until: '" + clock(4) + "'"), straight, 1e-2);
  EXPECT_NEAR(duration(", until: '" + clock(8) + "'"), 8 + 12, 1e-2);
  const double around = duration(", until: '" + clock(3600) + "'");
  EXPECT_GT(around, straight + 1);
  EXPECT_LT(around, 25);
  EXPECT_NEAR(duration(", from: '" + clock(15) + "'"), straight, 1e-2);
  EXPECT_NEAR(duration(", from: '" + clock(8) + "', until: '" + clock(9) + "'"), 9 + 12, 1e-2);
}

TEST(ZoneHours, TheJudgeHoldsLegsToTheTimesAtWhichTheyAreFlown) {
  const Route straight{{5, 55, 5}, {35, 55, 5}, {55, 55, 5}, {95, 55, 5}};
  const auto is_ok = [&](const std::string& when, const std::string& more) {
    return host::judge(straight, request_with(wall(when, 100), more), {}).ok();
  };
  const std::string in_time = ", in_time: true";
  // The second leg is flown from 6 to 10 s.
  EXPECT_TRUE(is_ok(", until: '" + clock(5) + "'", in_time));
  EXPECT_FALSE(is_ok(", until: '" + clock(7) + "'", in_time));
  EXPECT_FALSE(is_ok(", until: '" + clock(6) + "'", in_time));
  EXPECT_FALSE(is_ok(", from: '" + clock(10) + "'", in_time));
  EXPECT_TRUE(is_ok(", from: '" + clock(11) + "'", in_time));
  EXPECT_FALSE(is_ok("", in_time));
  EXPECT_FALSE(is_ok(", until: '" + clock(5) + "'", ""));
  // Beyond the horizon a zone is closed to the judge, but not to what knows no time.
  EXPECT_FALSE(is_ok(", from: '" + clock(7) + "'", in_time + ", horizon_s: 1"));
  // All else keeps out at all times.
  const Request request = request_with(wall(", until: '" + clock(5) + "'", 100));
  EXPECT_FALSE(check(straight, request).ok());
  EXPECT_EQ(testing::make_planner("astar", "{cell_m: [10, 10, 10]}")->plan(request).status,
            PlanStatus::no_route);
}

TEST(ZoneHours, ARouteThatCannotBeTimedIsHeldToAllZones) {
  Request request = request_with(wall(", until: '" + clock(5) + "'", 100));
  const Route straight{{5, 55, 5}, {35, 55, 5}, {55, 55, 5}, {95, 55, 5}};
  EXPECT_TRUE(host::judge(straight, request, {}).ok());
  request.vehicle.speed_near = {{5, 1}};
  EXPECT_FALSE(host::judge(straight, request, {}).ok());
}

TEST(ZoneHours, IsNoLaterThanWaitingForAllZonesAndNoEarlierThanWithoutThem) {
  int waited = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    RandomStream draw = RandomStream(seed).sub("hours");
    std::string list;
    double last = 0;
    for (int n = 0; n < 10; ++n) {
      const double x = draw.uniform(20, 80);
      const double y = draw.uniform(10, 90);
      const double from = std::floor(draw.uniform(0, 20));
      const double until = from + std::floor(draw.uniform(1, 25));
      const double radius = draw.uniform(8, 18);
      last = std::max(last, until);
      list += "{cylinder: {at_m: [" + std::to_string(x) + ", " + std::to_string(y) +
              "], radius_m: " + std::to_string(radius) + "}, from: '" + clock(from) +
              "', until: '" + clock(until) + "'}, ";
    }
    const Request request = request_with(list);
    if (!point_problem(request.start.position, request).empty() ||
        !point_problem(request.goal.position, request).empty()) {
      continue;
    }
    const PlanResult plan = plan_of(request);
    const double duration = duration_of(plan, request);
    Request open = request;
    open.world = std::make_shared<const World>();
    const double without = duration_of(plan_of(open), open);
    EXPECT_GE(duration, without - 1e-9) << seed;
    EXPECT_LE(duration, last + 2e-3 + without) << seed;
    EXPECT_TRUE(host::judge(plan.route, request, {}).ok()) << seed;
    const PlanResult around =
        testing::make_planner("astar", "{cell_m: [10, 10, 10]}")->plan(request);
    if (around.status == PlanStatus::solved) {
      EXPECT_LE(duration, length(around.route) / 5 + 1e-9) << seed;
    }
    waited += plan.route.waits();
  }
  EXPECT_GT(waited, 5);
}
}  // namespace
}  // namespace altiplan::zone_hours_test
