// SPDX-License-Identifier: Apache-2.0
// Moving obstacles of a scenario that routes are planned against: `known: true`.
#include <gtest/gtest.h>

#include <cmath>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/measures.hpp"
#include "host/import_export/export.hpp"
#include "host/import_export/route_format.hpp"
#include "host/mission/mission.hpp"
#include "host/result/legs_json.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::host {
namespace {

constexpr const char* kSteps = R"(altiplan: 1
name: x
scenario: scenario.yaml
steps:
  - plan: astar
    id: route
    with: {cell_m: [50, 50, 10]}
  - fly: route
)";

/// A ball that crosses the straight line to the goal when the vehicle is there, or what follows.
std::string scenario(const std::string& known, const std::string& via = "") {
  return R"(altiplan: 1
name: x
frame: {origin_lonlat: [10, 50]}
volume: {min_m: [0, -200, 0], max_m: [1000, 200, 100]}
vehicle: {radius_m: 2, speed_mps: 10}
start: {at_m: [0, 0, 50]}
goal: {at_m: [1000, 0, 50]}
moving:
  - sphere: {at_m: [500, -100, 50], radius_m: 20, velocity_mps: [0, 2, 0]}
    id: barge
)" + known +
         via;
}

class KnownMovers : public ::testing::Test {
 protected:
  Json ran(const std::string& scenario, const std::string& pipeline = kSteps) {
    folder_.write("scenario.yaml", scenario);
    return testing::run_file(folder_.write("pipeline.yaml", pipeline)).json;
  }

  testing::TempFolder folder_;
};

TEST_F(KnownMovers, APlanThatMeetsOneIsRefusedBeforeItCollides) {
  const Json known = ran(scenario("    known: true\n"));
  EXPECT_EQ(known["status"], "rejected");
  const Json& violation = known["steps"][0]["check"]["violations"][0];
  EXPECT_EQ(violation["constraint"], "moving");
  EXPECT_EQ(violation["limit"], 2);
  EXPECT_NE(violation["message"].get<std::string>().find("'barge'"), std::string::npos);
  EXPECT_TRUE(known["flight"].is_null());
  // Where the scenario does not say so, the flight tells, as before.
  for (const char* other : {"", "    known: false\n"}) {
    const Json flown = ran(scenario(other));
    EXPECT_TRUE(flown["steps"][0]["accepted"]) << other;
    EXPECT_EQ(flown["flight"]["collisions"], 1) << other;
  }
}

TEST_F(KnownMovers, AWaitIsJudgedFlownAndStored) {
  const std::string pipeline = (testing::configs() / "pipelines/among_movers.yaml").string();
  const Json json = testing::run_file(pipeline).json;
  ASSERT_EQ(json["status"], "solved") << json["message"];
  const Json& plan = json["steps"][0];
  const Vec3 start(plan["route"][0][0], plan["route"][0][1], plan["route"][0][2]);
  const Route route = route_of_legs(start, plan["legs"], "legs");
  EXPECT_TRUE(route.waits());
  EXPECT_EQ(legs_json(route), plan["legs"]);
  EXPECT_EQ(json["flight"]["collisions"], 0);
  EXPECT_NEAR(json["flight"]["metrics"]["duration_s"].get<double>(),
              plan["metrics"]["duration_s"].get<double>(), 1e-9);
  Overrides overrides;
  overrides.plugin_path = {altiplan::folders::build() / "lib/altiplan/plugins"};
  const Mission mission = build_mission(load_config(pipeline, overrides), 1);
  const Exported exported = export_route(mission, {"x", route, {}, {}}, {});
  EXPECT_FALSE(exported.text.has_value());
  ASSERT_EQ(exported.messages.size(), 1U);
  EXPECT_TRUE(exported.messages[0].starts_with("not written: the route waits 16."))
      << exported.messages[0];
}

TEST_F(KnownMovers, AWaitIsExportedAsAHoldOfWholeSeconds) {
  folder_.write("scenario.yaml", testing::replaced(scenario("    known: true\n"), "moving:",
                                                   R"(start_time: 2026-06-17T05:00:00Z
environment:
  - zones:
      in_time: true
      list:
        - polygon: {outline_m: [[300, -300], [400, -300], [400, 300], [300, 300]]}
          until: 2026-06-17T05:01:00Z
moving:)"));
  const std::string pipeline =
      folder_
          .write("pipeline.yaml", testing::replaced(testing::replaced(kSteps, "astar", "sipp"),
                                                    "  - fly: route\n", ""))
          .string();
  const Json json = testing::run_file(pipeline).json;
  ASSERT_EQ(json["status"], "solved") << json["message"];
  const Json& plan = json["steps"][0];
  const Route route = route_of_legs({0, 0, 50}, plan["legs"], "legs");
  double wait_s = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    wait_s = std::max(wait_s, route.leg(i).hold_s);
  }
  ASSERT_GT(wait_s, 20);
  ASSERT_NE(wait_s, std::ceil(wait_s));
  Overrides overrides;
  overrides.plugin_path = {altiplan::folders::build() / "lib/altiplan/plugins"};
  const Mission mission = build_mission(load_config(pipeline, overrides), 1);
  ExportOptions options;
  options.home_altitude_m = 0;
  const auto exported = [&](const char* format) {
    options.format = &format_named(format);
    options.altitude = options.format->frames.front();
    return export_route(mission, {"x", route, {}, {}}, options);
  };
  for (const char* format : {"qgc-plan", "waypoints"}) {
    const Exported file = exported(format);
    ASSERT_TRUE(file.text.has_value()) << file.messages[0];
    std::vector<double> holds;
    for (const auto& command : formats::read_mission("x", *file.text).commands) {
      if (command.number == 16 && command.params[0] > 0) {
        holds.push_back(command.params[0]);
      }
    }
    EXPECT_EQ(holds, std::vector<double>{std::ceil(wait_s)}) << format;
  }
  for (const char* format : {"kml", "gpx", "geojson", "csv", "wpml", "litchi"}) {
    const Exported file = exported(format);
    EXPECT_FALSE(file.text.has_value()) << format;
    EXPECT_NE(file.messages[0].find("the format cannot say: use qgc-plan"), std::string::npos);
  }
  options.max_items = 12;
  EXPECT_FALSE(exported("qgc-plan").text.has_value());
}

TEST_F(KnownMovers, EveryPartOfARouteBeginsWhenTheOneBeforeEnds) {
  // From the via point the straight line is free only at the time at which the vehicle gets there.
  const std::string sipp = testing::replaced(kSteps, "astar", "sipp");
  const Json json =
      ran(testing::replaced(scenario("    known: true\n", "via: [{at_m: [200, 0, 50]}]\n"),
                            "at_m: [500, -100, 50]", "at_m: [500, -60, 50]"),
          sipp);
  EXPECT_EQ(json["status"], "solved") << json["message"];
  EXPECT_EQ(json["flight"]["collisions"], 0);
}

TEST_F(KnownMovers, AStoredWaitThatCannotBeIsRefused) {
  const Vec3 start(0, 0, 0);
  const auto problem = [&](const Json& leg) {
    try {
      route_of_legs(start, Json::array({leg}), "file: legs");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(problem({{"kind", "straight"}, {"end", {0, 0, 0}}, {"hold_s", 2}}), "");
  EXPECT_NE(problem({{"kind", "straight"}, {"end", {1, 0, 0}}, {"hold_s", 2}}).find("hold_s"),
            std::string::npos);
  EXPECT_NE(problem({{"kind", "straight"}, {"end", {0, 0, 0}}, {"hold_s", -2}}).find("hold_s"),
            std::string::npos);
}
}  // namespace
}  // namespace altiplan::host
