// SPDX-License-Identifier: Apache-2.0
// The heights of an elevation model, read block by block as in its file, straight into their array.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dem.hpp"
#include "mosaic.hpp"
#include "place.hpp"

namespace terrain {
namespace {

using gdal::api;

/// Converts the file's numbers to metres, NaN where they mark a void; returns the number of voids,
/// or -1 if a height is impossible on the Earth.
std::int64_t to_metres(const Dem& dem, float* row, int count) {
  constexpr float kMax = std::numeric_limits<float>::max();
  const auto [nodata, asked_nodata] = dem.nodata;
  int voids = 0;
  int wrong = 0;
  for (int k = 0; k < count; ++k) {
    const float read = row[k];
    const auto height = float(dem.unit * (dem.scale * read + dem.offset));
    const bool is_void =
        !(std::abs(read) <= kMax) || read == nodata || read == asked_nodata || std::isnan(height);
    voids += is_void ? 1 : 0;
    wrong += is_void || (height >= kLowest && height <= kHighest) ? 0 : 1;
    row[k] = is_void ? NAN : height;
  }
  return wrong > 0 ? -1 : voids;
}

/// A range of the file's rows and columns.
struct Window {
  int x, y, columns, rows;
};

/// The file's rows of a part, in either order.
Window window_of(const Dem& dem, const Part& part) {
  return {part.column, dem.from_north ? dem.rows - part.row - part.rows : part.row, part.columns,
          part.rows};
}

/// Reads windows of a part into their positions among its heights.
class Reader {
 public:
  Reader(const Params& params, const Dem& dem, Posts& posts)
      : params_(params), dem_(dem), posts_(posts), whole_(window_of(dem, posts.part)) {}

  /// Decodes each block once, however few GDAL's cache holds.
  void read() {
    int width = dem_.columns;
    int height = dem_.rows;
    if (dem_.band != nullptr) {
      api().GDALGetBlockSize(dem_.band, &width, &height);
    }
    const int right = whole_.x + whole_.columns;
    const int below = whole_.y + whole_.rows;
    for (int y = whole_.y, next_y = 0; y < below; y = next_y) {
      next_y = int(std::min<std::int64_t>(below, (std::int64_t(y) / height + 1) * height));
      for (int x = whole_.x, next_x = 0; x < right; x = next_x) {
        next_x = int(std::min<std::int64_t>(right, (std::int64_t(x) / width + 1) * width));
        read({x, y, next_x - x, next_y - y});
      }
    }
  }

 private:
  float* place(int x, int y) const {
    const int row = dem_.from_north ? whole_.y + whole_.rows - 1 - y : y - whole_.y;
    return posts_.heights.data() + std::size_t(row) * std::size_t(whole_.columns) +
           std::size_t(x - whole_.x);
  }

  /// The file's own numbers of a window, into their places.
  void fetch(const Window& w) {
    if (dem_.band == nullptr) {
      for (int y = w.y; y < w.y + w.rows; ++y) {
        std::copy_n(dem_.numbers.begin() + std::ptrdiff_t(y) * dem_.columns + w.x, w.columns,
                    place(w.x, y));
      }
      return;
    }
    const GSpacing post = sizeof(float);
    const GSpacing row = post * whole_.columns * (dem_.from_north ? -1 : 1);
    if (api().GDALRasterIOEx(dem_.band, GF_Read, w.x, w.y, w.columns, w.rows, place(w.x, w.y),
                             w.columns, w.rows, GDT_Float32, post, row, nullptr) != CE_None) {
      refuse(params_, "damaged: " + gdal::last_error());
    }
  }

  void read(const Window& w) {
    fetch(w);
    for (int y = w.y; y < w.y + w.rows; ++y) {
      const std::int64_t voids = to_metres(dem_, place(w.x, y), w.columns);
      if (voids < 0) {
        refuse_height(w, y);
      }
      posts_.voids += std::size_t(voids);
    }
  }

  [[noreturn]] void refuse_height(const Window& w, int y) const {
    const float* row = place(w.x, y);
    const float* found = std::find_if(
        row, row + w.columns, [](float height) { return height < kLowest || height > kHighest; });
    refuse(params_, "expected heights within -1000 and 10000 m, found " + number(*found) +
                        " at column " + std::to_string(w.x + (found - row)) + ", row " +
                        std::to_string(y) + "; if this marks a void, set nodata");
  }

  const Params& params_;
  const Dem& dem_;
  Posts& posts_;
  Window whole_;
};

/// Refuses a part for which the file has no data.
void expect_data(const Params& params, const Dem& dem, const Part& part) {
  const Window window = window_of(dem, part);
  const int missing =
      api().GDALGetDataCoverageStatus(dem.band, window.x, window.y, window.columns, window.rows,
                                      GDAL_DATA_COVERAGE_STATUS_EMPTY, nullptr);
  if (missing & GDAL_DATA_COVERAGE_STATUS_EMPTY) {
    refuse(params, "parts of the file contain no data");
  }
}

Posts read(const Params& params, const Dem& dem, const Part& part) {
  std::optional<gdal::Quiet> quiet;
  expect_few(params, dem, part);
  if (dem.band != nullptr) {
    quiet.emplace();
    expect_data(params, dem, part);
  }
  Posts posts{part, {}, 0};
  posts.heights.resize(std::size_t(part.columns) * std::size_t(part.rows));
  Reader(params, dem, posts).read();
  if (dem.above_ellipsoid) {
    bring_to_sea_level(dem, posts);
  }
  return posts;
}

// Ring by ring from the border inward: a void gets the mean of those of its eight neighbours that
// had a height before this ring.
void fill_from_neighbours(Posts& posts) {
  const auto at = [&](int i, int j) {
    return std::size_t(j) * std::size_t(posts.part.columns) + i;
  };
  std::vector<std::array<int, 2>> left;
  for (int j = 0; j < posts.part.rows; ++j) {
    for (int i = 0; i < posts.part.columns; ++i) {
      if (std::isnan(posts.heights[at(i, j)])) {
        left.push_back({i, j});
      }
    }
  }
  while (!left.empty()) {
    std::vector<std::array<int, 2>> next;
    std::vector<std::pair<std::size_t, float>> ring;
    for (const auto& [i, j] : left) {
      double sum = 0;
      int count = 0;
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, posts.part.rows - 1); ++y) {
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, posts.part.columns - 1); ++x) {
          if (const float height = posts.heights[at(x, y)]; !std::isnan(height)) {
            sum += height;
            ++count;
          }
        }
      }
      if (count > 0) {
        ring.emplace_back(at(i, j), float(sum / count));
      } else {
        next.push_back({i, j});
      }
    }
    for (const auto& [k, height] : ring) {
      posts.heights[k] = height;
    }
    left = std::move(next);
  }
}

void fill(const Params& params, Posts& posts) {
  const std::string count =
      std::to_string(posts.voids) + " of " + std::to_string(posts.heights.size()) + " posts";
  if (posts.voids == posts.heights.size()) {
    refuse(params, "no post has a height");
  }
  switch (params.voids) {
    case Voids::refuse:
      refuse(params,
             "has voids (" + count +
                 " have no height); choose voids: neighbours, or voids: fill_m with a height "
                 "fill_m",
             "voids");
    case Voids::fill_m:
      for (float& height : posts.heights) {
        height = std::isnan(height) ? float(*params.fill_m) : height;
      }
      break;
    case Voids::neighbours:
      fill_from_neighbours(posts);
      break;
  }
}
}  // namespace

Posts read_posts(const Params& params, const Dem& dem, const Part& part) {
  if (!dem.tiles.empty()) {
    return read_tiles(params, dem, part);
  }
  Posts posts = read(params, dem, part);
  const std::size_t all = std::size_t(dem.columns) * std::size_t(dem.rows);
  const bool by_themselves = params.voids == Voids::fill_m && posts.voids < posts.heights.size();
  if (posts.voids > 0 && posts.heights.size() < all && !by_themselves) {
    posts = {};  // before twice as much is allocated
    posts = read(params, dem, dem.whole());
  }
  if (posts.voids > 0) {
    fill(params, posts);
  }
  return posts;
}
}  // namespace terrain
