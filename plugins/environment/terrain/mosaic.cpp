// SPDX-License-Identifier: Apache-2.0
// One model of several tiles: files of one grid side by side, with or without a row of posts in
// common. Where no tile lies, nobody knows the ground: it is closed.
#include "mosaic.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/earth.hpp"

namespace terrain {
namespace {

Params of_tile(const Params& params, const altiplan::Path& file) {
  Params own = params;
  own.file = file;
  own.tiles.clear();
  return own;
}

[[noreturn]] void refuse_tile(const Params& params, const Dem& tile, const std::string& why) {
  refuse(params, "'" + tile.file.text + "' among its tiles " + why, "tiles");
}

bool is_same_system(const Dem& a, const Dem& b) {
  return a.local == b.local && a.geographic == b.geographic && a.datum == b.datum &&
         a.above_ellipsoid == b.above_ellipsoid &&
         (bool(a.crs) == bool(b.crs) ? !a.crs || gdal::api().OSRIsSame(a.crs.get(), b.crs.get())
                                     : false);
}

/// Puts a tile on the grid of the first one, counted from its south-west post.
void put_on_grid(const Params& params, const Dem& first, Dem& tile) {
  if (!is_same_system(first, tile)) {
    refuse_tile(params, tile, "has another coordinate system, or another zero of heights");
  }
  constexpr double kSame = 0.01;  // of a step
  double west = tile.south_west[0];
  if (first.geographic) {
    west = altiplan::longitude_near(west, first.south_west[0]);
  }
  const std::array<double, 2> posts{static_cast<double>(tile.columns),
                                    static_cast<double>(tile.rows)};
  const std::array<double, 2> at{(west - first.south_west[0]) / first.step[0],
                                 (tile.south_west[1] - first.south_west[1]) / first.step[1]};
  for (const std::size_t axis : {0U, 1U}) {
    const double drift = posts[axis] * std::abs(tile.step[axis] / first.step[axis] - 1);
    if (!(drift + std::abs(at[axis] - std::round(at[axis])) < kSame)) {
      refuse_tile(params, tile, "has posts that lie between its own");
    }
  }
  tile.place = {int(std::lround(at[0])), int(std::lround(at[1])), tile.columns, tile.rows};
}
}  // namespace

Dem read_mosaic(const Params& params, bool may_read_a_part) {
  std::vector<Dem> tiles;
  tiles.push_back(read_dem(of_tile(params, params.file), may_read_a_part));
  for (const altiplan::Path& file : params.tiles) {
    tiles.push_back(read_dem(of_tile(params, file), may_read_a_part));
  }
  std::array<int, 4> sides{0, 0, 0, 0};  // first column and row, and those beyond the last
  for (Dem& tile : tiles) {
    put_on_grid(params, tiles.front(), tile);
    sides = {std::min(sides[0], tile.place.column), std::min(sides[1], tile.place.row),
             std::max(sides[2], tile.place.column + tile.columns),
             std::max(sides[3], tile.place.row + tile.rows)};
  }
  const Dem& first = tiles.front();
  Dem all;
  all.file = params.file;
  all.columns = sides[2] - sides[0];
  all.rows = sides[3] - sides[1];
  all.south_west = {first.south_west[0] + sides[0] * first.step[0],
                    first.south_west[1] + sides[1] * first.step[1]};
  all.step = first.step;
  if (first.crs) {
    all.crs = gdal::copy(first.crs.get());
  }
  all.crs_name = first.crs_name;
  all.crs_code = first.crs_code;
  all.datum = first.datum;
  all.above_ellipsoid = first.above_ellipsoid;
  all.geographic = first.geographic;
  all.local = first.local;
  all.unit_m = first.unit_m;
  for (Dem& tile : tiles) {
    tile.place.column -= sides[0];
    tile.place.row -= sides[1];
  }
  all.tiles = std::move(tiles);
  if (!may_read_a_part) {
    expect_few(params, all, all.whole());
  }
  return all;
}

Posts read_tiles(const Params& params, const Dem& dem, const Part& part) {
  expect_few(params, dem, part);
  Posts posts{part, {}, 0};
  posts.heights.assign(std::size_t(part.columns) * std::size_t(part.rows), NAN);
  for (const Dem& tile : dem.tiles) {
    const int column = std::max(part.column, tile.place.column);
    const int row = std::max(part.row, tile.place.row);
    const Part own{column - tile.place.column, row - tile.place.row,
                   std::min(part.column + part.columns, tile.place.column + tile.columns) - column,
                   std::min(part.row + part.rows, tile.place.row + tile.rows) - row};
    if (own.columns <= 0 || own.rows <= 0) {
      continue;
    }
    const Posts read = read_posts(of_tile(params, tile.file), tile, own);
    posts.voids += read.voids;
    for (int j = 0; j < own.rows; ++j) {
      // Of posts in common the higher one counts. What was read may be the whole tile.
      const float* from =
          read.heights.data() +
          std::size_t(own.row + j - read.part.row) * std::size_t(read.part.columns) +
          (own.column - read.part.column);
      float* to = posts.heights.data() +
                  std::size_t(row + j - part.row) * std::size_t(part.columns) +
                  (column - part.column);
      std::transform(from, from + own.columns, to, to,
                     [](float a, float b) { return std::fmax(a, b); });
    }
  }
  std::replace_if(
      posts.heights.begin(), posts.heights.end(), [](float height) { return std::isnan(height); },
      float(kHighest));
  return posts;
}
}  // namespace terrain
