// SPDX-License-Identifier: Apache-2.0
// The oracle is OctoMap itself: it writes the files, and provides their contents.
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cstring>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/random.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::testing::octomap_test {
namespace {

const World kNothing;

std::unique_ptr<Environment> load(const std::filesystem::path& file, const std::string& more = "") {
  Site site;
  site.before = &kNothing;
  return make_environment("octomap", "{file: " + file.string() + more + "}", site);
}

std::string refusal(const std::filesystem::path& file, const std::string& more = "") {
  try {
    load(file, more);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// A tree with leaves of many sizes: a room, its walls, and some noise.
template <class Tree>
void fill(Tree& tree, std::uint64_t seed) {
  RandomStream random(seed);
  for (int n = 0; n < 400; ++n) {
    const Vec3 p = random.in({{-3, -2, 0}, {4, 3, 2}});
    tree.updateNode(float(p.x()), float(p.y()), float(p.z()), random.uniform() < 0.4);
  }
  for (float x = -2; x < 2; x += 0.2F) {
    for (float y = -1; y < 1; y += 0.2F) {
      for (float z = 0; z < 1; z += 0.2F) {
        tree.updateNode(x + 0.1F, y + 0.1F, z + 0.1F, false);
      }
      tree.updateNode(x + 0.1F, y + 0.1F, -0.1F, true);
    }
  }
  tree.updateInnerOccupancy();
}

/// Checks every voxel of the layer's box against the tree.
template <class Tree>
void expect_equal(const Environment& layer, const Tree& tree, bool unknown_blocked) {
  VoxelGrid grid(layer.info().native_grid.value());
  layer.rasterize(grid);
  const Cell& counts = grid.spec().counts;
  std::size_t differ = 0;
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        const Vec3 p = grid.spec().centre({i, j, k});
        const auto* node = tree.search(p.x(), p.y(), p.z());
        const bool blocked = node == nullptr ? unknown_blocked : tree.isNodeOccupied(node);
        differ += grid.blocked(i, j, k) != blocked;
      }
    }
  }
  EXPECT_EQ(differ, 0U);
  double low[3];
  double high[3];
  tree.getMetricMin(low[0], low[1], low[2]);
  tree.getMetricMax(high[0], high[1], high[2]);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(layer.bounds().min[axis], low[axis], 1e-9);
    EXPECT_NEAR(layer.bounds().max[axis], high[axis], 1e-9);
  }
}

TEST(OctoMap, ReadsWhatOctoMapWrites) {
  const TempFolder folder;
  for (const std::uint64_t seed : {1, 2, 3}) {
    octomap::OcTree tree(0.2);
    fill(tree, seed);
    const std::string full = (folder / "full.ot").string();
    ASSERT_TRUE(tree.write(full));
    for (const bool blocked : {true, false}) {
      const std::string unknown = blocked ? ", unknown: blocked" : ", unknown: free";
      expect_equal(*load(full, unknown), tree, blocked);
    }
    octomap::OcTree max_likely(tree);
    const std::string binary = (folder / "binary.bt").string();
    ASSERT_TRUE(max_likely.writeBinary(binary));  // reduces the tree to free and occupied
    expect_equal(*load(binary), max_likely, true);
  }
}

TEST(OctoMap, LeavesOutColours) {
  const TempFolder folder;
  octomap::ColorOcTree tree(0.2);
  fill(tree, 4);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    leaf->setColor(10, 200, 30);
  }
  const std::string full = (folder / "colour.ot").string();
  ASSERT_TRUE(tree.write(full));
  expect_equal(*load(full), tree, true);
  const std::string binary = (folder / "colour.bt").string();
  ASSERT_TRUE(tree.writeBinary(binary));
  expect_equal(*load(binary), tree, true);
}

TEST(OctoMap, TheThresholdIsTheUsers) {
  const TempFolder folder;
  octomap::OcTree tree(1);
  tree.setNodeValue(0.5F, 0.5F, 0.5F, octomap::logodds(0.6));
  tree.setNodeValue(3.5F, 0.5F, 0.5F, octomap::logodds(0.9));
  const std::string file = (folder / "a.ot").string();
  ASSERT_TRUE(tree.write(file));
  const auto blocked = [&](const std::string& from) {
    const auto layer = load(file, ", unknown: free, occupied_from: " + from);
    return std::pair(layer->clearance({0.5, 0.5, 0.5}) < 0, layer->clearance({3.5, 0.5, 0.5}) < 0);
  };
  EXPECT_EQ(blocked("0.5"), std::pair(true, true));
  EXPECT_EQ(blocked("0.8"), std::pair(false, true));
  EXPECT_EQ(blocked("0.95"), std::pair(false, false));
}

TEST(OctoMap, RealMapsHaveTheirVoxels) {
  ALTIPLAN_DATA_OR_SKIP(folder, "voxel3d");
  EXPECT_NE(refusal(folder / "laberynth.bt").find("set unknown: free"), std::string::npos);
  const auto known = [&](const char* file) {
    const std::string note = load(folder / file, ", unknown: free")->info().notes.front();
    return note.substr(0, note.find("), ", note.find("free")) + 1);
  };
  EXPECT_EQ(known("geb079.bt"), "143729 occupied leaves (185673 voxels), 284415 free (950759)");
  EXPECT_EQ(known("mbzirc_challenge3.bt"),
            "137342 occupied leaves (148633 voxels), 224494 free (1970679)");
  EXPECT_EQ(known("laberynth.bt"), "93888 occupied leaves (469886 voxels), 0 free (0)");
}

/// A floor of 10 x 10 occupied voxels of 1 m with free ones above it, in a box whose upper half is
/// unmeasured.
std::filesystem::path half_known(const TempFolder& folder) {
  octomap::OcTree tree(1);
  for (float x = 0.5F; x < 10; ++x) {
    for (float y = 0.5F; y < 10; ++y) {
      tree.updateNode(x, y, 0.5F, true);
      for (float z = 1.5F; z < 5; ++z) {
        tree.updateNode(x, y, z, false);
      }
    }
  }
  tree.updateNode(9.5F, 9.5F, 9.5F, false);
  auto file = folder / "half.bt";
  EXPECT_TRUE(tree.writeBinary(file.string()));
  return file;
}

/// An occupied voxel of 1 m in unknown space, between two rows of free ones.
std::filesystem::path touching(const TempFolder& folder) {
  octomap::OcTree tree(1);
  for (float x = 0.5F; x < 4; ++x) {
    tree.updateNode(x, 0.5F, 0.5F, false);
    tree.updateNode(x, 3.5F, 0.5F, false);
  }
  tree.updateNode(0.5F, 2.5F, 0.5F, true);
  auto file = folder / "touching.bt";
  EXPECT_TRUE(tree.writeBinary(file.string()));
  return file;
}

TEST(OctoMap, UnknownSpaceIsDrawnApart) {
  const TempFolder folder;
  const auto volume = [](const Environment& layer, altiplan::Drawn::Role role) {
    double sum = 0;
    const std::optional<Drawing> drawing = layer.drawing();
    for (const altiplan::Drawn& drawn : drawing->shapes) {
      const Box& box = std::get<BoxShape>(drawn.shape).box;
      sum += drawn.role == role ? (box.max - box.min).prod() : 0;
    }
    return sum;
  };
  const auto blocked = load(half_known(folder));
  EXPECT_NEAR(volume(*blocked, altiplan::Drawn::Role::obstacle), 100, 1e-6);
  EXPECT_NEAR(volume(*blocked, altiplan::Drawn::Role::unknown), 499, 1e-6);
  const auto free = load(half_known(folder), ", unknown: free");
  EXPECT_NEAR(volume(*free, altiplan::Drawn::Role::obstacle), 100, 1e-6);
  EXPECT_EQ(volume(*free, altiplan::Drawn::Role::unknown), 0);
}

TEST(OctoMap, TheJudgeSaysWhereUnknownSpaceBlocks) {
  const TempFolder folder;
  World world = World().with({"map", "octomap", load(half_known(folder)), true});
  const Request request =
      request_in(std::move(world), {1, 1, 3}, {8, 8, 3}, {{0, 0, 0}, {10, 10, 10}});
  const auto said = [&](const Vec3& a, const Vec3& b, double clearance) {
    Request asked = request;
    asked.limits.min_clearance = clearance;
    const auto found = leg_violations(std::nullopt, a, b, asked, 0);
    return found.empty() ? "" : found.front().message;
  };
  const std::string why = "(unknown space, treated as blocked)";
  EXPECT_EQ(said({1, 1, 3}, {8, 8, 3}, 0.5), "");
  EXPECT_EQ(said({1, 1, 4.75}, {8, 8, 4.75}, 0.5),
            "comes to 0.25 m of 'map' " + why + ", where 0.50 m of clearance are needed");
  EXPECT_EQ(said({1, 1, 3}, {8, 8, 7}, 0.5), "lies up to 2.00 m inside what 'map' blocks " + why +
                                                 ", where 0.50 m of clearance are needed");
  EXPECT_EQ(said({1, 1, 1.25}, {8, 8, 1.25}, 0.5),
            "comes to 0.25 m of 'map', where 0.50 m of clearance are needed");
  EXPECT_NE(point_problem({5, 5, 7}, request).find(why), std::string::npos);
  // Inside unknown space, where it touches measured voxels.
  const Request beside = request_in(World().with({"map", "octomap", load(touching(folder)), true}),
                                    {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {{0, 0, 0}, {10, 10, 10}});
  EXPECT_NE(point_problem({1, 2.5, 0.5}, beside).find(why), std::string::npos);
  EXPECT_EQ(point_problem({5, 5, 0.5}, request).find(why), std::string::npos);
}

std::string header(const std::string& kind, const std::string& lines) {
  return "# Octomap OcTree " + kind + "\n" + lines + "data\n";
}

TEST(OctoMap, WhatIsWrongIsNamed) {
  const TempFolder folder;
  const std::string binary = header("binary file", "id OcTree\nsize 2\nres 0.1\n");
  const std::string full = header("file", "id OcTree\nsize 2\nres 0.1\n");
  const auto nodes = [](std::initializer_list<int> bytes) {
    std::string text;
    for (const int byte : bytes) {
      text += char(byte);
    }
    return text;
  };
  std::string nan(5, '\0');
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data(), &not_a_number, sizeof not_a_number);
  std::string deep = binary;
  for (int n = 0; n < 40; ++n) {
    deep += nodes({3, 0});
  }
  std::string deep_full = full;
  for (int n = 0; n < 40; ++n) {
    deep_full += nodes({0, 0, 0, 0, 1});
  }
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", ":1: expected a line of an OctoMap header"},
      {"type octile\n", ":1: expected '# Octomap OcTree file'"},
      {std::string(5000, 'x'), ":1: expected a line"},
      {header("binary file", "id OcTree\nsize 2\n"), "has no resolution"},
      {header("binary file", "id OcTree\nres 0\n"), ":3: expected 'res' and metres"},
      {header("binary file", "id OcTree\nres -0.1\n"), ":3: expected 'res' and metres"},
      {header("binary file", "id OcTree\nres nan\n"), ":3: expected 'res' and metres"},
      {header("binary file", "id OcTree\nres 1e99\n"), ":3: expected 'res' and metres"},
      {header("binary file", "id OcTree\nres 0,1\n"), ":3: expected 'res' and metres"},
      {header("binary file", "res 0.1\n"), "expected the id OcTree or ColorOcTree, found ''"},
      {header("file", "id CountingOcTree\nres 0.1\n"), "found 'CountingOcTree'"},
      {header("file", "id OcTreeStamped\nres 0.1\n"), "found 'OcTreeStamped'"},
      {header("file", "id OcTree\nres 0.1\nwhat 3\n"), ":4: expected id, size, res or data"},
      {"# Octomap OcTree binary file\nid OcTree\nres 0.1\n", ":4: expected a line"},
      {binary, "the nodes end early"},
      {binary + nodes({3}), "the nodes end early"},
      {binary + nodes({3, 0}), "the nodes end early"},
      {binary + nodes({0, 0}), "the map has no known voxel"},
      {binary + nodes({2, 0, 0}), "1 bytes follow the tree's nodes"},
      {deep, "children below the finest level"},
      {full, "the nodes end early"},
      {full + nodes({0, 0, 0, 0}), "the nodes end early"},
      {full + nan, "is not a number"},
      {deep_full, "children below the finest level"},
      {full + nodes({0, 0, 0, 0, 0, 9}), "1 bytes follow"},
      {full + nodes({0, 0, 0, 0, 0}), "more than max_cells"},  // the whole tree is one leaf
      {binary + nodes({2, 128}), "more than max_cells"}};
  for (const auto& [text, why] : cases) {
    const std::string said = refusal(folder.write("a.bt", text));
    EXPECT_NE(said.find(why), std::string::npos) << why << "\n" << said;
  }
  EXPECT_NE(refusal("/nowhere.bt").find("/nowhere.bt"), std::string::npos);
}

TEST(OctoMap, DamageIsAnErrorOrAMap) {
  const TempFolder folder;
  octomap::OcTree tree(0.2);
  fill(tree, 7);
  for (const bool binary : {true, false}) {
    const std::string file = (folder / "whole").string();
    ASSERT_TRUE(binary ? tree.writeBinary(file) : tree.write(file));
    const std::string whole = text_of(file);
    RandomStream random(binary ? 1 : 2);
    for (int n = 0; n < 200; ++n) {
      std::string damaged = whole;
      const auto at = std::size_t(random.integer(0, std::int64_t(whole.size()) - 1));
      if (n % 4 == 0) {
        damaged.resize(at);
      } else {
        damaged[at] = char(random.integer(0, 255));
      }
      const auto path = folder.write("damaged", damaged);
      try {
        const auto layer = load(path, ", max_cells: 1000000");
        EXPECT_LE(layer->info().native_grid->cell_count(), 1000000U);
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
      }
    }
  }
}
}  // namespace
}  // namespace altiplan::testing::octomap_test
