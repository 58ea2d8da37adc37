// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::testing::gazebo_test {
namespace {

const World kNothing;

std::unique_ptr<Environment> world_of(const std::string& inner) {
  const std::string file = ::testing::TempDir() + "gazebo_test.world";
  std::ofstream(file) << "<sdf version='1.6'>\n<world name='w'>\n" << inner << "</world>\n</sdf>\n";
  Site site;
  site.before = &kNothing;
  return make_environment("gazebo", "{file: " + file + "}", site);
}

std::string model(const std::string& pose, const std::string& geometry,
                  const std::string& link = "") {
  return "<model name='m'>\n<pose>" + pose + "</pose>\n<link name='l'>" + link +
         "<collision name='c'>\n<geometry>" + geometry + "</geometry></collision></link></model>\n";
}

const std::string kPole = "<cylinder><radius>0.5</radius><length>2</length></cylinder>";
const std::string kBox = "<box><size>4 2 2</size></box>";

TEST(Gazebo, ACylinderStandsAboutItsPose) {
  const auto layer = world_of(model("3 4 1 0 0 0", kPole));
  EXPECT_NEAR(layer->clearance({3, 6, 1}), 1.5, 1e-12);
  EXPECT_NEAR(layer->clearance({3, 4, 3}), 1, 1e-12);
  EXPECT_LT(layer->clearance({3, 4, 0.1}), 0);
}

TEST(Gazebo, PosesOfModelLinkAndCollisionAreChained) {
  // The model is turned to the north, so that the link lies north of it, and the box along y.
  const auto layer =
      world_of(model("10 0 1 0 0 1.5707963267948966", kBox, "<pose>5 0 0 0 0 0</pose>"));
  EXPECT_NEAR(layer->clearance({10, 8, 1}), 1, 1e-9);
  EXPECT_NEAR(layer->clearance({12, 5, 1}), 1, 1e-9);
}

TEST(Gazebo, ModelsStandWhereTheStateHasThem) {
  const auto layer = world_of(model("3 4 1 0 0 0", kPole) +
                              "<state><model name='m'><pose>30 4 1 0 0 0</pose></model></state>");
  EXPECT_NEAR(layer->clearance({30, 6, 1}), 1.5, 1e-12);
}

TEST(Gazebo, AGroundPlaneIsLeftToTheVolume) {
  const auto layer = world_of(model("0 0 0 0 0 0", "<plane><normal>0 0 1</normal></plane>"));
  EXPECT_EQ(layer->clearance({0, 0, -5}), kInfinity);
}

TEST(Gazebo, WhatItCannotReadIsNamedWithItsLine) {
  for (const auto& [inner, why] : std::map<std::string, std::string>{
           {model("0 0 0 0 0", kPole), ":4: expected 6 numbers in <pose>, found '0 0 0 0 0'"},
           {model("0 0 0 0 0 0 0", kPole), ":4: expected 6 numbers in <pose>"},
           {model("0 0 0 0 0 nan", kPole), ":4: expected 6 numbers in <pose>"},
           {model("0 0 0 1 0 0", kPole), "expected <cylinder> upright"},
           {model("0 0 0 0 0 0", "<mesh><uri>a.dae</uri></mesh>"), "found <mesh>"},
           {model("0 0 0 0 0 0", ""), "found no geometry"},
           {model("0 0 0 0 0 0", "<cylinder><radius>1</radius></cylinder>"),
            ":6: expected <length> in <cylinder>"},
           {model("0 0 0 0 0 0", "<sphere><radius>-1</radius></sphere>"), "expected a <radius>"},
           {model("0 0 0 0 0 0", "<box><size>1 0 1</size></box>"), "expected a <size> above 0"},
           {"<model name='m'><pose relative_to='x'>0 0 0 0 0 0</pose></model>", "'relative_to'"},
           {"<model name='m'><plugin name='p' filename='p.so'/></model>", "may move"},
           {"<include><uri>model://sun</uri></include>", ":3: <include> is not read"},
           {"<state><deletions><name>m</name></deletions></state>", "<deletions> is not read"},
           {"<model>", "mismatch"}}) {
    try {
      world_of(inner);
      ADD_FAILURE() << inner;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }
}
}  // namespace
}  // namespace altiplan::testing::gazebo_test
