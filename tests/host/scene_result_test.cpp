// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/measures.hpp"
#include "host/flight/events.hpp"
#include "host/view/picture_svg.hpp"
#include "scene_stored.hpp"

namespace altiplan::host::scene_result_test {
namespace {

using testing::kTold;
constexpr const char* kPast =
    "steps: [{plan: told, with: {does: past, past_m: [500, 600, 550]}}]\n";
constexpr const char* kFlown = "steps: [{plan: told}, {fly: route}]\n";

using SceneResult = testing::SceneResult;

TEST_F(SceneResult, TheProfileIsThatOfTheRoute) {
  scenario(
      "environment: [{sphere: {at_m: [500, 700, 500], radius_m: 50}}]\n"
      "vehicle: {radius_m: 2, speed_mps: 30, speed_near: [{within_m: 60, speed_mps: 10}]}\n");
  result(kPast);
  const Json got = shown();
  const Route route{{100, 500, 500}, {500, 600, 550}, {900, 500, 500}};
  EXPECT_EQ(got.at("route"), to_json(route));
  const Json& profile = got.at("profile");
  const std::size_t samples = profile.at("s").size();
  EXPECT_LE(samples, 300U);
  EXPECT_GT(samples, 250U);
  const Mission made = mission();
  const Measures measures = measure(route, made.request);
  std::size_t waypoint = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const Json& at = profile.at("at")[i];
    const Vec3 p(at[0].get<double>(), at[1].get<double>(), at[2].get<double>());
    const double clearance = made.known.clearance(p);
    EXPECT_NEAR(profile.at("clearance")[i].get<double>(), clearance, 3e-3);
    EXPECT_EQ(profile.at("clearance")[i], profile.at("to").at("sphere")[i]);
    EXPECT_EQ(profile.at("altitude")[i], at[2]);
    EXPECT_TRUE(profile.at("ground")[i].is_null());
    if (std::abs(clearance - 60) > 0.01) {
      EXPECT_EQ(profile.at("speed")[i], clearance < 60 ? 10 : 30);
    }
    if (waypoint < 3 && (p - route[waypoint]).norm() < 1e-9) {
      ++waypoint;
    }
    EXPECT_EQ(profile.at("turn")[i].is_null(), p != route[1]);
  }
  EXPECT_EQ(waypoint, 3U) << "every waypoint is a sample";
  EXPECT_NEAR(profile.at("s").back().get<double>(), length(route), 1e-3);
  const Json& turns = profile.at("turn");
  const auto turn =
      std::find_if(turns.begin(), turns.end(), [](const Json& t) { return !t.is_null(); });
  EXPECT_NEAR(turn->get<double>(), measures.max_turn_deg.value(), 1e-3);
}

TEST_F(SceneResult, LimitsAreThoseOfTheRun) {
  result(kTold +
         std::string("constraints: [{turn_angle: {max_deg: 60}}, {clearance: {min_m: 5}}]\n"));
  EXPECT_EQ(shown().at("limits"), Json::parse(R"({"clearance_m": 5.0, "ground_clearance_m": null,
    "turn_deg": 60.0, "climb_deg": null})"));
}

TEST_F(SceneResult, AResultWithoutARouteShowsItsWorldAndWhy) {
  scenario("environment: [{box: {min_m: [400, 0, 0], max_m: [500, 1000, 1000]}}]\n");
  const Json all = scene(kTold);
  const Json& got = all.at("results").at(0);
  EXPECT_EQ(all.at("solids").size(), 1U);
  EXPECT_EQ(got.at("status"), "rejected");
  EXPECT_NE(got.at("message"), "");
  EXPECT_TRUE(got.at("route").is_null());
  EXPECT_TRUE(got.at("profile").is_null());
  EXPECT_TRUE(got.at("flight").is_null());
  EXPECT_EQ(got.at("steps").at(0).at("route").size(), 2U) << "what was rejected";
  EXPECT_EQ(got.at("steps").at(0).at("check").at("ok"), false);
}

TEST_F(SceneResult, EventsHappenAtTheFirstPointAtOrAfter) {
  scenario(R"(vehicle: {speed_mps: 10}
moving:
  - sphere: {at_m: [500, 400, 500], radius_m: 10, velocity_mps: [0, 1, 0]}
    known: false
events:
  - {at_s: 20.5, id: late, add: {sphere: {at_m: [500, 900, 500], radius_m: 20}}}
  - {at_s: 500, remove: late}
  - {when_near: {at_m: [600, 500, 500], within_m: 100}, move_goal: {at_m: [900, 500, 500]}}
)");
  result(kFlown);
  const Json flight = shown().at("flight");
  ASSERT_EQ(flight.at("event_times").size(), 3U);
  const Json& track = flight.at("track");
  const auto first = [&](const auto& fits) {
    return (*std::find_if(track.begin(), track.end(), fits))[0];
  };
  EXPECT_EQ(flight.at("event_times")[0], first([](const Json& p) { return p[0] >= 20.5; }));
  EXPECT_TRUE(flight.at("event_times")[1].is_null()) << "the flight had ended";
  EXPECT_EQ(flight.at("event_times")[2], first([](const Json& p) { return p[1] >= 500; }));

  const Json& profile = flight.at("profile");
  ASSERT_EQ(profile.at("t").size(), track.size() + 1) << "where it came nearest, too";
  double least = kInfinity;
  for (std::size_t i = 0; i < profile.at("t").size(); ++i) {
    const double t = profile.at("t")[i];
    const Vec3 p(100 + profile.at("s")[i].get<double>(), 500, 500);
    EXPECT_NEAR(p.x(), 100 + 10 * t, 0.01);
    double clearance = (p - Vec3(500, 400 + t, 500)).norm() - 10;
    if (t >= flight.at("event_times")[0].get<double>()) {
      clearance = std::min(clearance, (p - Vec3(500, 900, 500)).norm() - 20);
    }
    EXPECT_NEAR(profile.at("clearance")[i].get<double>(), clearance, 6e-3) << t;
    least = std::min(least, profile.at("clearance")[i].get<double>());
    EXPECT_NEAR(profile.at("speed")[i].get<double>(), 10, 0.05);
  }
  EXPECT_NEAR(least, flight.at("min_separation_m").get<double>(), 0.01);
  EXPECT_EQ(profile.at("to").at("moving").size(), profile.at("t").size());
  EXPECT_TRUE(profile.at("to").at("sphere")[0].is_null()) << "it has not come yet";
}

TEST_F(SceneResult, ALongTrackIsThinnedAndKeepsWhatHappens) {
  result(kFlown);
  edit("result.json", [](Json& json) {
    Json track = Json::array();
    for (int i = 0; i <= 60'000; ++i) {  // to the east, and at 41,003 to the north
      track.push_back(
          {i * 0.01, 100 + std::min(i, 41'003) * 0.01, 500 + std::max(0, i - 41'003) * 0.01, 500});
    }
    track[41'004][3] = 501;  // too fast, there and back
    json["flight"]["track"] = track;
    json["flight"]["handovers"] = {{{"at_s", 123.45}, {"to", "route"}, {"why", "so"}}};
  });
  const Json all = scene_of({(folder_ / "result.json").string()}).json;
  const Json& flight = all.at("results").at(0).at("flight");
  const Json& track = flight.at("track");
  EXPECT_LE(track.size(), 20'000U);
  EXPECT_GT(track.size(), 10'000U);
  EXPECT_EQ(track.front()[0], 0);
  EXPECT_EQ(track.back()[0], 600);
  const auto has = [&](double t) {
    return std::any_of(track.begin(), track.end(), [&](const Json& p) { return p[0] == t; });
  };
  EXPECT_TRUE(has(123.45)) << "a handover";
  EXPECT_TRUE(has(410.03)) << "a turn";
  EXPECT_EQ(track.at(flight.at("check").at("violations")[0].at("at").get<std::size_t>())[0], 410.03)
      << "a violation's point is counted in the thinned track";
  EXPECT_LE(flight.at("profile").at("t").size(), 310U);
  for (std::size_t i = 1; i < track.size(); ++i) {
    ASSERT_LE(track[i][0].get<double>() - track[i - 1][0].get<double>(), 0.1) << "evenly, too";
  }
  ASSERT_EQ(all.at("notes").size(), 2U);
  EXPECT_HAS(all.at("notes")[0].get<std::string>(), " of its 60001 points");
  EXPECT_HAS(all.at("notes")[1].get<std::string>(), "says solved; judged now: not_reached: ");
}

TEST_F(SceneResult, ManyViolationsAreCut) {
  result(kTold + std::string("constraints: [{turn_angle: {max_deg: 60}}]\n"));
  edit("result.json", [](Json& json) {
    Json route = Json::array();
    for (int i = 0; i < 1500; ++i) {  // a zigzag
      route.push_back({100 + i * 0.1, i % 2 == 0 ? 500 : 501, 500});
    }
    json["route"] = route;
  });
  EXPECT_EQ(shown().at("check").at("violations").size(), 1000U);
}

TEST_F(SceneResult, WhatIsShownIsJudgedNow) {
  const std::string file = result(kTold);
  const Json before = shown();
  EXPECT_EQ(before.at("status"), "solved");
  EXPECT_TRUE(before.at("judged").is_null());
  scenario("environment: [{sphere: {at_m: [500, 500, 500], radius_m: 20}}]\n");
  const Scene scene = scene_of({file});
  const Json& now = scene.json.at("results").at(0);
  EXPECT_EQ(now.at("status"), "rejected");
  EXPECT_EQ(now.at("judged"), "result.json says solved; judged now: rejected");
  EXPECT_HAS(now.at("message").get<std::string>(), "judged now: rejected: the judge found 1 viol");
  EXPECT_EQ(now.at("check").at("ok"), false);
  EXPECT_NEAR(now.at("metrics").at("min_clearance_m").get<double>(), -20, 1e-3);
  EXPECT_EQ(now.at("metrics").at("expanded"), before.at("metrics").at("expanded"));
  EXPECT_EQ(now.at("steps").at(0).at("status"), "rejected");
  EXPECT_EQ(now.at("steps").at(0).at("check").at("ok"), false);
  ASSERT_EQ(scene.warnings.size(), 2U);
  EXPECT_HAS(scene.warnings[1], "result.json says solved; judged now: rejected: ");
  EXPECT_HAS(picture_svg(scene.json), "result.json says solved; judged now: rejected: ");
}

TEST_F(SceneResult, AnEditedResultIsJudgedNow) {
  scenario("environment: [{sphere: {at_m: [500, 700, 500], radius_m: 50}}]\n");
  result(kTold);
  const Json before = shown();
  edit("result.json", [](Json& json) {
    json["status"] = "rejected";
    json["metrics"]["length_m"] = 1;
    json["check"]["ok"] = false;
  });
  Json now = shown();
  EXPECT_EQ(now.at("status"), "solved");
  EXPECT_EQ(now.at("message"), "result.json says rejected; judged now: solved");
  EXPECT_EQ(now.at("metrics"), before.at("metrics"));
  EXPECT_EQ(now.at("check"), before.at("check"));
  edit("result.json", [](Json& json) {
    json["status"] = "cancelled";  // which only the run can know
    json["message"] = "interrupted";
  });
  EXPECT_EQ(shown().at("status"), "cancelled");
  EXPECT_EQ(shown().at("message"), "interrupted");
  edit("result.json", [](Json& json) {
    json["status"] = "solved";
    json["route"] = nullptr;
  });
  now = shown();
  EXPECT_EQ(now.at("status"), "no_route");
  EXPECT_TRUE(now.at("metrics").at("length_m").is_null());
  EXPECT_TRUE(now.at("check").is_null());
}

TEST_F(SceneResult, AFlightIsJudgedNow) {
  const std::string file = result(kFlown);
  const Json before = shown();
  EXPECT_EQ(before.at("flight").at("status"), "solved");
  EXPECT_TRUE(before.at("flight").at("judged").is_null());
  edit("result.json", [](Json& json) {
    json["flight"]["collisions"] = 7;
    json["flight"]["reached"] = false;
    json["flight"]["min_separation_m"] = 3;
    json["flight"]["metrics"]["length_m"] = 1;
  });
  EXPECT_EQ(shown().at("flight"), before.at("flight"));
  scenario(
      "moving: [{sphere: {at_m: [500, 500, 500], radius_m: 9, velocity_mps: [0, 0, 0]}, "
      "known: false}]\n");
  const Json now = shown();
  EXPECT_EQ(now.at("flight").at("status"), "collided");
  EXPECT_EQ(now.at("flight").at("collisions"), 1);
  EXPECT_EQ(now.at("flight").at("reached"), false);
  EXPECT_NEAR(now.at("flight").at("min_separation_m").get<double>(), -9, 1e-3);
  EXPECT_HAS(now.at("flight").at("message").get<std::string>(), "the vehicle touches 'sphere_1'");
  EXPECT_EQ(now.at("status"), "collided");
  EXPECT_EQ(now.at("judged"), "result.json says solved; judged now: collided");
}

TEST_F(SceneResult, SeveralResultsOfOneWorld) {
  scenario("environment: [{sphere: {at_m: [500, 900, 100], radius_m: 20}}]\n");
  const std::string a = result(kTold, "a.json");
  const std::string b = result(kPast, "b.json");
  std::filesystem::create_directories(folder_ / "other");
  const std::string c = result(kTold, "other/a.json");
  const Json both = scene_of({a, b}).json;
  EXPECT_EQ(both.at("solids").size(), 1U);
  EXPECT_EQ(both.at("results")[0].at("name"), "a");
  EXPECT_EQ(both.at("results")[1].at("name"), "b");
  EXPECT_EQ(both.at("results")[1].at("route").size(), 3U);
  EXPECT_EQ(scene_of({a, c}).json.at("results")[1].at("name"), c) << "names that tell them apart";
}

TEST_F(SceneResult, ResultsOfDifferentWorldsAreRefused) {
  const std::string a = result(kTold, "a.json");
  overrides_.set = {"scenario.vehicle.radius_m=3"};
  const std::string b = result(kTold, "b.json");
  EXPECT_EQ(scene_refusal({a, b}),
            "'a.json' and 'b.json' are of different worlds: s.yaml, and s.yaml --set "
            "scenario.vehicle.radius_m=3");
  overrides_.set.clear();
  overrides_.seed = 5;
  const std::string c = result(kTold, "c.json");
  EXPECT_EQ(scene_refusal({a, c}), "") << "nothing in this world follows the seed";
  scenario("moving: [{random: {count: 3, radius_m: 4, speed_mps: 7}, id: bird}]\n");
  const std::string d = result(kTold, "d.json");
  overrides_.seed = 6;
  const std::string e = result(kTold, "e.json");
  EXPECT_EQ(scene_refusal({d, d}), "");
  EXPECT_HAS(scene_refusal({d, e}),
             "'d.json' and 'e.json' are of different worlds: with the seed "
             "5, and with the seed 6, which");
}

TEST_F(SceneResult, ChangedFilesAreNamed) {
  const std::string file = result(kTold);
  scenario("environment: [{sphere: {at_m: [500, 900, 100], radius_m: 20}}]\n");
  const Scene changed = scene_of({file});
  ASSERT_EQ(changed.warnings.size(), 1U);
  EXPECT_EQ(without_folder(changed.warnings[0]),
            "s.yaml has changed since result.json was written");
  EXPECT_EQ(changed.json.at("notes").size(), 1U);
}

}  // namespace
}  // namespace altiplan::host::scene_result_test
