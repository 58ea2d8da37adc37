// SPDX-License-Identifier: Apache-2.0
// What a scene costs the report and its page; and the names of variants.
#include "study/report/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "altiplan/error.hpp"
#include "host/base/base64.hpp"
#include "host/base/machine_fault.hpp"
#include "support/files.hpp"

namespace altiplan::study::report::report_scenes_test {
using namespace host;
namespace {

TEST(ReportScenes, CostNothingButThemselves) {
  EXPECT_EQ(made_in_child([] { return std::string(200'000, 'x'); }, 20).size(), 200'000u);
  const auto why = [](const std::function<std::string()>& make, unsigned seconds = 20) {
    try {
      made_in_child(make, seconds);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(why([]() -> std::string { throw Error("no such file"); }), "no such file");
  EXPECT_THROW(made_in_child([]() -> std::string { throw std::bad_alloc(); }, 20), MachineFault);
  EXPECT_THROW(made_in_child([]() -> std::string { throw MachineFault("a disk"); }, 20),
               MachineFault);
  EXPECT_EQ(why([]() -> std::string { throw 1; }),
            "something that is not a std::exception was thrown");
  EXPECT_EQ(why([]() -> std::string {
              std::raise(SIGKILL);
              return "";
            }),
            "building it ends the process: Killed");
  EXPECT_EQ(why([]() -> std::string { std::_Exit(0); }),
            "building it ends the process with exit code 0");
  EXPECT_EQ(why(
                []() -> std::string {
                  for (volatile bool on = true; on;) {
                  }
                  return "";
                },
                1),
            "it was not built within 1 s");
}

/// A scene of nx by ny posts, higher by a metre with each column, and a profile of that many
/// samples.
Json scene_of(int nx, int ny, std::size_t samples) {
  std::vector<float> heights;
  for (int at = 0; at < nx * ny; ++at) {
    heights.push_back(at == 0 ? std::numeric_limits<float>::quiet_NaN() : float(at % nx));
  }
  Json profile{{"s", Json::array()},
               {"turn", Json::array()},
               {"altitude", Json::array()},
               {"ground", Json::array()},
               {"to", {{"zones", Json::array()}}}};
  for (std::size_t at = 0; at < samples; ++at) {
    profile["s"].push_back(at);
    profile["turn"].push_back(at % 100 == 50 ? Json(10.0) : Json(nullptr));
    profile["altitude"].push_back(100);
    profile["ground"].push_back(at == 77 ? Json(nullptr) : Json(at == 1011 ? 30 : 20));
    profile["to"]["zones"].push_back(at == 1013 ? 1 : 2);
  }
  return {{"ground",
           {{"nx", nx},
            {"ny", ny},
            {"x0", 5.0},
            {"y0", 6.0},
            {"dx", 2.0},
            {"dy", 3.0},
            {"heights", base64_of(heights)},
            {"of", nullptr}}},
          {"notes", Json::array()},
          {"results", {{{"profile", profile}, {"flight", nullptr}}}}};
}

TEST(ReportScenes, AreThinned) {
  Json scene = scene_of(400, 301, 2001);
  thin_scene(scene);
  const Json& ground = scene.at("ground");
  EXPECT_EQ(ground.at("nx"), 134);
  EXPECT_EQ(ground.at("ny"), 101);
  EXPECT_EQ(ground.at("dx"), 6.0);
  EXPECT_EQ(ground.at("dy"), 9.0);
  EXPECT_EQ(ground.at("of"), (Json{400, 301}));
  const std::vector<std::byte> bytes = from_base64(ground.at("heights").get<std::string>());
  ASSERT_EQ(bytes.size(), 134u * 101u * sizeof(float));
  std::vector<float> heights(134 * 101);
  std::memcpy(heights.data(), bytes.data(), bytes.size());
  EXPECT_TRUE(std::isnan(heights[0]));
  EXPECT_EQ(heights[1], 3);
  EXPECT_EQ(heights[134 + 133], 399);
  const Json& profile = scene.at("results")[0].at("profile");
  EXPECT_EQ(profile.at("s").size(), profile.at("turn").size());
  EXPECT_LE(profile.at("s").size(), 264u);
  EXPECT_EQ(profile.at("s").back(), 2000);
  EXPECT_EQ(std::count(profile.at("turn").begin(), profile.at("turn").end(), Json(10.0)), 20);
  const auto has = [](const Json& values, int value) {
    return std::find(values.begin(), values.end(), Json(value)) != values.end();
  };
  EXPECT_TRUE(has(profile.at("ground"), 30)) << "where it is lowest above ground";
  EXPECT_TRUE(has(profile.at("to").at("zones"), 1)) << "where it is nearest";
  EXPECT_EQ(profile.at("to").at("zones").size(), profile.at("s").size());
}

TEST(ReportScenes, SmallOnesStay) {
  Json scene = scene_of(100, 2, 240);
  const Json before = scene;
  thin_scene(scene);
  EXPECT_EQ(scene, before);
}

TEST(ReportScenes, AreOfTheWorldOfTheRun) {
  const altiplan::testing::TempFolder temp;
  const auto scenario =
      temp.write("s.yaml",
                 "altiplan: 1\nenvironment:\n  - hills: {count: 3, extent_m: 5000, cap_m: 2000}\n"
                 "volume: {min_m: [0, 0, 0], max_m: [5000, 5000, 2600]}\n"
                 "start: {at_m: [0, 0, 2300]}\ngoal: {at_m: [4500, 0, 2300], tolerance_m: 50}\n");
  const auto pipeline = temp.write("p.yaml",
                                   "altiplan: 1\nscenario: s.yaml\nsteps:\n  - plan: astar\n"
                                   "    with: {cell_m: [500, 500, 100]}\n");
  const Json json = altiplan::testing::run_file(pipeline).json;
  const auto changes = [](const Json& of) { return what_changed(stored_result("run", of, {})); };
  using Changes = std::vector<std::string>;
  EXPECT_EQ(changes(json), Changes{});
  Json other = json;
  for (Json& plugin : other.at("plugins")) {
    plugin.at("build") = "another";  // also of the planner, with which the world has nothing to do
  }
  EXPECT_EQ(changes(other), Changes{"environment 'hills' has been rebuilt since"});
  temp.write("s.yaml", altiplan::testing::text_of(scenario) + "# changed\n");
  EXPECT_EQ(changes(json), Changes{scenario.string() + " has changed since"});
  std::filesystem::remove(scenario);
  EXPECT_EQ(changes(json), Changes{scenario.string() + " no longer exists"});
}

TEST(ReportNames, OfVariantsAreTheirValues) {
  StudyData data;
  const auto named = [&](const std::vector<std::pair<std::string, std::string>>& names) {
    data.pipelines.clear();
    for (const auto& [name, of] : names) {
      data.pipelines.push_back({name, of, "", {}});
    }
    return short_names(data);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(named({{"w[g=0.3,h=1]", "w"}, {"w[g=0.5,h=1]", "w"}, {"a", "a"}}),
            (Names{"w[0.3,1]", "w[0.5,1]", "a"}));
  EXPECT_EQ(short_name_keys(data), (Names{"w[g,h]"}));
  EXPECT_EQ(named({{"w[g=0.3]", "w"}, {"w[h=0.3]", "w"}}), (Names{"w[g=0.3]", "w[h=0.3]"}));
  EXPECT_EQ(named({{"w[c=[1, 2]]", "w"}, {"w[c=[1, 3]]", "w"}}),
            (Names{"w[c=[1, 2]]", "w[c=[1, 3]]"}));
  EXPECT_EQ(named({{"w[g=1]", "w"}, {"w[1]", "x"}}), (Names{"w[g=1]", "w[1]"}));  // else both one
}

TEST(ReportScenes, TimesAreDroppedAtAnyDepth) {
  Json json = Json::parse(
      R"({"time_s": 1, "a": [{"plan_time_s": 2, "duration_s": 3}, 4], "b": {"setup_time_s": 5}})");
  drop_times(json);
  EXPECT_EQ(json, Json::parse(R"({"a": [{"duration_s": 3}, 4], "b": {}})"));
}
}  // namespace
}  // namespace altiplan::study::report::report_scenes_test
