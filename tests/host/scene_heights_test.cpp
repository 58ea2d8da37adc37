// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/view/scene.hpp"
#include "scene_stored.hpp"

namespace altiplan::host::scene_heights_test {
namespace {

using testing::kTold;
using SceneHeights = testing::SceneResult;

/// Without ground; the route is level at 500 m, from (100, 500) east.
constexpr const char* kCity = R"(environment:
  - box: {min_m: [400, 480, 0], max_m: [450, 520, 300]}
    id: below
  - box: {min_m: [600, 512, 0], max_m: [650, 560, 900]}
    id: tower
  - box: {min_m: [200, 530, 0], max_m: [700, 560, 900]}
    id: far
)";
constexpr double kTop = 600;  ///< of the heights looked at: 100 m above the route

bool is_between(double x, double from, double to) { return from + 5 < x && x < to - 5; }
bool is_off(double x, double from, double to) { return x < from - 5 || to + 5 < x; }

TEST_F(SceneHeights, BuildingsAreBelowTheRouteAndBesideIt) {
  scenario(kCity);
  result(kTold);
  const Json profile = shown().at("profile");
  EXPECT_EQ(profile.at("beside_m"), 20);
  EXPECT_EQ(profile.at("solid").size(), 1U);
  EXPECT_EQ(profile.at("beside").size(), 2U) << "not what is 30 m away";
  const Json none = Json::array();
  int seen = 0;
  for (std::size_t i = 0; i < profile.at("s").size(); ++i) {
    const double x = 100 + profile.at("s")[i].get<double>();
    const Json& below = profile.at("solid").at("below")[i];
    const Json& tower = profile.at("beside").at("tower")[i];
    EXPECT_EQ(profile.at("beside").at("below")[i], below) << x;
    if (is_between(x, 400, 450)) {
      ASSERT_EQ(below.size(), 1U) << x;
      EXPECT_EQ(below[0][0], 0);
      EXPECT_NEAR(below[0][1].get<double>(), 300, 0.5);
      ++seen;
    } else if (is_off(x, 400, 450)) {
      EXPECT_EQ(below, none) << x;
    }
    if (is_between(x, 600, 650)) {
      EXPECT_EQ(tower, Json::parse("[[0, 600]]")) << "cut at " << kTop;
      ++seen;
    } else if (is_off(x, 600, 650)) {
      EXPECT_EQ(tower, none) << x;
    }
  }
  EXPECT_GT(seen, 20);
}

TEST_F(SceneHeights, OfAFlightAsTheyAreWhenItPasses) {
  scenario(std::string(kCity) + R"(vehicle: {speed_mps: 10}
events:
  - {at_s: 32, remove: below}
  - {at_s: 40, id: new, add: {box: {min_m: [100, 490, 0], max_m: [900, 510, 200]}}}
)");
  result("steps: [{plan: told}, {fly: route}]\n");
  const Json profile = shown().at("flight").at("profile");
  const Json none = Json::array();
  for (std::size_t i = 0; i < profile.at("t").size(); ++i) {
    const double t = profile.at("t")[i].get<double>();
    const double x = 100 + 10 * t;
    if (is_between(x, 400, 450)) {
      EXPECT_EQ(profile.at("solid").at("below")[i].empty(), t >= 32) << t;
    }
    if (x > 110 && x < 890) {
      EXPECT_EQ(profile.at("solid").at("new")[i].empty(), t < 40) << t;
    }
  }
}

TEST_F(SceneHeights, OverGroundTheyBeginAtItsLowest) {
  scenario(
      std::string(kCity) +
      "  - hills: {base_m: 100, peaks: [{at_m: [500, 500], height_m: 50, sigma_m: [99, 99]}]}\n");
  result(kTold);
  const Json profile = shown().at("profile");
  const Json& ground = profile.at("ground");
  const double lowest = *std::min_element(
      ground.begin(), ground.end(),
      [](const Json& a, const Json& b) { return a.get<double>() < b.get<double>(); });
  for (const Json& spans : profile.at("beside").at("tower")) {
    for (const Json& span : spans) {
      EXPECT_NEAR(span[0].get<double>(), lowest, 1e-6);
    }
  }
  EXPECT_FALSE(profile.at("solid").contains("hills")) << "the ground is drawn by itself";
}

TEST_F(SceneHeights, ReportsItsProgress) {
  result(kTold);
  std::vector<std::string> reported;
  Overrides only_plugins;
  only_plugins.plugin_path = overrides_.plugin_path;
  build_scene({read_result((folder_ / "result.json").string(), only_plugins)},
              [&](const std::string& what) { reported.push_back(what); });
  ASSERT_GE(reported.size(), 3U);
  EXPECT_NE(reported.front().find("building the world of "), std::string::npos);
  EXPECT_NE(reported.back().find("judging "), std::string::npos);
}
}  // namespace
}  // namespace altiplan::host::scene_heights_test
