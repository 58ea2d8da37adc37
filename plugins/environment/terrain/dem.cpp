// SPDX-License-Identifier: Apache-2.0
#include "dem.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "altiplan/error.hpp"
#include "whole.hpp"

namespace terrain {
namespace {

using altiplan::ParameterError;
using gdal::api;

// What the ground of the Earth can be, with room to spare; beyond it a number marks a void.
constexpr double kLowest = -1000;
constexpr double kHighest = 10000;

[[noreturn]] void refuse(const Params& params, const std::string& why, const char* key = "file") {
  throw ParameterError(key, params.file.text + ": " + why);
}

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text;
}

gdal::Dataset open(const Params& params) {
  const std::string& file = params.file.text;
  if (file.rfind("/vsi", 0) == 0 || file.find("://") != std::string::npos ||
      file.find(":/") != std::string::npos) {
    refuse(params, "expected a file of this machine, found a URL or one of GDAL's virtual files");
  }
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    refuse(params, "no such file");
  }
  if (!std::filesystem::is_regular_file(file, error)) {
    refuse(params, "expected a file, found a folder or a device");
  }
  const char* const drivers[] = {"GTiff", "SRTMHGT", "AAIGrid", "DTED", "ENVI", nullptr};
  gdal::Dataset dataset(api().GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR,
                                         drivers, nullptr, nullptr));
  if (!dataset) {
    refuse(params,
           "expected an elevation model (GeoTIFF, SRTM .hgt, DTED, ESRI ASCII grid, ENVI); " +
               gdal::last_error());
  }
  return dataset;
}

void read_size(const Params& params, void* dataset, Dem& dem) {
  dem.columns = api().GDALGetRasterXSize(dataset);
  dem.rows = api().GDALGetRasterYSize(dataset);
  const std::string size = std::to_string(dem.columns) + " x " + std::to_string(dem.rows);
  if (dem.columns < 2 || dem.rows < 2) {
    refuse(params, "expected at least 2 x 2 posts, found " + size);
  }
  if (std::int64_t(dem.columns) * dem.rows > params.max_posts) {
    refuse(params,
           "declares " + size + " posts, more than max_posts (" + std::to_string(params.max_posts) +
               ")",
           "max_posts");
  }
}

void* read_band(const Params& params, void* dataset) {
  const int bands = api().GDALGetRasterCount(dataset);
  if (bands != 1 && !params.band) {
    refuse(params, "has " + std::to_string(bands) + " bands; say which one holds the heights",
           "band");
  }
  if (params.band.value_or(1) > bands) {
    refuse(params,
           "has no band " + std::to_string(*params.band) + ", only " + std::to_string(bands),
           "band");
  }
  void* band = api().GDALGetRasterBand(dataset, params.band.value_or(1));
  if (api().GDALDataTypeIsComplex(api().GDALGetRasterDataType(band))) {
    refuse(params, "expected heights, found complex numbers");
  }
  return band;
}

void read_crs(const Params& params, void* dataset, Dem& dem) {
  gdal::Reference asked = params.crs.empty() ? nullptr : gdal::reference(params.crs);
  if (!params.crs.empty() && !asked) {
    refuse(params, "crs: expected EPSG: and a known code (EPSG:4326), found " + params.crs, "crs");
  }
  if (OGRSpatialReferenceH own = api().GDALGetSpatialRef(dataset)) {
    dem.crs = gdal::copy(own);
    if (asked && !api().OSRIsSame(asked.get(), dem.crs.get())) {
      refuse(params,
             std::string("has a coordinate system of its own (") + api().OSRGetName(dem.crs.get()) +
                 "), and crs says " + params.crs,
             "crs");
    }
  } else if (asked) {
    dem.crs = std::move(asked);
  } else {
    refuse(params,
           "names no coordinate system; say which one it is in (crs: EPSG:4326 for "
           "longitude and latitude)",
           "crs");
  }
  dem.crs_name = api().OSRGetName(dem.crs.get());
  dem.geographic = api().OSRIsGeographic(dem.crs.get()) != 0;
  if (!dem.geographic && !api().OSRIsProjected(dem.crs.get())) {
    refuse(params, "expected a geographic or projected coordinate system, found " + dem.crs_name,
           "crs");
  }
  dem.unit_m = dem.geographic ? 1 : api().OSRGetLinearUnits(dem.crs.get(), nullptr);
}

// Places the posts at the cells' centres; true where the file's rows run from the north.
bool read_position(const Params& params, void* dataset, Dem& dem) {
  double g[6];
  const bool known = api().GDALGetGeoTransform(dataset, g) == CE_None;
  if (!known ||
      (g[0] == 0 && g[1] == 1 && g[2] == 0 && g[3] == 0 && g[4] == 0 && std::abs(g[5]) == 1)) {
    refuse(params, "says nowhere on the Earth (no georeference)");
  }
  if (g[2] != 0 || g[4] != 0) {
    refuse(params, "expected rows that run west to east, found a rotated grid");
  }
  if (!(g[1] > 0) || g[5] == 0 || !std::isfinite(g[0] + g[1] + g[3] + g[5])) {
    refuse(params, "expected cells with a size, found " + number(g[1]) + " x " + number(g[5]));
  }
  const bool from_north = g[5] < 0;
  dem.step = {g[1], std::abs(g[5])};
  dem.south_west = {g[0] + 0.5 * g[1],
                    from_north ? g[3] + (dem.rows - 0.5) * g[5] : g[3] + 0.5 * g[5]};
  const double north = dem.south_west[1] + (dem.rows - 1) * dem.step[1];
  if (dem.geographic &&
      (dem.south_west[1] < -90 || north > 90 || (dem.columns - 1) * dem.step[0] > 360)) {
    refuse(params, "expected latitudes within -90 and 90 degrees, found " +
                       number(dem.south_west[1]) + " to " + number(north));
  }
  return from_north;
}

double metres_per_unit(const Params& params, void* band) {
  std::string unit = api().GDALGetRasterUnitType(band);
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), unit) != names.end();
  };
  if (is({"", "m", "metre", "meter", "metres", "meters"})) {
    return 1;
  }
  if (is({"ft", "foot", "feet", "international foot"})) {
    return 0.3048;
  }
  if (is({"us survey foot", "us-ft", "ftus", "us foot", "foot_us"})) {
    return 1200.0 / 3937;
  }
  refuse(params, "expected heights in metres or feet, found the unit '" + unit + "'");
}

// Heights in metres, rows from the south; voids are NaN.
void read_heights(const Params& params, void* band, bool from_north, Dem& dem) {
  const int missing = api().GDALGetDataCoverageStatus(band, 0, 0, dem.columns, dem.rows,
                                                      GDAL_DATA_COVERAGE_STATUS_EMPTY, nullptr);
  if (missing & GDAL_DATA_COVERAGE_STATUS_EMPTY) {
    refuse(params, "parts of the file hold no data");
  }
  dem.heights.resize(std::size_t(dem.columns) * std::size_t(dem.rows));
  if (api().GDALRasterIO(band, GF_Read, 0, 0, dem.columns, dem.rows, dem.heights.data(),
                         dem.columns, dem.rows, GDT_Float32, 0, 0) != CE_None) {
    refuse(params, "damaged: " + gdal::last_error());
  }
  int has_nodata = 0;
  const double own_nodata = api().GDALGetRasterNoDataValue(band, &has_nodata);
  const float nodata = has_nodata ? float(own_nodata) : NAN;
  const float asked_nodata = params.nodata ? float(*params.nodata) : NAN;
  int has_scale = 0;
  int has_offset = 0;
  const double scale = api().GDALGetRasterScale(band, &has_scale);
  const double offset = api().GDALGetRasterOffset(band, &has_offset);
  const double unit = metres_per_unit(params, band);
  for (std::size_t k = 0; k < dem.heights.size(); ++k) {
    float& height = dem.heights[k];
    if (!std::isfinite(height) || height == nodata || height == asked_nodata) {
      height = NAN;
      continue;
    }
    height = float(unit * ((has_scale ? scale : 1) * height + (has_offset ? offset : 0)));
    if (!(height >= kLowest && height <= kHighest)) {
      refuse(params, "expected heights within -1000 and 10000 m, found " + number(height) +
                         " at column " + std::to_string(k % std::size_t(dem.columns)) + ", row " +
                         std::to_string(k / std::size_t(dem.columns)) +
                         "; where this marks a void, say so with nodata");
    }
  }
  if (from_north) {
    for (int j = 0; j < dem.rows / 2; ++j) {
      const auto row = dem.heights.begin() + std::ptrdiff_t(j) * dem.columns;
      std::swap_ranges(row, row + dem.columns,
                       dem.heights.begin() + std::ptrdiff_t(dem.rows - 1 - j) * dem.columns);
    }
  }
}

// Ring by ring from the border inward: a void gets the mean of those of its eight neighbours that
// had a height before this ring.
void fill_from_neighbours(Dem& dem) {
  const auto at = [&](int i, int j) { return std::size_t(j) * std::size_t(dem.columns) + i; };
  std::vector<std::array<int, 2>> left;
  for (int j = 0; j < dem.rows; ++j) {
    for (int i = 0; i < dem.columns; ++i) {
      if (std::isnan(dem.heights[at(i, j)])) {
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
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, dem.rows - 1); ++y) {
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, dem.columns - 1); ++x) {
          if (const float height = dem.heights[at(x, y)]; !std::isnan(height)) {
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
      dem.heights[k] = height;
    }
    left = std::move(next);
  }
}

void treat_voids(const Params& params, Dem& dem) {
  dem.voids = std::size_t(
      std::count_if(dem.heights.begin(), dem.heights.end(), [](float h) { return std::isnan(h); }));
  if (dem.voids == 0) {
    return;
  }
  const std::string count =
      std::to_string(dem.voids) + " of " + std::to_string(dem.heights.size()) + " posts";
  if (dem.voids == dem.heights.size()) {
    refuse(params, "no post has a height");
  }
  switch (params.voids) {
    case Voids::refuse:
      refuse(params,
             "has voids (" + count +
                 " have no height); say what becomes of them with "
                 "voids: neighbours, or voids: fill_m with a height fill_m",
             "voids");
    case Voids::fill_m:
      for (float& height : dem.heights) {
        height = std::isnan(height) ? float(*params.fill_m) : height;
      }
      break;
    case Voids::neighbours:
      fill_from_neighbours(dem);
      break;
  }
}
}  // namespace

Dem read_dem(const Params& params) {
  const gdal::Quiet quiet;
  const gdal::Dataset dataset = open(params);
  Dem dem;
  read_size(params, dataset.get(), dem);
  if (const std::string missing = missing_from(params.file.text, dataset.get()); !missing.empty()) {
    refuse(params, "damaged: " + missing);
  }
  void* band = read_band(params, dataset.get());
  read_crs(params, dataset.get(), dem);
  const bool from_north = read_position(params, dataset.get(), dem);
  read_heights(params, band, from_north, dem);
  treat_voids(params, dem);
  return dem;
}
}  // namespace terrain
