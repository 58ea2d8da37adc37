// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <set>

#include "host/view/hull.hpp"
#include "host/view/picture_svg.hpp"
#include "scene_stored.hpp"

namespace altiplan::host::scene_body_test {
namespace {

using testing::kTold;

/// Six times the volume within the triangles, if all of them face out.
double volume_of(const std::vector<Vec3>& points) {
  double volume = 0;
  for (const auto& [a, b, c] : hull_triangles(points)) {
    volume += points[a].dot(points[b].cross(points[c])) / 6;
  }
  return volume;
}

TEST(Hull, OfABoxAndOfPointsInItIsTheBox) {
  std::vector<Vec3> points = box_part({2, 3, 4}, {1, 1, 1}).corners;
  EXPECT_EQ(hull_triangles(points).size(), 12U);
  EXPECT_NEAR(volume_of(points), 24, 1e-9);
  RandomStream random(1);
  for (int n = 0; n < 300; ++n) {
    points.push_back(random.in({{0.01, -0.49, -0.99}, {1.99, 2.49, 2.99}}));
  }
  EXPECT_EQ(hull_triangles(points).size(), 12U);
}

TEST(Hull, OfRoundShapesIsClosedAndConvex) {
  std::vector<Vec3> points = cylinder_part(1, 2, {0, 0, 0}).corners;
  EXPECT_NEAR(volume_of(points), 2 * kPi, 0.03 * kPi);
  RandomStream random(2);
  for (int n = 0; n < 500; ++n) {
    points.push_back(2 * Vec3(random.normal(), random.normal(), random.normal()).normalized());
  }
  std::multiset<std::pair<std::size_t, std::size_t>> edges;
  for (const auto& [a, b, c] : hull_triangles(points)) {
    const Vec3 normal = (points[b] - points[a]).cross(points[c] - points[a]).normalized();
    for (const Vec3& p : points) {
      ASSERT_LT((p - points[a]).dot(normal), 1e-4);
    }
    edges.insert({{a, b}, {b, c}, {c, a}});
  }
  for (const auto& [from, to] : edges) {
    ASSERT_EQ(edges.count({to, from}), 1U) << "each edge has a face on both sides";
  }
}

TEST(Hull, WithoutVolumeThereIsNone) {
  EXPECT_TRUE(hull_triangles({}).empty());
  EXPECT_TRUE(hull_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).empty());
  EXPECT_TRUE(hull_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}).empty());
  EXPECT_TRUE(hull_triangles(std::vector<Vec3>(5, Vec3(1, 2, 3))).empty());
}

class SceneBody : public testing::SceneResult {
 protected:
  /// The run's result as shown, with a body.
  Json shown_with(const Body& body) const {
    Mission made = mission();
    made.request.vehicle.body = std::make_shared<Body>(body);
    Overrides only_plugins;
    only_plugins.plugin_path = overrides_.plugin_path;
    SceneNotes notes;
    return result_scene(read_result((folder_ / "result.json").string(), only_plugins), made, {},
                        {60}, notes);
  }
};

TEST_F(SceneBody, PartsAreTrianglesOfTheirSize) {
  const Json json =
      body_json({{box_part({2, 1, 0.5}, {0.5, 0, 0}), capsule_part(0.25, 3, {0, 0, 1})}, {}, true});
  ASSERT_EQ(json.size(), 2U);
  const std::array boxes{Box{{-0.5, -0.5, -0.25}, {1.5, 0.5, 0.25}},
                         Box{{-1.5, -0.25, 0.75}, {1.5, 0.25, 1.25}}};
  for (std::size_t part = 0; part < 2; ++part) {
    const auto values = testing::numbers<float>(json[part].at("triangles"));
    ASSERT_EQ(values.size() % 9, 0U);
    Box box = Box::empty();
    for (std::size_t i = 0; i < values.size(); i += 3) {
      box = box.with({values[i], values[i + 1], values[i + 2]});
    }
    EXPECT_LT((box.min - boxes[part].min).norm(), 1e-6);
    EXPECT_LT((box.max - boxes[part].max).norm(), 1e-6);
  }
}

TEST_F(SceneBody, StandsAlongTheRouteAndAtTheClosestPlace) {
  scenario("environment: [{box: {min_m: [400, 501.92, 0], max_m: [500, 600, 1000]}}]\n");
  result("steps: [{plan: told, with: {does: past, past_m: [500, 500, 500]}}]\n");
  const Json body = shown_with({{box_part({2, 3, 0.5}, {0, 0, 0})}}).at("body");
  EXPECT_GE(body.at("at").size(), 41U);
  EXPECT_LE(body.at("at").size(), 44U);
  EXPECT_EQ(body.at("at").size(), body.at("turned").size());
  EXPECT_EQ(body.at("at").front(), Json({100, 500, 500}));
  EXPECT_EQ(body.at("at").back(), Json({900, 500, 500}));
  EXPECT_EQ(body.at("turned").front(), Json({0, 0, 0, 1}));
  const Json& nearest = body.at("nearest");
  EXPECT_NEAR(nearest.at("body_clearance_m").get<double>(), 0.42, 0.01);
  EXPECT_NEAR(nearest.at("at")[0].get<double>(), 450, 51.2);
  EXPECT_EQ(nearest.at("layer"), "box");
  EXPECT_EQ(nearest.at("proven"), true);
}

TEST_F(SceneBody, AWaypointShowsBothAttitudes) {
  result("steps: [{plan: told, with: {does: past, past_m: [500, 900, 500]}}]\n");
  const Json body = shown_with({{box_part({2, 3, 0.5}, {0, 0, 0})}}).at("body");
  std::vector<Json> turned;
  for (std::size_t n = 0; n < body.at("at").size(); ++n) {
    if (body.at("at")[n] == Json({500, 900, 500})) {
      turned.push_back(body.at("turned")[n]);
    }
  }
  const double half = radians(45) / 2;
  ASSERT_EQ(turned.size(), 2U);
  EXPECT_NEAR(turned[0][2].get<double>(), std::sin(half), 1e-6);
  EXPECT_NEAR(turned[1][2].get<double>(), -std::sin(half), 1e-6);
  EXPECT_TRUE(body.at("nearest").is_null()) << "the world is empty";
}

TEST_F(SceneBody, ThePictureShowsItFromAbove) {
  scenario("environment: [{box: {min_m: [400, 560, 0], max_m: [500, 700, 1000]}}]\n");
  Json all = scene(kTold);
  const Body body{{box_part({200, 100, 2}, {0, 0, 0})}};
  all["body"] = body_json(body);
  all["results"][0] = shown_with(body);
  all["box"] = {{0, 0, 0}, {1000, 1000, 1000}};
  const std::string svg = picture_svg(all);
  EXPECT_HAS(svg, "body, 10 m from box");
  const std::size_t end = svg.find("Z\" fill=\"#0072b2\"/>");
  ASSERT_NE(end, std::string::npos);
  const std::size_t begin = svg.rfind("M", svg.rfind("<path d=", end) + 9);
  EXPECT_EQ(std::count(svg.begin() + long(begin), svg.begin() + long(end), 'L'), 4)
      << "two triangles: the upper side of the box";
}

TEST_F(SceneBody, WithoutABodyASceneSaysNothingOfIt) {
  const Json all = scene(kTold);
  EXPECT_FALSE(all.contains("body"));
  EXPECT_FALSE(all.at("results").at(0).contains("body"));
}
}  // namespace
}  // namespace altiplan::host::scene_body_test
