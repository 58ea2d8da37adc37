// SPDX-License-Identifier: Apache-2.0
#include "plain.hpp"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>

#include "altiplan/formats/input_file.hpp"

namespace terrain {
namespace fs = std::filesystem;
namespace {

Dem of_wgs84(int columns, int rows) {
  Dem dem;
  dem.columns = columns;
  dem.rows = rows;
  dem.crs_name = "WGS 84";
  dem.crs_code = "EPSG:4326";
  dem.geographic = true;
  return dem;
}

/// Posts at the centres of cells whose north-west corner is given.
void place(Dem& dem, double west, double north, double width, double height) {
  dem.step = {width, height};
  dem.south_west = {west + 0.5 * width, north + (dem.rows - 0.5) * -height};
}

bool is_on_the_earth(const Dem& dem) {
  const double north = dem.south_west[1] + (dem.rows - 1) * dem.step[1];
  return dem.columns >= 2 && dem.rows >= 2 && dem.step[0] > 0 && dem.step[1] > 0 &&
         (dem.columns - 1) * dem.step[0] <= 360 && std::abs(dem.south_west[0]) <= 360 &&
         dem.south_west[1] >= -90 && north <= 90;
}

bool fits(const Params& params, std::int64_t columns, std::int64_t rows) {
  return columns >= 2 && rows >= 2 && columns * rows <= params.max_posts;
}

/// "N46E008.hgt": degrees of the south-western post.
std::optional<std::array<int, 2>> corner_of(const std::string& name) {
  constexpr std::size_t kLength = 11;
  std::array<int, 2> lonlat{};
  const auto number = [&](std::size_t at, std::size_t digits, int& value) {
    const char* end = name.data() + at + digits;
    return std::from_chars(name.data() + at, end, value).ptr == end;
  };
  if (name.size() != kLength || (name[0] != 'N' && name[0] != 'S') ||
      (name[3] != 'E' && name[3] != 'W') || !number(1, 2, lonlat[1]) || !number(4, 3, lonlat[0]) ||
      name.substr(7) != ".hgt") {
    return {};
  }
  return std::array<int, 2>{name[3] == 'W' ? -lonlat[0] : lonlat[0],
                            name[0] == 'S' ? -lonlat[1] : lonlat[1]};
}

/// SRTM: big-endian whole metres, rows from the north, posts on the degrees themselves.
std::optional<Dem> read_hgt(const Params& params, const fs::path& file) {
  const auto corner = corner_of(file.filename().string());
  const std::string bytes = altiplan::formats::read_file(file.string());
  int posts = 0;
  for (const int side : {1201, 3601}) {
    posts = bytes.size() == 2 * std::size_t(side) * std::size_t(side) ? side : posts;
  }
  if (!corner || !fits(params, posts, posts)) {
    return {};
  }
  Dem dem = of_wgs84(posts, posts);
  const double step = 1.0 / (posts - 1);
  place(dem, (*corner)[0] - 0.5 / (posts - 1), (*corner)[1] + 1 + 0.5 / (posts - 1), step, step);
  dem.nodata = {-32768, NAN};
  dem.numbers.reserve(bytes.size() / 2);
  for (std::size_t k = 0; k < bytes.size(); k += 2) {
    const auto high = std::uint16_t(static_cast<unsigned char>(bytes[k]));
    const auto low = std::uint16_t(static_cast<unsigned char>(bytes[k + 1]));
    dem.numbers.push_back(float(std::int16_t(high << 8 | low)));
  }
  return dem;
}

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

/// Null if it is none; never says anything.
Tiff open(const fs::path& file) {
  const auto be_silent = [](TIFF*, void*, const char*, const char*, va_list) { return 1; };
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), be_silent, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), be_silent, nullptr);
  return Tiff(TIFFOpenExt(file.c_str(), "r", options.get()));
}

template <typename T>
T tag(TIFF* tiff, std::uint32_t name, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, name, &value) == 1 ? value : otherwise;
}

/// Elements of a tag that libtiff itself does not know. GDAL, once opened, registers some of them
/// in ways of its own: the field says how its elements are counted.
template <typename T>
std::vector<T> tags(TIFF* tiff, std::uint32_t name) {
  const TIFFField* field = TIFFFindField(tiff, name, TIFF_ANY);
  const T* values = nullptr;
  std::uint32_t count = 0;
  std::uint16_t short_count = 0;
  if (field == nullptr) {
    return {};
  }
  if (TIFFFieldPassCount(field) == 0) {  // a text
    const bool found = TIFFGetField(tiff, name, &values) == 1 && sizeof(T) == 1;
    count = found ? std::uint32_t(std::strlen(reinterpret_cast<const char*>(values))) : 0;
  } else if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
    TIFFGetField(tiff, name, &count, &values);
  } else if (TIFFGetField(tiff, name, &short_count, &values) == 1) {
    count = short_count;
  }
  return values == nullptr ? std::vector<T>{} : std::vector<T>(values, values + count);
}

std::string text(TIFF* tiff, std::uint32_t name) {
  const auto letters = tags<char>(tiff, name);
  return {letters.begin(), std::find(letters.begin(), letters.end(), '\0')};
}

/// The GeoTIFF keys (OGC 19-008r4, section 7) that stand for EPSG:4326 alone, with the raster's
/// kind: true where posts are points, so that cells lie half a step about them.
std::optional<bool> are_points(TIFF* tiff) {
  constexpr std::uint32_t kDirectory = 34735;
  enum Key { model_type = 1024, raster_type = 1025, citation = 1026, geographic_type = 2048 };
  enum { geog_citation = 2049, angular_units = 2054, major_axis = 2057, flattening = 2059 };
  const auto keys = tags<std::uint16_t>(tiff, kDirectory);
  bool points = false;
  int wgs84 = 0;
  if (keys.size() < 4 || keys.size() < 4 + 4 * std::size_t(keys[3])) {
    return {};
  }
  for (std::size_t k = 4; k < 4 + 4 * std::size_t(keys[3]); k += 4) {
    const std::uint16_t value = keys[k + 3];
    switch (keys[k]) {
      case model_type:
        wgs84 += value == 2 ? 1 : 0;
        break;
      case geographic_type:
        wgs84 += value == 4326 ? 1 : 0;
        break;
      case raster_type:
        points = value == 2;
        break;
      case angular_units:
        wgs84 -= value == 9102 ? 0 : 1;  // degrees
        break;
      case citation:
      case geog_citation:
      case major_axis:
      case flattening:
        break;  // what the code says in other words
      default:
        return {};
    }
  }
  return wgs84 == 2 ? std::optional(points) : std::nullopt;
}

/// True if the file's metadata leave its numbers metres.
bool are_metres(const std::string& metadata) {
  constexpr std::string_view kRole = "role=\"";
  for (std::size_t at = 0; (at = metadata.find(kRole, at)) != std::string::npos; ++at) {
    if (!metadata.substr(at + kRole.size()).starts_with("unittype\">m<")) {
      return false;
    }
  }
  return true;
}

std::optional<float> nodata_of(const std::string& word) {
  double value = NAN;
  const char* end = word.data() + word.size();
  return word.empty() || std::from_chars(word.data(), end, value).ptr == end
             ? std::optional(float(value))
             : std::nullopt;
}

std::optional<Dem> header_of(const Params& params, TIFF* tiff) {
  enum { pixel_scale = 33550, tie_point = 33922, transformation = 34264 };
  enum { gdal_metadata = 42112, gdal_nodata = 42113 };
  const auto columns = tag<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  const auto rows = tag<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  const auto scale = tags<double>(tiff, pixel_scale);
  const auto tie = tags<double>(tiff, tie_point);
  const auto points = are_points(tiff);
  const auto nodata = nodata_of(text(tiff, gdal_nodata));
  if (!fits(params, columns, rows) || scale.size() < 2 || tie.size() != 6 || tie[0] != 0 ||
      tie[1] != 0 || !tags<double>(tiff, transformation).empty() || !points || !nodata ||
      !are_metres(text(tiff, gdal_metadata)) ||
      tag<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) != 1 ||
      tag<std::uint16_t>(tiff, TIFFTAG_ORIENTATION, 0) != ORIENTATION_TOPLEFT ||
      tag<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, 0) != PHOTOMETRIC_MINISBLACK ||
      TIFFLastDirectory(tiff) == 0) {
    return {};
  }
  Dem dem = of_wgs84(int(columns), int(rows));
  const double half = *points ? 0.5 : 0;
  place(dem, tie[3] - scale[0] * half, tie[4] + scale[1] * half, scale[0], scale[1]);
  dem.nodata = {*nodata, NAN};
  return dem;
}

/// One of the file's blocks, a strip of whole rows or a tile, into the numbers.
template <typename T>
void take(const std::vector<T>& block, int x0, int y0, int width, int height, Dem& dem) {
  for (int y = y0; y < std::min(y0 + height, dem.rows); ++y) {
    const T* from = block.data() + std::size_t(y - y0) * std::size_t(width);
    std::copy_n(from, std::min(width, dem.columns - x0),
                dem.numbers.begin() + std::ptrdiff_t(y) * dem.columns + x0);
  }
}

/// False if a block is missing or damaged.
template <typename T>
bool read_numbers(TIFF* tiff, Dem& dem) {
  const bool tiled = TIFFIsTiled(tiff) != 0;
  const auto side = [&](std::uint32_t name, int whole) {
    return int(std::min<std::int64_t>(tag<std::uint32_t>(tiff, name, std::uint32_t(whole)), whole));
  };
  // Tiles are stored whole, also where they go beyond the model.
  const int width = tiled ? int(tag<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0)) : dem.columns;
  const int height = tiled ? int(tag<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0))
                           : side(TIFFTAG_ROWSPERSTRIP, dem.rows);
  const tmsize_t bytes = tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  constexpr tmsize_t kMost = 1 << 28;
  if (width <= 0 || height <= 0 || bytes <= 0 || bytes > kMost ||
      std::size_t(bytes) != std::size_t(width) * std::size_t(height) * sizeof(T)) {
    return false;
  }
  std::vector<T> block(std::size_t(bytes) / sizeof(T));
  dem.numbers.resize(std::size_t(dem.columns) * std::size_t(dem.rows));
  std::uint32_t number = 0;
  for (int y = 0; y < dem.rows; y += height) {
    for (int x = 0; x < dem.columns; x += width, ++number) {
      const tmsize_t rows = tiled ? height : std::min(height, dem.rows - y);
      const tmsize_t wanted = rows * width * tmsize_t(sizeof(T));
      const tmsize_t got = tiled ? TIFFReadEncodedTile(tiff, number, block.data(), wanted)
                                 : TIFFReadEncodedStrip(tiff, number, block.data(), wanted);
      if (got != wanted) {
        return false;
      }
      take(block, x, y, width, height, dem);
    }
  }
  return true;
}

std::optional<Dem> read_tiff(const Params& params, const fs::path& file) {
  const Tiff tiff = open(file);
  std::optional<Dem> dem = tiff ? header_of(params, tiff.get()) : std::nullopt;
  if (!dem) {
    return {};
  }
  const auto format = tag<std::uint16_t>(tiff.get(), TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const auto bits = tag<std::uint16_t>(tiff.get(), TIFFTAG_BITSPERSAMPLE, 1);
  bool whole = false;
  if (format == SAMPLEFORMAT_INT && bits == 16) {
    whole = read_numbers<std::int16_t>(tiff.get(), *dem);
  } else if (format == SAMPLEFORMAT_UINT && bits == 16) {
    whole = read_numbers<std::uint16_t>(tiff.get(), *dem);
  } else if (format == SAMPLEFORMAT_IEEEFP && bits == 32) {
    whole = read_numbers<float>(tiff.get(), *dem);
  }
  return whole ? std::move(dem) : std::nullopt;
}
}  // namespace

std::optional<Dem> read_plain(const Params& params, const fs::path& file) {
  std::optional<Dem> dem;
  if (params.band.value_or(1) != 1 || (!params.crs.empty() && params.crs != "EPSG:4326")) {
    return {};
  }
  const std::string kind = file.extension().string();
  if (kind == ".hgt") {
    dem = read_hgt(params, file);
  } else if (kind == ".tif" || kind == ".tiff") {
    dem = read_tiff(params, file);
  }
  if (!dem || !is_on_the_earth(*dem)) {
    return {};
  }
  dem->nodata[1] = params.nodata ? float(*params.nodata) : NAN;
  return dem;
}
}  // namespace terrain
