// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::testing::grid_map_test {
namespace {

const World kNothing;

std::unique_ptr<Environment> map_of(const std::string& text, const std::string& more = "") {
  const std::string file = ::testing::TempDir() + "grid_map_test.map";
  std::ofstream(file, std::ios::binary) << text;
  Site site;
  site.before = &kNothing;
  return make_environment("grid_map", "{file: " + file + more + "}", site);
}

std::string refusal(const std::string& text, const std::string& more = "") {
  try {
    map_of(text, more);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(GridMap, CountsRowsFromTheTop) {
  const auto layer =
      map_of("type octile\nheight 2\nwidth 3\nmap\n@..\n.TG\n", ", cell_m: 10, height_m: 4");
  EXPECT_EQ(layer->cell_centre({0, 0, 0}), Vec3(5, 15, 2));
  EXPECT_EQ(layer->cell_centre({2, 1, 0}), Vec3(25, 5, 2));
  EXPECT_LT(layer->clearance({5, 15, 2}), 0);
  EXPECT_LT(layer->clearance({15, 5, 2}), 0);
  EXPECT_GT(layer->clearance({5, 5, 2}), -1e-9);
  EXPECT_EQ(layer->clearance({25, 15, 2}), std::hypot(5, 5));
  EXPECT_EQ(layer->bounds().max, Vec3(30, 20, 4));
}

TEST(GridMap, LineEndsMayBeOfEitherKind) {
  const auto layer = map_of("type octile\r\nwidth 2\r\nheight 1\r\nmap\r\n.@\r\n\r\n");
  EXPECT_EQ(layer->clearance({0, 0.5, 0.5}), 1);
}

TEST(GridMap, WhatIsWrongIsNamedWithItsLine) {
  const std::string head = "type octile\nheight 2\nwidth 3\nmap\n";
  for (const auto& [text, why] : std::map<std::string, std::string>{
           {"", ":1: the file ends here, expected 'type octile'"},
           {"type tile\n", ":1: expected 'type octile', found 'type tile'"},
           {"type octile\nheight 0\n", ":2: expected 'height' and a whole number"},
           {"type octile\nheight 1e9\n", ":2: expected 'height' and a whole number"},
           {"type octile\nheight 99999999999\n", ":2: expected 'height' and a whole number"},
           {"type octile\nheight 2\nheight 2\n", ":3: expected 'height', 'width', each once"},
           {"type octile\nwidth 2\nmap\n..\n", ":3: expected 'height' and 'width' before 'map'"},
           {"type octile\nheight 999999\nwidth 999999\nmap\n", "more than max_cells"},
           {head + "...\n", ":6: the file ends here, expected row 2 of the map"},
           {head + "...\n..\n", ":6: expected a row of 3 cells, found 2"},
           {head + "...\n....\n", ":6: expected a row of 3 cells, found 4"},
           {head + "...\n.S.\n", ":6: cell 2: expected '.' or 'G' (free), '@', 'O' or 'T'"},
           {head + std::string("...\n.\0.\n", 8), "found 0x00"},
           {head + "...\n...\n...\n", ":7: the file continues after the 2 rows"}}) {
    EXPECT_NE(refusal(text).find(why), std::string::npos) << text << refusal(text);
  }
  EXPECT_NE(refusal(head + "...\n...\n", ", max_cells: 5").find("more than max_cells"),
            std::string::npos);
}
}  // namespace
}  // namespace altiplan::testing::grid_map_test
