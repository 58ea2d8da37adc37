// SPDX-License-Identifier: Apache-2.0
// Damaged models: each is rejected with a message that names the file, or is another closed solid;
// none crashes the process or exceeds max_triangles.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "models_test.hpp"

namespace altiplan::testing::mesh_damage_test {
namespace {

/// A tetrahedron; its file in the three forms.
const std::array<Vec3, 4> kCorners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

std::string obj() {
  std::string text = "# four corners\no thing\n";
  for (const Vec3& c : kCorners) {
    text += "v " + std::to_string(int(c.x())) + " " + std::to_string(int(c.y())) + " " +
            std::to_string(int(c.z())) + "\n";
  }
  text += "vn 0 0 1\n";
  for (const auto& face : kFaces) {
    text += "f";
    for (const int corner : face) {
      text += " " + std::to_string(corner + 1) + "//1";
    }
    text += "\n";
  }
  return text;
}

std::string stl() {
  std::string text = "solid thing\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) {
      const Vec3& c = kCorners[std::size_t(corner)];
      text += "vertex " + std::to_string(c.x()) + " " + std::to_string(c.y()) + " " +
              std::to_string(c.z()) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid thing\n";
}

template <class Value>
void append(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_stl() {
  std::string bytes(80, ' ');
  append(bytes, std::uint32_t(std::size(kFaces)));
  for (const auto& face : kFaces) {
    bytes += std::string(12, '\0');
    for (const int corner : face) {
      for (const double number : kCorners[std::size_t(corner)]) {
        append(bytes, float(number));
      }
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

class DamagedMesh : public ::testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& bytes) const {
    return mesh_refusal(folder_.write(name, bytes), ", max_triangles: 1000");
  }
  void expect_refused(const std::string& name, const std::string& bytes,
                      const std::string& why) const {
    const std::string said = refusal(name, bytes);
    EXPECT_NE(said.find(why), std::string::npos)
        << "expected '" << why << "', found '" << said << "'\n"
        << bytes.substr(0, 300);
  }
  TempFolder folder_;
};

struct Damage {
  const char* from;
  std::string to;
  const char* why;
};

TEST_F(DamagedMesh, TextStlIsRefusedByLine) {
  ASSERT_EQ(refusal("a.stl", stl()), "");
  const Damage all[] = {
      {"solid thing\nfacet", "sold thing\nfacet", "is not an STL file"},
      {"facet normal 0 0 0\nouter loop\nvertex 0.000000 0.000000 0.000000\nvertex 0.000000 1",
       "facet normal 0 0\nouter loop\nvertex 0.000000 0.000000 0.000000\nvertex 0.000000 1",
       ".stl:2: expected 'facet normal' and three numbers, found 'facet normal 0 0'"},
      {"solid thing\nfacet normal", "solid thing\nfacit normal", ".stl:2: expected 'facet normal'"},
      {"solid thing\nfacet normal 0", "solid thing\nfacet normal a",
       ".stl:2: expected 'facet normal'"},
      {"solid thing\nfacet normal 0 0 0\nouter loop\n", "solid thing\nfacet normal 0 0 0\n",
       ".stl:3: expected 'outer loop', found 'vertex"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1.000000 0.000000\nendloop",
       ".stl:6: expected 'vertex' and three numbers"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1.000000 0.000000 0 0\nendloop",
       ".stl:6: expected 'vertex' and three numbers"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1.000000 nan 0.000000\nendloop",
       ".stl:6: expected 'vertex' and three numbers"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1.000000 inf 0.000000\nendloop",
       ".stl:6: expected 'vertex' and three numbers"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1,0 0 0\nendloop",
       ".stl:6: expected 'vertex' and three numbers"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1e20 0 0\nendloop",
       "has a coordinate that is not a number of at most 1e+09"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1e99 0 0\nendloop",
       "has a coordinate that is not a number of at most 1e+09"},
      {"vertex 1.000000 0.000000 0.000000\nendloop",
       "vertex 1.000000 0.000000 0.000000\nvertex 2 2 2\nendloop", ".stl:7: expected 'endloop'"},
      {"vertex 1.000000 0.000000 0.000000\nendloop\nendfacet\nfacet",
       "vertex 1.000000 0.000000 0.000000\nendloop\nfacet", ".stl:8: expected 'endfacet'"},
      {"endsolid thing\n", "", ".stl:29: expected 'endsolid' at the end"},
      {"endsolid thing\n", "endsolid thing\nmore\n", ".stl:31: expected 'solid', found 'more'"},
      {"endsolid thing\n", std::string("endsolid thing\n\0", 16), ".stl:31: expected 'solid'"},
      {"vertex 1.000000 0.000000 0.000000\nendloop", "vertex 1.5 0.000000 0.000000\nendloop",
       "is not closed: 4 edges are in one triangle only"}};
  for (const Damage& damage : all) {
    expect_refused("a.stl", replaced(stl(), damage.from, damage.to), damage.why);
  }
  expect_refused("a.stl", "solid nothing\nendsolid nothing\n", "");
  EXPECT_NE(refusal("a.stl", "solid nothing\nendsolid nothing\n"), "");
  std::string many;
  for (int n = 0; n < 300; ++n) {
    many += stl();
  }
  expect_refused("a.stl", many, ":7508: has more triangles than max_triangles (1000)");
  std::string solids;
  for (int n = 0; n < 1001; ++n) {
    solids += "solid\nendsolid\n";
  }
  expect_refused("a.stl", solids, ":2001: has more triangles than max_triangles (1000)");
}

TEST_F(DamagedMesh, BinaryStlIsRefused) {
  ASSERT_EQ(refusal("a.stl", binary_stl()), "");
  const auto with = [](std::size_t at, auto value) {
    std::string bytes = binary_stl();
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
  };
  const std::string length =
      "is not an STL file: it does not begin with 'solid', and a binary one of ";
  for (const std::uint32_t count : {0U, 3U, 5U, 1000U, 4294967295U}) {
    expect_refused("a.stl", with(80, count),
                   length + std::to_string(count) + " triangles, as it declares, has " +
                       std::to_string(84 + 50 * std::size_t(count)) + " bytes, found 284");
  }
  expect_refused("a.stl", binary_stl() + "x", length);
  expect_refused("a.stl", "", "is not an STL file: it has 0 bytes");
  expect_refused("a.stl", std::string(83, 'x'), "is not an STL file: it has 83 bytes");
  const std::string none = std::string(84, '\0');
  EXPECT_NE(refusal("a.stl", none), "");
  std::string many(84, ' ');
  const std::uint32_t count = 1001;
  std::memcpy(many.data() + 80, &count, sizeof count);
  many += std::string(50 * count, '\0');
  expect_refused("a.stl", many, "has 1001 triangles, more than max_triangles (1000)");
  expect_refused("a.stl", std::string(600000, 'x'), "more than 512 for each of max_triangles");
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30F}) {
    for (const std::size_t number : {0U, 1U, 2U, 4U, 8U}) {
      expect_refused("a.stl", with(96 + 4 * number, bad), "has a coordinate that is not a number");
    }
  }
  expect_refused("a.stl", with(96 + 12, 0.25F), "is not closed");
  std::string small = binary_stl();
  for (std::size_t at = 84; at < small.size(); at += 50) {
    std::memset(small.data() + at + 12, 0, 36);
  }
  EXPECT_NE(refusal("a.stl", small), "");
}

TEST_F(DamagedMesh, ObjIsRefusedByLine) {
  ASSERT_EQ(refusal("a.obj", obj()), "");
  const std::string face = ".obj:8: expected 'f' and 3 to 1000 of the vertices before it, found ";
  const Damage all[] = {
      {"v 1 0 0", "v 1 0", ".obj:4: expected 'v' and three numbers, or six with a colour"},
      {"v 1 0 0", "v 1 0 0 0.5", ".obj:4: expected 'v' and three numbers"},
      {"v 1 0 0", "v 1 0 nan", ".obj:4: expected 'v' and three numbers"},
      {"v 1 0 0", "v 1 0 -inf", ".obj:4: expected 'v' and three numbers"},
      {"v 1 0 0", "v 1 0 0x1", ".obj:4: expected 'v' and three numbers"},
      {"v 1 0 0", "v 1 0 1e+", ".obj:4: expected 'v' and three numbers"},
      {"v 1 0 0", "v one 0 0", ".obj:4: expected 'v' and three numbers"},
      {"v 1 0 0", "w 1 0 0", ".obj:4: expected a statement of an OBJ file"},
      {"v 1 0 0", "\x01\x02",
       ".obj:4: expected a statement of an OBJ file (v, f, vn, vt, o, g, s, "
       "usemtl, …), found '"},
      {"v 1 0 0", "v 1e30 0 0", "has a coordinate that is not a number of at most 1e+09"},
      {"v 1 0 0", "", ".obj:9: expected 'f'"},
      {"f 1//1 3", "f 0//1 3", face.c_str()},
      {"f 1//1 3", "f 5//1 3", face.c_str()},
      {"f 1//1 3", "f -5//1 3", face.c_str()},
      {"f 1//1 3", "f 1.5//1 3", face.c_str()},
      {"f 1//1 3", "f //1 3", face.c_str()},
      {"f 1//1 3", "f 99999999999999999999 3", face.c_str()},
      {"f 1//1 3//1 2//1", "f 1 3", face.c_str()},
      {"f 1//1 3//1 2//1", "f", face.c_str()},
      {"f 1//1 3//1 2//1", "f 1 3 2 \\\n1", face.c_str()},
      {"f 1//1 3//1 2//1", "f 1 2 3", "is not closed: 0 edges are in one triangle only, and 3"},
      {"f 1//1 3//1 2//1\n", "", "is not closed: 3 edges are in one triangle only, and 0"},
      {"f 1//1 3//1 2//1", "f 1 1 1", "is not closed"}};
  for (const Damage& damage : all) {
    expect_refused("a.obj", replaced(obj(), damage.from, damage.to), damage.why);
  }
  for (const char* text : {"", "\n\n", "# nothing\n", "v 0 0 0\n", "o a\no b\no c\n"}) {
    EXPECT_NE(refusal("a.obj", text), "") << text;
  }
  std::string wide = obj() + "f";
  for (int n = 0; n < 1001; ++n) {
    wide += " 1";
  }
  expect_refused("a.obj", wide, ".obj:12: expected 'f' and 3 to 1000");
  std::string many = obj();
  for (int n = 0; n < 1000; ++n) {
    many += "f 1 2 3\n";
  }
  expect_refused("a.obj", many, ".obj:1008: has more triangles than max_triangles (1000)");
}

TEST_F(DamagedMesh, WhatIsNoModelIsRefused) {
  for (const char* name : {"a.ply", "a", "a.stl.gz", "a.3ds", "a.gltf"}) {
    expect_refused(name, obj(), "expected a file that ends in .stl or .obj");
  }
  expect_refused("a.stl", obj(), "is not an STL file");
  expect_refused("a.obj", stl(), ".obj:1: expected a statement of an OBJ file");
  std::filesystem::create_directory(folder_ / "folder.stl");
  EXPECT_NE(mesh_refusal(folder_ / "folder.stl").find("is a folder, expected a file"),
            std::string::npos);
  std::filesystem::create_symlink("/dev/zero", folder_ / "endless.obj");
  EXPECT_NE(mesh_refusal(folder_ / "endless.obj").find("is a device, expected a file"),
            std::string::npos);
}

TEST_F(DamagedMesh, EveryTruncationIsRefusedOrASolid) {
  for (const auto& [name, bytes] :
       {std::pair("a.stl", stl()), {"a.stl", binary_stl()}, {"a.obj", obj()}}) {
    int taken = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      taken += refusal(name, bytes.substr(0, length)).empty() ? 1 : 0;
    }
    EXPECT_LE(taken, 16) << name;  // within the last line: its name, or a corner's normal
  }
}

TEST_F(DamagedMesh, EveryOtherByteMayBeAnother) {
  for (const auto& [name, bytes] :
       {std::pair("a.stl", stl()), {"a.stl", binary_stl()}, {"a.obj", obj()}}) {
    int refused = 0;
    for (std::size_t at = 0; at < bytes.size(); at += 2) {
      for (const char other : {'\0', '\xff', '9'}) {
        std::string damaged = bytes;
        damaged[at] = other;
        const std::string said = refusal(name, damaged);
        refused += said.empty() ? 0 : 1;
        EXPECT_EQ(said.find("does not name the file"), std::string::npos) << said;
      }
    }
    EXPECT_GT(refused, 20) << name;
  }
}
}  // namespace
}  // namespace altiplan::testing::mesh_damage_test
