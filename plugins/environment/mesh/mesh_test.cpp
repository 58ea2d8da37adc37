// SPDX-License-Identifier: Apache-2.0
// Meshes of prisms compared with the closed forms of those prisms.
#include <gtest/gtest.h>

#include <assimp/postprocess.h>
#include <Eigen/Geometry>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include "altiplan/drawing.hpp"
#include "models_test.hpp"

namespace altiplan::testing::mesh_test {
namespace {

using Ring = std::vector<std::array<double, 2>>;
const Ring kL{{0, 0}, {6, 0}, {6, 2}, {2.5, 2}, {2.5, 5}, {0, 5}};

class Mesh : public ::testing::Test {
 protected:
  std::unique_ptr<Environment> layer_of(const Faces& model, const std::string& more = "") const {
    return mesh_of(folder_.write("model.obj", obj_of(model)), more);
  }
  std::string refusal_of(const Faces& model) const {
    return mesh_refusal(folder_.write("model.obj", obj_of(model)));
  }
  TempFolder folder_;
};

TEST_F(Mesh, IsThePrismThatItIsMadeOf) {
  const auto layer = layer_of(prism(kL, -1, 3));
  const Shape exact = Prism{kL, {}, -1, 3};
  EXPECT_EQ(layer->bounds().min, Vec3(0, 0, -1));
  EXPECT_EQ(layer->bounds().max, Vec3(6, 5, 3));
  RandomStream random(1);
  const Box around{{-3, -3, -4}, {9, 8, 6}};
  int inside = 0;
  int blocked = 0;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 a = random.in(around);
    const Vec3 b = random.in(around);
    const double clearance = layer->clearance(a);
    EXPECT_NEAR(clearance, signed_distance(exact, a), 1e-9);
    inside += clearance < 0 ? 1 : 0;
    const double distance = leg_distance(exact, a, b);
    blocked += layer->blocked(a, b, 0.5) ? 1 : 0;
    for (const double r : {0.0, distance - 1e-5, distance + 1e-5, 0.5, 2.0}) {
      if (r >= 0 && std::abs(r - distance) > 5e-6) {
        EXPECT_EQ(layer->blocked(a, b, r), distance < r || distance == 0) << r << " " << distance;
      }
    }
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(blocked, 1000);
  EXPECT_LT(blocked, 4900);
}

TEST_F(Mesh, TouchingIsFree) {
  const auto layer = layer_of(prism(kL, 0, 3));
  // Along a face, an edge, across a corner, and in the plane of a wall beside it.
  for (const auto& [a, b] : std::vector<std::pair<Vec3, Vec3>>{{{-1, 0, 1}, {9, 0, 1}},
                                                               {{-1, 0, 3}, {9, 0, 3}},
                                                               {{-1, 1, 3}, {9, 4, 3}},
                                                               {{-1, 1, 0}, {1, -1, 0}},
                                                               {{2.5, 2, 1}, {2.5, 9, 1}},
                                                               {{2.5, 2, 1}, {6, 5, 1}}}) {
    EXPECT_FALSE(layer->blocked(a, b, 0)) << a.transpose() << " to " << b.transpose();
    EXPECT_FALSE(layer->blocked(a, a, 0));
    EXPECT_TRUE(layer->blocked(a, b, 1e-3));
    const Vec3 in = 1e-5 * (Vec3(2, 1, 1.5) - (a + b) / 2).normalized();
    EXPECT_TRUE(layer->blocked(a + in, b + in, 0)) << a.transpose() << " to " << b.transpose();
  }
  EXPECT_TRUE(layer->blocked({1, 1, 1}, {1, 1, 1}, 0));
  EXPECT_TRUE(layer->blocked({1, 1, 1}, {2, 1, 1}, 0));
  EXPECT_TRUE(layer->blocked({2.5, 1, 1}, {2.5, 9, 1}, 0));
}

TEST_F(Mesh, SaysWhereItIsNear) {
  const auto layer = layer_of(cuboid({0, 0, 0}, {2, 2, 2}));
  std::vector<Nearby> told;
  const auto sink = [&](const Nearby& nearby) { told.push_back(nearby); };
  layer->near({5, 1, 1}, 2.9, sink);
  EXPECT_TRUE(told.empty());
  layer->near({5, 1, 1}, 3, sink);
  layer->near({1.5, 1, 1}, 0, sink);
  layer->near({2, 1, 1}, 0, sink);
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0].distance, 3);
  EXPECT_EQ(told[1].distance, -0.5);
  EXPECT_EQ(told[2].distance, 0);
  for (const Nearby& nearby : told) {
    EXPECT_EQ(nearby.point, Vec3(2, 1, 1));
    EXPECT_EQ(nearby.normal, Vec3(1, 0, 0));
  }
}

TEST_F(Mesh, CellsAreThoseOfThePrism) {
  const auto layer = layer_of(prism(kL, 0, 3));
  const World exact = world_of({Shape{Prism{kL, {}, 0, 3}}});
  for (const double inflation : {0.0, 0.3, 1.0}) {
    for (const auto rule : {GridSpec::Rule::touched, GridSpec::Rule::centre}) {
      GridSpec spec;
      spec.origin = {-2, -2, -2};
      spec.cell = {0.5, 0.5, 0.5};
      spec.counts = {20, 18, 14};
      spec.inflation = inflation;
      spec.rule = rule;
      VoxelGrid grid(spec);
      VoxelGrid expected(spec);
      layer->rasterize(grid);
      exact.layers()[0].environment->rasterize(expected);
      EXPECT_TRUE(VoxelGrid::diff(grid, expected).empty()) << inflation;
      if (inflation == 0) {  // the faces coincide with those of cells: neither rule takes more
        EXPECT_EQ(grid.blocked_count(), 468U);
      }
    }
  }
}

TEST_F(Mesh, PartsAreOneSolidAndAnInnerOneInsideOutIsACavity) {
  Faces model = cuboid({0, 0, 0}, {4, 4, 4});
  model.add(cuboid({3, 1, 1}, {6, 3, 3}));                 // overlaps
  model.add(cuboid({4, 3, 0}, {6, 5, 2}));                 // shares part of a face
  model.add(cuboid({1, 1, 1}, {2, 3, 3}).inside_out());    // a cavity
  model.add(cuboid({1.5, 1.5, 1.5}, {1.8, 2, 2}));         // in the cavity
  model.add(cuboid({2.2, 2.2, 2.2}, {2.5, 2.5, 2.5}));     // within the solid
  model.add(cuboid({10, 0, 0}, {12, 2, 2}).inside_out());  // by itself
  const auto layer = layer_of(model);
  for (const Vec3& p : {Vec3(0.5, 2, 2), Vec3(3.5, 2, 2), Vec3(5, 2, 2), Vec3(5, 4, 1),
                        Vec3(1.6, 1.7, 1.7), Vec3(2.4, 2.4, 2.4), Vec3(11, 1, 1)}) {
    EXPECT_LT(layer->clearance(p), 0) << p.transpose();
    EXPECT_TRUE(layer->blocked(p, p, 0)) << p.transpose();
  }
  EXPECT_NEAR(layer->clearance({1.25, 2, 2}), 0.25, 1e-6);
  EXPECT_FALSE(layer->blocked({1.25, 1.2, 2}, {1.25, 2.8, 2}, 0.2));
  EXPECT_EQ(layer->clearance({-1, 2, 2}), 1);
  EXPECT_EQ(layer->clearance({9, 1, 1}), 1);
  EXPECT_NE(layer->info().notes[0].find("84 triangles in 7 closed parts"), std::string::npos)
      << layer->info().notes[0];
  EXPECT_EQ(layer->drawing()->triangles.size(), 84U);
}

TEST_F(Mesh, IsPlacedAsAsked) {
  const Faces model = cuboid({0, 0, 0}, {1, 2, 3});
  const auto box = [&](const std::string& more) {
    const Box bounds = layer_of(model, more)->bounds();
    return std::pair(bounds.min, bounds.max);
  };
  EXPECT_EQ(box(", scale: 2"), std::pair(Vec3(0, 0, 0), Vec3(2, 4, 6)));
  EXPECT_EQ(box(", at_m: [10, 20, 30]"), std::pair(Vec3(10, 20, 30), Vec3(11, 22, 33)));
  EXPECT_EQ(box(", up: y"), std::pair(Vec3(0, -3, 0), Vec3(1, 0, 2)));
  EXPECT_EQ(box(", heading_deg: 90"), std::pair(Vec3(0, -1, 0), Vec3(2, 0, 3)));
  EXPECT_EQ(box(", up: y, heading_deg: 180, scale: 0.5, at_m: [1, 1, 1]"),
            std::pair(Vec3(0.5, 1, 1), Vec3(1, 2.5, 2)));
  const Box turned = layer_of(model, ", heading_deg: 30")->bounds();
  EXPECT_NEAR(turned.max.x(), std::cos(kPi / 6) + 2 * std::sin(kPi / 6), 1e-12);
  EXPECT_NEAR(turned.min.y(), -std::sin(kPi / 6), 1e-12);
}

TEST_F(Mesh, TheFormatsOfAssimpHoldTheSame) {
  Faces model = prism(kL, 0, 3);
  model.add(cuboid({8, 0, 0}, {9, 1, 1}));
  const auto obj = folder_.write("model.obj", obj_of(model));
  const auto layer = mesh_of(obj);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(obj.string(), aiProcess_Triangulate);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  for (const auto& [format, file] :
       {std::pair("stl", "text.stl"), {"stlb", "binary.STL"}, {"obj", "again.obj"}}) {
    Assimp::Exporter exporter;
    ASSERT_EQ(exporter.Export(scene, format, (folder_ / file).string()), AI_SUCCESS) << format;
    const auto same = mesh_of(folder_ / file);
    EXPECT_NE(same->info().notes[0].find("32 triangles in 2 closed parts, 0"), std::string::npos)
        << format << ": " << same->info().notes[0];
    RandomStream random(2);
    for (int n = 0; n < 300; ++n) {
      const Vec3 p = random.in({{-2, -2, -2}, {11, 7, 5}});
      EXPECT_EQ(same->clearance(p), layer->clearance(p)) << format;
    }
  }
}

TEST_F(Mesh, MaterialsAreNotOpened) {
  // A material file that cannot be opened, and a directory in its place: no difference.
  const std::string text = obj_of(cuboid({0, 0, 0}, {1, 1, 1}));
  for (const char* library : {"/nowhere/looks.mtl", "/", "../../../etc/passwd"}) {
    const auto file =
        folder_.write("model.obj", "mtllib " + std::string(library) + "\nusemtl red\n" + text);
    EXPECT_EQ(mesh_of(file)->clearance({2, 0.5, 0.5}), 1);
  }
}

TEST_F(Mesh, CornersAreWeldedAndSliversLeftOut) {
  Faces model = cuboid({0, 0, 0}, {1, 1, 1});
  // Each face with separate corners, off by less than weld_m, and a triangle of zero area.
  Faces apart;
  RandomStream random(3);
  for (const std::vector<int>& face : model.faces) {
    Faces one;
    one.faces.emplace_back();
    for (const int corner : face) {
      one.faces[0].push_back(int(one.corners.size()));
      one.corners.push_back(model.corners[std::size_t(corner)] +
                            2e-5 * random.in({{-1, -1, -1}, {1, 1, 1}}));
    }
    apart.add(one);
  }
  apart.faces.push_back({0, 1, 0});
  const auto layer = layer_of(apart);
  EXPECT_EQ(layer->info().notes[0], "12 triangles in 1 closed part, 1 without area omitted");
  EXPECT_NEAR(layer->clearance({2, 0.5, 0.5}), 1, 1e-4);
  EXPECT_NE(mesh_refusal(folder_ / "model.obj", ", weld_m: 0").find("is not closed"),
            std::string::npos);
  EXPECT_NE(
      mesh_refusal(folder_ / "model.obj", ", scale: 0.5, weld_m: 1").find("smaller than weld_m"),
      std::string::npos);
}

TEST_F(Mesh, OpenOnesAreRefused) {
  const Faces cube = cuboid({0, 0, 0}, {1, 1, 1});
  Faces open = cube;
  open.faces.erase(open.faces.begin() + 1);
  EXPECT_NE(
      refusal_of(open).find("is not closed: 4 edges are in one triangle only, and 0 in "
                            "triangles of inconsistent orientation; one is (1, 0, 1) to (0, 0, 1)"),
      std::string::npos)
      << refusal_of(open);
  Faces flipped = cube;
  std::reverse(flipped.faces[1].begin(), flipped.faces[1].end());
  EXPECT_NE(refusal_of(flipped).find("0 edges are in one triangle only, and 4 in triangles"),
            std::string::npos)
      << refusal_of(flipped);
  Faces finned = cube;
  finned.corners.emplace_back(2, 2, 2);
  finned.faces.push_back({0, 1, 8});
  EXPECT_NE(refusal_of(finned).find("2 edges are in one triangle only, and 1 in triangles"),
            std::string::npos)
      << refusal_of(finned);
  Faces sheet = cube;
  sheet.add({{{3, 0, 0}, {4, 0, 0}, {3, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}});
  EXPECT_NE(refusal_of(sheet).find("has a part that encloses nothing, at (3, 0, 0)"),
            std::string::npos)
      << refusal_of(sheet);
}

TEST_F(Mesh, ARouteIsPlannedAroundItAndJudged) {
  // A gate: two posts and a beam, closed below by a wall; the path is above the wall.
  Faces gate = cuboid({48, 0, 0}, {52, 40, 60});
  gate.add(cuboid({48, 60, 0}, {52, 100, 60}));
  gate.add(cuboid({48, 40, 40}, {52, 60, 60}));
  gate.add(cuboid({48, 40, 0}, {52, 60, 20}));
  folder_.write("gate.obj", obj_of(gate));
  folder_.write("scenario.yaml",
                "altiplan: 1\nenvironment:\n  - mesh: {file: gate.obj}\n"
                "volume: {min_m: [0, 0, 0], max_m: [100, 100, 60]}\nvehicle: {radius_m: 3}\n"
                "start: {at_m: [10, 50, 10]}\ngoal: {at_m: [90, 50, 10]}\n");
  const Ran ran = run_file(folder_.write("pipeline.yaml",
                                         "altiplan: 1\nscenario: scenario.yaml\nsteps:\n  - plan: "
                                         "astar\n    with: {cell_m: [2, 2, 2]}\n"
                                         "  - smooth: prune\n"));
  ASSERT_EQ(ran.json["status"], "solved") << ran.json["message"];
  EXPECT_TRUE(ran.json["check"]["ok"]);
  bool through = false;
  Vec3 before(10, 50, 10);
  for (const host::Json& p : ran.json["route"]) {
    const Vec3 at(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
    if (before.x() < 50 && at.x() >= 50) {
      const Vec3 in_gate = before + (at - before) * ((50 - before.x()) / (at.x() - before.x()));
      through = Box{{50, 43, 23}, {50, 57, 37}}.contains(in_gate, 1e-6);
    }
    before = at;
  }
  EXPECT_TRUE(through);
}
}  // namespace
}  // namespace altiplan::testing::mesh_test
