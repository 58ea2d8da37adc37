// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>

#include "altiplan/height_field.hpp"
#include "terrain_files_test.hpp"

namespace altiplan::terrain_tiles_test {
namespace {

/// Posts a hundredth of a degree apart, from one at 10 east and 45 north on.
constexpr double kStep = 0.01;

double height_of_post(int i, int j) { return 500 + std::round(100 * std::sin(i * 12.9 + j * 4.1)); }

class Tiles : public MadeFiles {
 protected:
  struct Place {
    int i, j, columns, rows;
  };
  std::filesystem::path tile(const std::string& name, const Place& at, double step = kStep,
                             double shift = 0) const {
    std::string rows;
    for (int j = at.rows - 1; j >= 0; --j) {
      for (int i = 0; i < at.columns; ++i) {
        rows += std::to_string(int(height_of_post(at.i + i, at.j + j))) + " ";
      }
      rows += "\n";
    }
    const auto corner = [&](double origin, int post) {
      return std::to_string(origin + (post - 0.5) * kStep + shift);
    };
    return write(name, "ncols " + std::to_string(at.columns) + "\nnrows " +
                           std::to_string(at.rows) + "\nxllcorner " + corner(10, at.i) +
                           "\nyllcorner " + corner(45, at.j) + "\ncellsize " +
                           std::to_string(step) + "\n" + rows);
  }
  static std::string with(const std::vector<std::filesystem::path>& tiles) {
    std::string list;
    for (const auto& file : tiles) {
      list += (list.empty() ? "'" : ", '") + file.string() + "'";
    }
    return "crs: EPSG:4326, tiles: [" + list + "]";
  }
};

void expect_same_heights(const Environment& a, const Environment& b) {
  const HeightField& one = *a.ground()->height_field();
  const HeightField& other = *b.ground()->height_field();
  ASSERT_EQ(one.columns(), other.columns());
  ASSERT_EQ(one.rows(), other.rows());
  for (int j = 0; j < one.rows(); ++j) {
    for (int i = 0; i < one.columns(); ++i) {
      ASSERT_EQ(one.post(i, j), other.post(i, j)) << i << ", " << j;
    }
  }
}

TEST_F(Tiles, AreTheUndividedModel) {
  const auto whole = tile("whole.asc", {0, 0, 19, 13});
  // With a row of posts in common, and without.
  for (const int common : {0, 1}) {
    const auto a = tile("a.asc", {0, 0, 10 + common, 6 + common});
    const auto b = tile("b.asc", {10, 0, 9, 6 + common});
    const auto c = tile("c.asc", {0, 6, 10 + common, 7});
    const auto d = tile("d.asc", {10, 6, 9, 7});
    const Made one = make_environment("terrain", file_yaml(whole, "crs: EPSG:4326"));
    const Made tiles = make_environment("terrain", file_yaml(c, with({d, a, b})));
    expect_same_heights(*one, *tiles);
    EXPECT_NEAR((one->bounds().max - tiles->bounds().max).head<2>().norm(), 0, 1e-6);
  }
}

TEST_F(Tiles, LeaveNoGapWhereTheyAreResampled) {
  const auto south = tile("south.asc", {0, 0, 60, 40});
  const auto north = tile("north.asc", {0, 40, 60, 40});
  Site site;
  site.frame = Frame::local({10.1, 45.4});
  site.about = {{10.1, 45.1}, {10.1, 45.7}};
  const Made one = make_environment("terrain", file_yaml(south, with({north})), site);
  for (double lat = 45.05; lat < 45.75; lat += 0.001) {
    const auto [x, y] = site.frame.to_local(10.1, lat);
    EXPECT_TRUE(one->ground()->height(x, y)) << lat;
  }
}

TEST_F(Tiles, AreOneHigherGroundWherePostsInCommonDiffer) {
  const auto west = tile("west.asc", {0, 0, 3, 2});
  const auto east = write("east.asc",
                          "ncols 2\nnrows 2\nxllcorner 10.015\nyllcorner 44.995\ncellsize 0.01\n"
                          "999 1\n999 1\n");
  const Made one = make_environment("terrain", file_yaml(west, with({east})));
  const HeightField& field = *one->ground()->height_field();
  ASSERT_EQ(field.columns(), 4);
  EXPECT_EQ(field.post(2, 0), 999);
  EXPECT_EQ(field.post(3, 1), 1);
}

TEST_F(Tiles, AreClosedWhereNoneLies) {
  const auto west = tile("west.asc", {0, 0, 10, 13});
  const auto east = tile("east.asc", {10, 7, 9, 6});
  const Made whole =
      make_environment("terrain", file_yaml(tile("whole.asc", {0, 0, 19, 13}), "crs: EPSG:4326"));
  for (const char* voids : {"refuse", "neighbours"}) {
    const Made some = make_environment(
        "terrain", file_yaml(west, with({east}) + ", voids: " + std::string(voids)));
    const HeightField& field = *some->ground()->height_field();
    ASSERT_EQ(field.columns(), 19);
    ASSERT_EQ(field.rows(), 13);
    for (int j = 0; j < 13; ++j) {
      for (int i = 0; i < 19; ++i) {
        ASSERT_EQ(field.post(i, j),
                  i < 10 || j >= 7 ? whole->ground()->height_field()->post(i, j) : 10000)
            << i << ", " << j;
      }
    }
  }
}

TEST_F(Tiles, AreClosedAboutWhereNoneLiesWhereTheyAreResampled) {
  const auto west = tile("west.asc", {0, 0, 60, 80});
  const auto east = tile("east.asc", {60, 40, 60, 40});
  Site site;
  site.frame = Frame::local({10.6, 45.4});
  site.about = {{10.5, 45.2}, {10.5, 45.6}};
  const Made some = make_environment("terrain", file_yaml(west, with({east})), site);
  const HeightField& field = *some->ground()->height_field();
  int closed = 0;
  for (int j = 0; j < field.rows(); ++j) {
    for (int i = 0; i < field.columns(); ++i) {
      const double height = field.post(i, j);
      EXPECT_TRUE(height < 650 || height >= 10000) << height;  // nothing between the two
      closed += height >= 10000 ? 1 : 0;
    }
  }
  EXPECT_GT(closed, 100);
}

TEST_F(Tiles, AreRefusedWhereTheyAreNoOneModel) {
  const auto a = tile("a.asc", {0, 0, 10, 6});
  const auto refused = [&](const std::vector<std::filesystem::path>& tiles) {
    return refusal(a, with(tiles));
  };
  EXPECT_SAYS(refused({tile("finer.asc", {10, 0, 10, 6}, 0.005)}),
              "has posts that lie between its own");
  EXPECT_SAYS(refused({tile("between.asc", {10, 0, 10, 6}, kStep, 0.004)}),
              "'" + (folder_ / "between.asc").string() + "' among its tiles has posts that lie");
  EXPECT_SAYS(refused({folder_ / "none.asc"}), "none.asc");
  EXPECT_SAYS(refusal(a, with({tile("b.asc", {10, 0, 9, 6})}) + ", max_posts: 113"),
              "declares 19 x 6 posts, more than max_posts");
}
}  // namespace
}  // namespace altiplan::terrain_tiles_test
