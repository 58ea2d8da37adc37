// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::testing::voxel_map_test {
namespace {

const World kNothing;

std::unique_ptr<Environment> map_of(const std::string& text, const std::string& more = "") {
  const std::string file = ::testing::TempDir() + "voxel_map_test.3dmap";
  std::ofstream(file, std::ios::binary) << text;
  Site site;
  site.before = &kNothing;
  return make_environment("voxel_map", "{file: " + file + more + "}", site);
}

std::string refusal(const std::string& text, const std::string& more = "") {
  try {
    map_of(text, more);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(VoxelMap, CountsAsTheFileDoes) {
  const auto layer = map_of("voxel 3 4 5\r\n0 1 2\r\n2 3 4\n\n", ", cell_m: 2");
  EXPECT_EQ(layer->cell_centre({0, 1, 2}), Vec3(1, 3, 5));
  EXPECT_EQ(layer->clearance({1, 3, 5}), -1);
  EXPECT_EQ(layer->clearance({5, 7, 9}), -1);
  EXPECT_EQ(layer->clearance({3, 3, 5}), 1);
  EXPECT_EQ(layer->bounds().max, Vec3(6, 8, 10));
}

TEST(VoxelMap, WhatIsWrongIsNamedWithItsLine) {
  for (const auto& [text, why] : std::map<std::string, std::string>{
           {"", ":1: expected 'voxel' and three counts of at least 1, found ''"},
           {"type octile\n", ":1: expected 'voxel' and three counts"},
           {"voxel 3 4\n", ":1: expected 'voxel' and three counts"},
           {"voxel 3 4 0\n", ":1: expected 'voxel' and three counts"},
           {"voxel 3 4 nan\n", ":1: expected 'voxel' and three counts"},
           {"voxel 99999 99999 99999\n", "more than max_cells"},
           {"voxel 3 4 5\n0 0 0\n3 0 0\n", ":3: expected a voxel 'x y z' within the counts"},
           {"voxel 3 4 5\n0 0 -1\n", ":2: expected a voxel 'x y z' within the counts"},
           {"voxel 3 4 5\n0 0\n", ":2: expected a voxel 'x y z' within the counts"},
           {"voxel 3 4 5\n0 0 0 0\n", ":2: expected a voxel 'x y z' within the counts"},
           {"voxel 3 4 5\n0 0 1.5\n", ":2: expected a voxel 'x y z' within the counts"},
           {"voxel 3 4 5\n0 0 99999999999\n", ":2: expected a voxel 'x y z'"}}) {
    EXPECT_NE(refusal(text).find(why), std::string::npos) << text << refusal(text);
  }
}
}  // namespace
}  // namespace altiplan::testing::voxel_map_test
