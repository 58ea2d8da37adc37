// SPDX-License-Identifier: Apache-2.0
#include "dem.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "plain.hpp"
#include "whole.hpp"

namespace terrain {
namespace fs = std::filesystem;

void refuse(const Params& params, const std::string& why, const char* key) {
  throw altiplan::ParameterError(key, params.file.text + ": " + why);
}

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text;
}

namespace {

using gdal::api;

/// The file, and its sidecar files (.hdr, .prj, .aux.xml …), which GDAL opens too.
std::vector<fs::path> files_of(const Params& params) {
  const fs::path file = fs::absolute(params.file.text);
  std::vector<fs::path> files{file};
  std::error_code unknown;  // for an unlistable folder, which GDAL does not list either
  for (const auto& entry : fs::directory_iterator(file.parent_path(), unknown)) {
    const fs::path& beside = entry.path();
    if (beside == file || (beside.stem() != file.stem() && beside.stem() != file.filename() &&
                           beside.stem().stem() != file.filename())) {
      continue;
    }
    const fs::file_type type = entry.status().type();
    if (type == fs::file_type::regular &&
        (::access(beside.c_str(), R_OK) == 0 || errno != EACCES)) {
      files.push_back(beside);
    } else if (type != fs::file_type::regular && type != fs::file_type::directory &&
               type != fs::file_type::not_found) {
      refuse(params, "'" + beside.filename().string() + "' beside it " +
                         altiplan::formats::why_unreadable(beside.string()));
    }
  }
  if (unknown && unknown != std::errc::permission_denied) {
    refuse(params, "its folder cannot be read: " + unknown.message());
  }
  return files;
}

/// Larger files are read from the disk, so that a part of one costs no more than that part; but not
/// grids of text, of which GDAL reads all that comes before that part.
bool is_small(const std::vector<fs::path>& files) {
  if (gdal::is_text_grid(files.front())) {
    return true;
  }
  constexpr std::uintmax_t kMax = 16'000'000;
  std::uintmax_t bytes = 0;
  for (const fs::path& file : files) {
    bytes += fs::file_size(file);
  }
  return bytes <= kMax;
}

/// True for a sidecar of statistics alone, which programs leave beside models that they show.
bool holds_only_statistics(const fs::path& file) {
  constexpr std::array<std::string_view, 5> kKnown{"/", "PAMDataset>", "PAMRasterBand band=\"1\">",
                                                   "Metadata>", "MDI key=\"STATISTICS_"};
  bool knows_all = file.string().ends_with(".aux.xml");
  const std::string text = knows_all ? altiplan::formats::read_file(file.string()) : "";
  for (std::size_t at = 0; knows_all && (at = text.find('<', at)) != text.npos;) {
    const std::string_view element = std::string_view(text).substr(++at);
    knows_all = std::any_of(kKnown.begin(), kKnown.end(),
                            [&](std::string_view known) { return element.starts_with(known); });
  }
  return knows_all;
}

/// The model's file and those that belong to it.
std::vector<fs::path> look_up(const Params& params) {
  const std::string& file = params.file.text;
  if (file.rfind("/vsi", 0) == 0 || file.find("://") != std::string::npos ||
      file.find(":/") != std::string::npos) {
    refuse(params, "expected a file of this machine, found a URL or one of GDAL's virtual files");
  }
  if (const std::string why = altiplan::formats::why_unreadable(file); !why.empty()) {
    refuse(params, why);
  }
  return files_of(params);
}

gdal::Dataset open(const Params& params, const std::vector<fs::path>& files) {
  gdal::CloseDataset close;
  std::string name = params.file.text;
  if (is_small(files)) {
    close.files = std::make_shared<gdal::MemoryFiles>(files);
    name = close.files->name_of(files.front());
  }
  const char* const drivers[] = {"GTiff", "SRTMHGT", "AAIGrid", "DTED", "ENVI", nullptr};
  // In a grid of text whose first numbers are whole, GDAL would read "nan" as 0.
  const char* const as_reals[] = {"DATATYPE=Float32", nullptr};
  gdal::Dataset dataset(
      api().GDALOpenEx(name.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, drivers,
                       gdal::is_text_grid(files.front()) ? as_reals : nullptr, nullptr),
      std::move(close));
  if (!dataset) {
    refuse(
        params,
        "expected an elevation model (GeoTIFF, SRTM .hgt, DTED, ESRI ASCII grid, ENVI); " +
            std::string(altiplan::formats::ending_of(params.file.text) == ".hgt"
                            ? "SRTM tiles have 1201 x 1201 or 3601 x 3601 posts and are named by "
                              "their south-west corner, as N46E008.hgt; "
                            : "") +
            gdal::last_error());
  }
  return dataset;
}

void read_size(const Params& params, void* dataset, bool may_read_a_part, Dem& dem) {
  dem.columns = api().GDALGetRasterXSize(dataset);
  dem.rows = api().GDALGetRasterYSize(dataset);
  const std::string size = std::to_string(dem.columns) + " x " + std::to_string(dem.rows);
  if (dem.columns < 2 || dem.rows < 2) {
    refuse(params, "expected at least 2 x 2 posts, found " + size);
  }
  if (!may_read_a_part) {
    expect_few(params, dem, dem.whole());
  }
}

void* read_band(const Params& params, void* dataset) {
  const int bands = api().GDALGetRasterCount(dataset);
  if (bands != 1 && !params.band) {
    refuse(params,
           "has " + std::to_string(bands) + " bands; set band to the one that holds the heights",
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
  if (params.crs == "local") {
    if (OGRSpatialReferenceH own = api().GDALGetSpatialRef(dataset)) {
      refuse(params,
             std::string("has its own coordinate system (") + api().OSRGetName(own) +
                 "), but crs is local",
             "crs");
    }
    dem.local = true;
    dem.crs_name = "the world's metres";
    return;
  }
  gdal::Reference asked = params.crs.empty() ? nullptr : gdal::reference(params.crs);
  if (!params.crs.empty() && !asked) {
    const std::string said = gdal::last_error();
    const bool is_of_database = said.find("proj.db") != std::string::npos;
    refuse(params,
           "crs: expected EPSG: and a known code (EPSG:4326), found " + params.crs +
               (is_of_database ? ": " + said : ""),
           "crs");
  }
  if (OGRSpatialReferenceH own = api().GDALGetSpatialRef(dataset)) {
    dem.crs = gdal::copy(own);
    if (asked && !api().OSRIsSame(asked.get(), dem.crs.get())) {
      refuse(params,
             std::string("has its own coordinate system (") + api().OSRGetName(dem.crs.get()) +
                 "), but crs is " + params.crs,
             "crs");
    }
  } else if (asked) {
    dem.crs = std::move(asked);
  } else {
    refuse(params,
           "names no coordinate system; set crs to the one that it uses (crs: EPSG:4326 for "
           "longitude and latitude)",
           "crs");
  }
  dem.crs_name = api().OSRGetName(dem.crs.get());
  const char* code = api().OSRGetAuthorityCode(dem.crs.get(), nullptr);
  dem.crs_code = code != nullptr ? std::string("EPSG:") + code : "";
  dem.geographic = api().OSRIsGeographic(dem.crs.get()) != 0;
  if (!dem.geographic && !api().OSRIsProjected(dem.crs.get())) {
    refuse(params, "expected a geographic or projected coordinate system, found " + dem.crs_name,
           "crs");
  }
  dem.unit_m = dem.geographic ? 1 : api().OSRGetLinearUnits(dem.crs.get(), nullptr);
}

/// Refuses depths; heights above the ellipsoid are brought to sea level.
void read_datum(const Params& params, Dem& dem) {
  const char* name = api().OSRGetAttrValue(dem.crs.get(), "VERT_CS", 0);
  dem.datum = name != nullptr ? name : "";
  std::string words = dem.datum;
  std::transform(words.begin(), words.end(), words.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (words.find("depth") != std::string::npos) {
    refuse(params, "expected heights, found '" + dem.datum + "'");
  }
  dem.above_ellipsoid = words.find("ellips") != std::string::npos ||
                        (name == nullptr && api().OSRGetAxesCount(dem.crs.get()) == 3);
}

// Places the posts at the cells' centres; returns true if the file's rows run from the north.
bool read_position(const Params& params, void* dataset, Dem& dem) {
  double g[6];
  const bool known = api().GDALGetGeoTransform(dataset, g) == CE_None;
  if (!known ||
      (g[0] == 0 && g[1] == 1 && g[2] == 0 && g[3] == 0 && g[4] == 0 && std::abs(g[5]) == 1)) {
    refuse(params, "has no position on the Earth (no georeference)");
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
    refuse(params,
           "expected latitudes within -90 and 90 degrees, found " + number(dem.south_west[1]) +
               " to " + number(north),
           params.crs.empty() ? "file" : "crs");
  }
  return from_north;
}

double metres_per_unit(const Params& params, const Dem& dem) {
  std::string unit = api().GDALGetRasterUnitType(dem.band);
  if (unit.empty() && !dem.datum.empty()) {
    return api().OSRGetTargetLinearUnits(dem.crs.get(), "VERT_CS", nullptr);
  }
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), unit) != names.end();
  };
  constexpr double kSame = 1e-9;
  if (unit.empty() && std::abs(dem.unit_m - 1) > kSame) {
    refuse(params,
           "its coordinate system does not count in metres, and nothing says whether its heights "
           "do: name their unit in the file (gdal_edit.py -units ft, or m)");
  }
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

void read_meaning(const Params& params, Dem& dem) {
  if ((api().GDALGetMaskFlags(dem.band) & (GMF_ALL_VALID | GMF_NODATA)) == 0) {
    refuse(
        params,
        "marks posts without a height by a mask, which is not read: expected a number that marks "
        "them (nodata)");
  }
  int has_nodata = 0;
  int has_scale = 0;
  int has_offset = 0;
  const double nodata = api().GDALGetRasterNoDataValue(dem.band, &has_nodata);
  const double scale = api().GDALGetRasterScale(dem.band, &has_scale);
  const double offset = api().GDALGetRasterOffset(dem.band, &has_offset);
  dem.nodata = {has_nodata ? float(nodata) : NAN, params.nodata ? float(*params.nodata) : NAN};
  dem.scale = has_scale ? scale : 1;
  dem.offset = has_offset ? offset : 0;
  dem.unit = metres_per_unit(params, dem);
}
}  // namespace

void expect_few(const Params& params, const Dem& dem, const Part& part) {
  const auto size = [](std::int64_t columns, std::int64_t rows) {
    return std::to_string(columns) + " x " + std::to_string(rows);
  };
  const std::string declared = "declares " + size(dem.columns, dem.rows) + " posts, ";
  const std::string maximum = "more than max_posts (" + std::to_string(params.max_posts) + ")";
  if (std::int64_t(part.columns) * part.rows > params.max_posts) {
    const bool whole = part.columns == dem.columns && part.rows == dem.rows;
    refuse(params,
           declared + (whole ? "" : size(part.columns, part.rows) + " of them about the volume, ") +
               maximum,
           "max_posts");
  }
  if (dem.band != nullptr) {
    int columns = 0;
    int rows = 0;
    api().GDALGetBlockSize(dem.band, &columns, &rows);
    columns = std::min(columns, dem.columns);
    rows = std::min(rows, dem.rows);
    if (std::int64_t(columns) * rows > params.max_posts) {
      refuse(params, declared + "in blocks of " + size(columns, rows) + ", " + maximum,
             "max_posts");
    }
  }
}

Dem read_dem(const Params& params, bool may_read_a_part) try {
  const std::vector<fs::path> files = look_up(params);
  if (is_small(files) && std::all_of(files.begin() + 1, files.end(), holds_only_statistics)) {
    if (std::optional<Dem> plain = read_plain(params, files.front())) {
      plain->file = params.file;
      return std::move(*plain);
    }
  }
  const gdal::Quiet quiet;
  Dem dem;
  dem.file = params.file;
  dem.dataset = open(params, files);
  void* dataset = dem.dataset.get();
  read_size(params, dataset, may_read_a_part, dem);
  if (const std::string missing = missing_from(params.file.text, dataset); !missing.empty()) {
    refuse(params, "damaged: " + missing);
  }
  dem.band = read_band(params, dataset);
  read_crs(params, dataset, dem);
  if (!dem.local) {
    read_datum(params, dem);
  }
  dem.from_north = read_position(params, dataset, dem);
  read_meaning(params, dem);
  return dem;
} catch (const altiplan::formats::InputError& error) {
  throw altiplan::ParameterError("file", error.what());
} catch (const fs::filesystem_error& error) {
  throw altiplan::ParameterError(
      "file", error.path1().string() + ": cannot be read: " + error.code().message());
}
}  // namespace terrain
