// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::testing::mat_terrain_test {
namespace {

const World kNothing;

// Files of level 5, written element by element.

std::string words(std::initializer_list<std::uint32_t> numbers) {
  std::string bytes;
  for (const std::uint32_t number : numbers) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}
std::string element(std::uint32_t type, std::string bytes) {
  const std::string tag = words({type, std::uint32_t(bytes.size())});
  bytes.resize((bytes.size() + 7) / 8 * 8);
  return tag + bytes;
}
std::string array(std::uint32_t kind, std::uint32_t rows, std::uint32_t columns,
                  const std::string& name, const std::string& content) {
  return element(14, element(6, words({kind, 0})) + element(5, words({rows, columns})) +
                         element(1, name) + content);
}
std::string doubles(std::uint32_t rows, std::uint32_t columns, const std::vector<double>& values) {
  const std::string bytes(reinterpret_cast<const char*>(values.data()), 8 * values.size());
  return array(6, rows, columns, "", element(9, bytes));
}
/// As small numbers are stored: within the tag.
std::string small(std::uint32_t rows, std::uint32_t columns, const std::string& bytes) {
  std::string tag = words({2U | std::uint32_t(bytes.size()) << 16}) + bytes;
  tag.resize(8);
  return array(9, rows, columns, "", tag);
}
std::string terrain(const std::string& x, const std::string& y, const std::string& heights,
                    const std::string& name = "terrainStruct") {
  std::string names("X\0\0\0Y\0\0\0H\0\0\0", 12);
  return array(2, 1, 1, name, element(5, words({4})) + element(1, names) + x + y + heights);
}
std::string written(const std::string& variables) {
  std::string header = "MATLAB 5.0 MAT-file";
  header.resize(124, ' ');
  const std::string file = ::testing::TempDir() + "mat_terrain_test.mat";
  std::ofstream(file, std::ios::binary) << header + std::string("\x00\x01IM", 4) + variables;
  return file;
}
std::unique_ptr<Environment> ground(const std::string& variables) {
  Site site;
  site.before = &kNothing;
  return make_environment("mat_terrain", "{file: " + written(variables) + "}", site);
}

const std::string kX = small(1, 3, std::string("\x01\x02\x03", 3));
const std::string kY = doubles(2, 1, {1, 2});
const std::string kHeights = doubles(2, 3, {10, 40, 20, 50, 30, 60});  // down the columns

TEST(MatTerrain, RowsAreNorthAndColumnsEast) {
  const auto layer = ground(doubles(1, 1, {7}) + terrain(kX, kY, kHeights));
  EXPECT_EQ(layer->ground()->height(1, 1), 10);
  EXPECT_EQ(layer->ground()->height(3, 1), 30);
  EXPECT_EQ(layer->ground()->height(1, 2), 40);
  EXPECT_EQ(layer->ground()->height(2.5, 2), 55);
  EXPECT_FALSE(layer->ground()->height(0.9, 1));
}

TEST(MatTerrain, WhatItCannotReadIsRefused) {
  const auto why = [](const std::string& variables) {
    try {
      ground(variables);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto expect = [&](const std::string& variables, const char* words) {
    EXPECT_NE(why(variables).find(words), std::string::npos) << why(variables);
  };
  const std::string good = terrain(kX, kY, kHeights);
  expect("", "it has no structure 'terrainStruct'");
  expect(terrain(kX, kY, kHeights, "other"), "it has no structure 'terrainStruct'");
  expect(good.substr(0, good.size() - 40), "it is damaged: an element does not end");
  expect(terrain(kX, kX, kHeights), "expected H with a row for each of Y");
  expect(terrain(doubles(1, 3, {1, 2, 4}), kY, kHeights), "X is not evenly spaced");
  expect(terrain(kX, kY, doubles(2, 3, {1, 2, 3})), "it is damaged: 'H' has 3 numbers");
  expect(element(15, "no zlib"), "it is damaged (zlib)");
}

}  // namespace
}  // namespace altiplan::testing::mat_terrain_test
