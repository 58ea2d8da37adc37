// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "altiplan/height_field.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "host/flight/events.hpp"
#include "scene_files.hpp"
#include "support/support.hpp"

namespace altiplan::host::scene_world_test {
namespace {

using testing::numbers;
constexpr const char* kTold = "steps: [{plan: told}]\n";

class SceneWorld : public testing::SceneFiles {
 protected:
  /// An elevation model of that many posts, 10 m apart.
  void elevation_model(int columns, int rows) const {
    std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                       "\nxllcenter 500000\nyllcenter 4000000\ncellsize 10\n";
    for (int j = rows - 1; j >= 0; --j) {  // from the north
      for (int i = 0; i < columns; ++i) {
        text += std::to_string(100 + (i * 7 + j * 13) % 50) + " ";
      }
      text += '\n';
    }
    write("ground.asc", text);
  }
  /// Every height of the scene is that of the world's ground there, or both have none.
  void expect_heights(const Json& ground, const World& world, double tolerance) const {
    const auto heights = numbers<float>(ground.at("heights"));
    const int nx = ground.at("nx");
    const int ny = ground.at("ny");
    ASSERT_EQ(heights.size(), std::size_t(nx * ny));
    std::size_t compared = 0;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto there =
            world.ground(ground.at("x0").get<double>() + i * ground.at("dx").get<double>(),
                         ground.at("y0").get<double>() + j * ground.at("dy").get<double>());
        const float shown = heights[std::size_t(j * nx + i)];
        if (there) {
          ASSERT_NEAR(shown, *there, tolerance) << i << ", " << j;
          ++compared;
        }
      }
    }
    EXPECT_GT(compared, heights.size() / 2);
  }
};

constexpr const char* kTerrain =
    "environment: [{terrain: {file: ground.asc, crs: \"EPSG:32616\"}}]\n";
constexpr const char* kHigh = "start: {at_m: [100, 500, 500]}\ngoal: {at_m: [900, 500, 500]}\n";

TEST_F(SceneWorld, AnElevationModelIsShownByItsPosts) {
  elevation_model(103, 102);
  scenario(kTerrain, kHigh, "volume: {min_m: [0, 0, 0], max_m: [1000, 995, 1000]}\n");
  const Json shown = scene(kTold);
  const Json& ground = shown.at("ground");
  EXPECT_EQ(ground.at("nx"), 101) << "as far as the volume";
  EXPECT_EQ(ground.at("ny"), 101) << "and one post beyond its edge";
  EXPECT_EQ(ground.at("dx"), 10);
  EXPECT_TRUE(ground.at("of").is_null());
  EXPECT_EQ(shown.at("notes"), Json::array());
  expect_heights(ground, mission().truth, 0);
}

TEST_F(SceneWorld, TooManyPostsAreThinned) {
  elevation_model(1101, 1001);
  scenario(kTerrain, kHigh, "volume: {min_m: [0, 0, 0], max_m: [11000, 10000, 1000]}\n");
  const Json shown = scene(kTold);
  const Json& ground = shown.at("ground");
  EXPECT_EQ(ground.at("nx"), 551);
  EXPECT_EQ(ground.at("ny"), 501);
  EXPECT_EQ(ground.at("dx"), 20);
  EXPECT_EQ(ground.at("of"), (Json{1101, 1001}));
  EXPECT_EQ(shown.at("notes"), Json{"terrain: the ground is shown at every 2nd post"});
  expect_heights(ground, mission().truth, 0);
}

TEST_F(SceneWorld, LoiterCirclesAreShown) {
  scenario("",
           "start: {at_m: [100, 500, 500], loiter: {radius_m: 80, sense: left}}\n"
           "goal: {at_m: [900, 500, 500]}\n",
           "volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}\n");
  const Json circle = {{"at", {100, 500, 500}}, {"radius", 80}};
  EXPECT_EQ(scene(kTold).at("loiters"), Json::array({circle}));
}

/// Four by three posts, one of them without a height.
class Holed final : public Environment, public Ground {
  Box do_bounds() const override { return {{0, 0, 0}, {30, 20, 9}}; }
  double do_clearance(const Vec3&) const override { return kInfinity; }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override { return field_.at(x, y); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override { return field_.gap(a, b); }
  const HeightField* do_height_field() const override { return &field_; }
  static constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
  HeightField field_{{0, 0}, {10, 10}, 4, 3, {1, 2, 3, 4, 5, kVoid, 6, 7, 8, 9, 1, 2}};
};

TEST(SceneGround, AVoidHasNoHeight) {
  SceneNotes notes;
  const World world = altiplan::testing::world_of(std::make_shared<Holed>());
  const auto heights = [&](const Box& box) {
    return numbers<float>(ground_json(world, box, notes).at("heights"));
  };
  const auto all = heights({{-5, -5, 0}, {100, 100, 9}});
  ASSERT_EQ(all.size(), 12U);
  EXPECT_EQ(all[4], 5) << "a post beside a void keeps its height";
  EXPECT_TRUE(std::isnan(all[5]));
  EXPECT_EQ(heights({{21, 1, 0}, {29, 9, 9}}), (std::vector<float>{3, 4, 6, 7}));
  EXPECT_TRUE(ground_json(world, {{31, 0, 0}, {40, 20, 9}}, notes).is_null()) << "beside it";
}

TEST_F(SceneWorld, GroundWithoutPostsIsSampled) {
  scenario("environment: [{hills: {}}]\n",
           "start: {at_m: [100, 500], above_ground_m: 500}\n"
           "goal: {at_m: [900, 500], above_ground_m: 500}\n",
           "volume: {min_m: [0, 0, -3000], max_m: [1000, 800, 9000]}\n");
  const Json shown = scene(kTold);
  EXPECT_EQ(shown.at("ground").at("nx"), 401);
  EXPECT_EQ(shown.at("ground").at("ny"), 321);
  EXPECT_EQ(shown.at("notes"), Json{"the ground is sampled every 2.5 m"});
  expect_heights(shown.at("ground"), mission().truth, 1e-3);
}

TEST_F(SceneWorld, UnknownSpaceIsARoleOfItsOwn) {
  const auto map = altiplan::testing::configs() / "../plugins/environment/octomap/conformance.bt";
  const auto roles = [&](const std::string& more) {
    scenario("environment: [{octomap: {file: " + map.string() + more + "}}]\n");
    std::set<std::string> found;
    const Json shown = scene(kTold);
    for (const char* list : {"solids", "boxes"}) {
      for (const Json& thing : shown.at(list)) {
        found.insert(thing.at("role").get<std::string>());
      }
    }
    return found;
  };
  EXPECT_EQ(roles(""), (std::set<std::string>{"obstacle", "unknown"}));
  EXPECT_EQ(roles(", unknown: free"), std::set<std::string>{"obstacle"});
}

TEST_F(SceneWorld, ShapesAreThoseOfTheLayers) {
  scenario(R"(environment:
  - sphere: {at_m: [500, 900, 100], radius_m: 20}
  - cylinder: {at_m: [300.1234, 900], radius_m: 30}
    id: post
    known: false
  - box: {min_m: [1, 2, 3], max_m: [4, 5, 6]}
  - zones:
      list:
        - polygon: {outline_m: [[0, 800], [50, 800], [50, 900], [0, 900]],
                    holes_m: [[[10, 810], [20, 810], [20, 820]]]}
          kind: keep_out
          id: park
          ceiling_m: 120
)");
  const Json solids = scene(kTold).at("solids");
  ASSERT_EQ(solids.size(), 4U);
  EXPECT_EQ(solids[0], Json::parse(R"({"layer": "sphere", "role": "obstacle", "known": true,
    "name": "", "added_by": null, "removed_by": null, "shape": "sphere", "at": [500.0, 900.0, 100.0],
    "radius": 20.0})"));
  EXPECT_EQ(solids[1].at("layer"), "post");
  EXPECT_EQ(solids[1].at("known"), false);
  EXPECT_EQ(solids[1].at("at"), (Json{300.123, 900.0})) << "to the millimetre";
  EXPECT_TRUE(solids[1].at("floor").is_null());
  EXPECT_EQ(solids[2].at("max"), (Json{4.0, 5.0, 6.0}));
  EXPECT_EQ(solids[3].at("role"), "keep_out");
  EXPECT_EQ(solids[3].at("name"), "park");
  EXPECT_EQ(solids[3].at("outline").size(), 4U);
  EXPECT_EQ(solids[3].at("holes").at(0).at(2), (Json{20.0, 820.0}));
  EXPECT_EQ(solids[3].at("ceiling"), 120);
  EXPECT_TRUE(solids[3].at("floor").is_null());
}

TEST_F(SceneWorld, TheBoxHoldsAllThatIsPlanned) {
  const Json box =
      scene("steps: [{plan: told, with: {does: past, past_m: [500, 1500, 500]}}]\n").at("box");
  EXPECT_EQ(box, (Json{{0.0, 0.0, 0.0}, {1000.0, 1000.0, 1000.0}})) << "a rejected route is none";
  scenario("level_flight_at_m: 300\n", "start: {at_m: [100, 500]}\ngoal: {at_m: [900, 500]}\n");
  const Json level = scene(kTold).at("box");
  EXPECT_EQ(level, (Json{{0.0, 0.0, 295.0}, {1000.0, 1000.0, 305.0}})) << "never flat";
}

TEST_F(SceneWorld, EventsSayWhatComesAndGoes) {
  scenario(R"(environment:
  - cells: {}
  - cylinder: {at_m: [300, 900], radius_m: 30}
    id: post
moving:
  - sphere: {at_m: [500, 100, 100], radius_m: 10, velocity_mps: [0, 1, 0]}
    id: balloon
events:
  - {at_s: 30, remove: late}
  - {at_s: 10, id: late, add: {sphere: {at_m: [500, 900, 500], radius_m: 20}}}
  - {at_s: 20, move: {layer: post, by_m: [5, 6, 0]}}
  - {at_s: 25, remove: balloon}
  - {at_s: 26, set_cells: {layer: cells, cells: [[1, 1, 1], [2, 1, 1]]}}
  - {when_near: {at_m: [500, 500, 500], within_m: 50}, move_goal: {at_m: [900, 600, 500]}}
)");
  const Json shown = scene(kTold);
  std::map<std::string, std::vector<Json>> parts;
  for (const Json& solid : shown.at("solids")) {
    parts[solid.at("layer")].push_back(solid);
  }
  ASSERT_EQ(parts["late"].size(), 1U);
  EXPECT_EQ(parts["late"][0].at("added_by"), 1);
  EXPECT_EQ(parts["late"][0].at("removed_by"), 0) << "by time, not by place in the file";
  ASSERT_EQ(parts["post"].size(), 2U);
  EXPECT_EQ(parts["post"][0].at("removed_by"), 2);
  EXPECT_EQ(parts["post"][1].at("added_by"), 2);
  EXPECT_EQ(parts["post"][1].at("at"), (Json{305.0, 906.0}));
  ASSERT_EQ(parts["cells"].size(), 1U) << "free at first";
  EXPECT_EQ(parts["cells"][0].at("added_by"), 4);
  EXPECT_EQ(parts["cells"][0].at("min"), (Json{100.0, 100.0, 100.0}));
  EXPECT_EQ(parts["cells"][0].at("max"), (Json{300.0, 200.0, 200.0})) << "two cells, one box";
  const Json& moving = shown.at("moving");
  ASSERT_EQ(moving.size(), 1U);
  EXPECT_EQ(moving[0].at("id"), "balloon");
  EXPECT_EQ(moving[0].at("removed_by"), 3);
  EXPECT_EQ(moving[0].at("velocity"), (Json{0.0, 1.0, 0.0}));
  std::vector<std::string> texts;
  for (const Json& event : shown.at("events")) {
    texts.push_back(event.at("text"));
  }
  EXPECT_EQ(texts,
            (std::vector<std::string>{"late is gone", "late appears", "post moves by (5, 6, 0) m",
                                      "balloon is gone", "cells of cells change",
                                      "the goal moves to (900, 600, 500)"}));
}

/// Solid below a slope; it does not say what it looks like.
class Slope final : public Environment, public Ground {
 public:
  explicit Slope(bool with_ground) : with_ground_(with_ground) {}

 private:
  static double height_at(double x) { return 100 + 0.5 * x; }
  Box do_bounds() const override { return {{0, 0, 0}, {100, 100, 1000}}; }
  // A ball around the place (50, 50, 400), and the slope.
  double do_clearance(const Vec3& p) const override {
    return std::min((p - Vec3(50, 50, 400)).norm() - 30,
                    (p.z() - height_at(p.x())) / std::sqrt(1.25));
  }
  const Ground* do_ground() const override { return with_ground_ ? this : nullptr; }
  std::optional<double> do_height(double x, double) const override { return height_at(x); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z() - height_at(a.x()), b.z() - height_at(b.x()));
  }
  bool with_ground_;
};

struct Cells {
  std::vector<Box> boxes;
  std::vector<std::string> notes;
  bool covers(const Vec3& p) const {
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Box& box) { return box.contains(p, 1e-3); });
  }
};

Cells cells_of(bool with_ground) {
  Mission made;
  made.truth = altiplan::testing::world_of(std::make_shared<Slope>(with_ground), "slope");
  Json shown;
  shown["solids"] = shown["boxes"] = shown["meshes"] = shown["moving"] = Json::array();
  SceneNotes notes;
  add_solids(shown, made, {}, {{0, 0, 0}, {100, 200, 500}}, notes);
  EXPECT_EQ(shown.at("boxes").size(), 1U);
  const auto corners = numbers<float>(shown.at("boxes").at(0).at("data"));
  EXPECT_EQ(corners.size(), 6 * shown.at("boxes").at(0).at("count").get<std::size_t>());
  Cells cells{{}, notes.lines()};
  for (std::size_t i = 0; i < corners.size(); i += 6) {
    cells.boxes.push_back({{corners[i], corners[i + 1], corners[i + 2]},
                           {corners[i + 3], corners[i + 4], corners[i + 5]}});
  }
  return cells;
}

TEST(SceneCells, ALayerThatDoesNotSayWhatItLooksLikeIsDrawnByItsCells) {
  const Cells cells = cells_of(false);
  EXPECT_EQ(cells.notes, std::vector<std::string>{"slope: drawn as cells of 1.72 x 1.72 x 1.71 m"});
  EXPECT_GT(cells.boxes.size(), 200U);
  for (const Vec3& p : {Vec3(50, 50, 400), Vec3(50, 50, 371), Vec3(21, 50, 400), Vec3(99, 3, 149),
                        Vec3(50, 99, 1)}) {
    EXPECT_TRUE(cells.covers(p)) << p.transpose();
  }
  EXPECT_FALSE(cells.covers({50, 50, 365}));
  EXPECT_FALSE(cells.covers({50, 50, 440}));
  EXPECT_FALSE(cells.covers({10, 10, 115}));
}

TEST(SceneCells, ItsGroundIsNotDrawnTwice) {
  const Cells cells = cells_of(true);
  EXPECT_TRUE(cells.covers({50, 50, 400}));
  for (const Vec3& p : {Vec3(50, 50, 110), Vec3(99, 3, 140), Vec3(2, 99, 1)}) {
    EXPECT_FALSE(cells.covers(p)) << p.transpose();
  }
}
}  // namespace
}  // namespace altiplan::host::scene_world_test
