// SPDX-License-Identifier: Apache-2.0
#include "host/result/legs_json.hpp"

#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/random.hpp"
#include "files.hpp"

namespace altiplan::host::legs_json_test {
namespace {

using Json = nlohmann::ordered_json;

const Vec3 kStart(100, 200, 50);

Route read(const std::string& legs) {
  return route_of_legs(kStart, Json::parse(legs), "r.json: legs");
}

std::string refusal(const std::string& legs) {
  try {
    read(legs);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

Route random_route(RandomStream& random) {
  Route route{random.in({{-1e4, -1e4, 0}, {1e4, 1e4, 2000}})};
  for (int leg = 0; leg < 5; ++leg) {
    const double turn = random.uniform(-3 * kPi, 3 * kPi);
    const double radius = random.uniform(10, 500);
    const Vec3 drift = random.integer(0, 1) == 0
                           ? Vec3(0, 0, 0)
                           : Vec3(random.uniform(-50, 50), random.uniform(-50, 50), 0);
    if (random.integer(0, 2) == 0) {
      route.push_back(Vec3(route.back() + random.in({{1, 1, 1}, {100, 100, 100}})));
    } else {
      const Pose from{route.back(), random.uniform(-kPi, kPi)};
      route.push_back(Leg::turning(from, turn, radius, random.uniform(-20, 20), drift));
    }
  }
  return route;
}

TEST(LegsJson, WhatIsWrittenIsReadBack) {
  RandomStream random(11);
  for (int n = 0; n < 200; ++n) {
    const Route route = random_route(random);
    const Route again = route_of_legs(route.front(), Json::parse(legs_json(route).dump()), "r");
    ASSERT_EQ(again.size(), route.size());
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      const Leg was = route.leg(i);
      const Leg is = again.leg(i);
      ASSERT_EQ(is.kind(), was.kind());
      for (const double t : {0.0, 0.3, 1.0}) {
        ASSERT_LT((is.at(t) - was.at(t)).norm(), 1e-9) << n << ' ' << i;
      }
    }
  }
}

TEST(LegsJson, AHeadingLeftOutFollowsFromTheChord) {
  for (const double turn : {0.5, 3.0, 4.0, -1.0, -5.5, 7.0, -9.0}) {
    const Leg leg = Leg::turning({kStart, 0.7}, turn, 80, 5, {3, -2, 0});
    Route route;
    route.push_back(leg);
    Json json = legs_json(route);
    json[0].erase("heading_deg");
    const Leg is = route_of_legs(kStart, json, "r").leg(0);
    EXPECT_LT((is.at(0.5) - leg.at(0.5)).norm(), 1e-9) << turn;
  }
}

TEST(LegsJson, WhatIsNoLegIsRefusedByItsPlace) {
  const std::string arc = R"([{"kind": "straight", "end": [9, 9, 9]}, {"kind": "arc", )";
  const std::string end = R"("end": [1, 2, 3], )";
  const std::string straight = R"([{"kind": "straight", "end": [9, 9, 9], )";
  const std::string trochoid =
      R"([{"kind": "trochoid", "end": [1, 2, 3], "turn_deg": 90, "radius_m": 5, )";
  const struct {
    std::string legs;
    const char* message;
  } cases[] = {
      {"{}", "r.json: legs: expected a list, found an object"},
      {"[7]", "r.json: legs.0: expected an object, found '7'"},
      {R"([{"kind": "straight"}])",
       "legs.0.end: expected a list of 3 numbers in metres, found nothing"},
      {R"([{"kind": "straight", "end": [1, 2]}])", "legs.0.end: expected a list of 3 numbers"},
      {R"([{"kind": "straight", "end": [1, 2, "3"]}])", "legs.0.end: expected a list of 3 numbers"},
      {R"([{"end": [1, 2, 3]}])", "legs.0.kind: expected one of straight, arc, trochoid"},
      {R"([{"kind": 4, "end": [1, 2, 3]}])", "legs.0.kind: expected one of straight, arc"},
      {arc + end + R"("radius_m": 5}])", "legs.1.turn_deg: expected a number, found nothing"},
      {arc + end + R"("turn_deg": "left", "radius_m": 5}])", "legs.1.turn_deg: expected a number"},
      {arc + end + R"("turn_deg": 0, "radius_m": 5}])", "legs.1.turn_deg: expected an angle other"},
      {arc + end + R"("turn_deg": 36001, "radius_m": 5}])", "at most 36000 degrees either way"},
      {arc + end + R"("turn_deg": 90, "radius_m": 0}])",
       "legs.1.radius_m: expected a radius above"},
      {arc + end + R"("turn_deg": 90, "radius_m": 1e9}])", "radius_m: expected a radius above 0"},
      {arc + end + R"("turn_deg": 90, "radius_m": 5, "drift_m": [1, 2, 3]}])",
       "legs.1.drift_m: expected a list of 2 numbers in metres"},
      {arc + end + R"("turn_deg": 90, "radius_m": 5, "heading_deg": "N"}])",
       "legs.1.heading_deg: expected a number"},
      {straight + R"("turn_deg": []}])",
       "legs.0.turn_deg: expected null on a straight leg, found a list"},
      {straight + R"("radius_m": -1}])", "legs.0.radius_m: expected null on a straight leg"},
      {straight + R"("heading_deg": 0}])", "legs.0.heading_deg: expected null on a straight leg"},
      {straight + R"("drift_m": {}}])", "legs.0.drift_m: expected null on a straight leg"},
      {trochoid + R"("drift_m": [1, 2], "heading_deg": null}])",
       "legs.0.heading_deg: expected a number, found"},
      {trochoid + R"("drift_m": null}])",
       "legs.0.drift_m: expected the drift of a trochoid, which is not 0"},
      {trochoid + R"("drift_m": [0, 0]}])", "legs.0.drift_m: expected the drift of a trochoid"},
      {arc + end + R"("turn_deg": 90, "radius_m": 5, "drift_m": [1, 2]}])",
       "legs.1.drift_m: expected no drift of an arc"},
  };
  for (const auto& [legs, message] : cases) {
    EXPECT_HAS(refusal(legs), message);
  }
  EXPECT_EQ(refusal(arc + end + R"("turn_deg": 36000, "radius_m": 5}])"), "accepted");
  const std::string nulls = R"("heading_deg": null, "drift_m": null}])";
  EXPECT_EQ(refusal(arc + end + R"("turn_deg": 90, "radius_m": 5, )" + nulls), "accepted");
  EXPECT_EQ(refusal(straight + R"("turn_deg": null, "radius_m": null, )" + nulls), "accepted");
}
}  // namespace
}  // namespace altiplan::host::legs_json_test
