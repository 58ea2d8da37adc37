// SPDX-License-Identifier: Apache-2.0
// GeoTIFF: one band of numbers on a grid along the axes of a coordinate system (OGC 19-008r4).
#include <tiffio.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "raster.hpp"

namespace exposure {
namespace {
using altiplan::Error;

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

Tiff open(const std::string& file) {
  if (const std::string why = altiplan::formats::why_unreadable(file); !why.empty()) {
    throw Error(why);
  }
  const auto be_silent = [](TIFF*, void*, const char*, const char*, va_list) { return 1; };
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), be_silent, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), be_silent, nullptr);
  Tiff tiff(TIFFOpenExt(file.c_str(), "r", options.get()));
  if (!tiff) {
    throw Error("is no TIFF file, or a damaged one");
  }
  return tiff;
}

template <typename T>
T tag(TIFF* tiff, std::uint32_t name, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, name, &value) == 1 ? value : otherwise;
}

/// Elements of a tag that libtiff itself does not know; another library may have registered it.
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
    count =
        found ? std::uint32_t(std::char_traits<char>::length(reinterpret_cast<const char*>(values)))
              : 0;
  } else if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
    TIFFGetField(tiff, name, &count, &values);
  } else if (TIFFGetField(tiff, name, &short_count, &values) == 1) {
    count = short_count;
  }
  return values == nullptr ? std::vector<T>{} : std::vector<T>(values, values + count);
}

/// The values that stand for none, by GDAL's tag.
double nodata_of(TIFF* tiff) {
  constexpr std::uint32_t kNodata = 42113;
  const std::vector<char> letters = tags<char>(tiff, kNodata);
  double value = NAN;
  std::from_chars(letters.data(), letters.data() + letters.size(), value);
  return value;
}

/// True of GDAL's metadata with a factor or a summand for the values.
bool is_scaled(TIFF* tiff) {
  constexpr std::uint32_t kMetadata = 42112;
  const std::vector<char> letters = tags<char>(tiff, kMetadata);
  const std::string text(letters.begin(), letters.end());
  return text.find("role=\"scale\"") != text.npos || text.find("role=\"offset\"") != text.npos;
}

/// Of the keys: the coordinate system, and whether values belong to points of it.
void read_keys(TIFF* tiff, Raster& raster, bool& points) {
  constexpr std::uint32_t kDirectory = 34735;
  enum Key { model_type = 1024, raster_type = 1025, geographic_type = 2048, projected_type = 3072 };
  constexpr std::uint16_t kOwn = 32767;  // defined by further keys
  const auto keys = tags<std::uint16_t>(tiff, kDirectory);
  bool has_system = false;
  for (std::size_t k = 4; k + 3 < keys.size(); k += 4) {
    const std::uint16_t value = keys[k + 3];
    if (keys[k] == raster_type) {
      points = value == 2;
    } else if (keys[k] == model_type) {
      has_system = value == 1 || value == 2 || value == 3;  // projected, geographic, geocentric
    } else if (keys[k] == projected_type || (keys[k] == geographic_type && raster.crs.empty())) {
      has_system = true;
      raster.crs = value == kOwn ? "" : "EPSG:" + std::to_string(value);
    }
  }
  if (has_system && raster.crs.empty()) {
    throw Error("its coordinate system is none of EPSG's: warp it to one (gdalwarp -t_srs)");
  }
}

template <typename T>
void read_values(TIFF* tiff, Raster& raster) {
  const bool tiled = TIFFIsTiled(tiff) != 0;
  // Tiles are stored whole, also where they go beyond the raster.
  const int width = tiled ? int(tag<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0)) : raster.columns;
  const int height =
      tiled ? int(tag<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0))
            : int(std::min<std::int64_t>(tag<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, 1U << 31),
                                         raster.rows));
  const tmsize_t bytes = tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  constexpr tmsize_t kMost = 1 << 30;
  if (width <= 0 || height <= 0 || bytes > kMost ||
      std::uint64_t(bytes) != std::uint64_t(width) * std::uint64_t(height) * sizeof(T)) {
    throw Error("its blocks do not fit its size: it is damaged");
  }
  std::vector<T> block(std::size_t(bytes) / sizeof(T));
  const double none = nodata_of(tiff);
  raster.values.resize(std::size_t(raster.columns) * std::size_t(raster.rows));
  std::uint32_t number = 0;
  for (int y = 0; y < raster.rows; y += height) {
    for (int x = 0; x < raster.columns; x += width, ++number) {
      const tmsize_t rows = tiled ? height : std::min(height, raster.rows - y);
      const tmsize_t wanted = rows * width * tmsize_t(sizeof(T));
      const tmsize_t got = tiled ? TIFFReadEncodedTile(tiff, number, block.data(), wanted)
                                 : TIFFReadEncodedStrip(tiff, number, block.data(), wanted);
      if (got != wanted) {
        throw Error("block " + std::to_string(number) +
                    " is damaged, or compressed in a way that "
                    "libtiff does not know");
      }
      for (int j = y; j < std::min(y + height, raster.rows); ++j) {
        for (int i = x; i < std::min(x + width, raster.columns); ++i) {
          const T value = block[std::size_t(j - y) * std::size_t(width) + std::size_t(i - x)];
          raster.values[std::size_t(raster.rows - 1 - j) * std::size_t(raster.columns) +
                        std::size_t(i)] = double(value) == none ? NAN : float(value);
        }
      }
    }
  }
}

void read_any_values(TIFF* tiff, Raster& raster) {
  const auto format = tag<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const auto bits = tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  const auto is = [&](std::uint16_t its, std::uint16_t size) {
    return format == its && bits == size;
  };
  if (is(SAMPLEFORMAT_IEEEFP, 32)) {
    read_values<float>(tiff, raster);
  } else if (is(SAMPLEFORMAT_IEEEFP, 64)) {
    read_values<double>(tiff, raster);
  } else if (is(SAMPLEFORMAT_UINT, 8)) {
    read_values<std::uint8_t>(tiff, raster);
  } else if (is(SAMPLEFORMAT_UINT, 16)) {
    read_values<std::uint16_t>(tiff, raster);
  } else if (is(SAMPLEFORMAT_INT, 16)) {
    read_values<std::int16_t>(tiff, raster);
  } else if (is(SAMPLEFORMAT_UINT, 32)) {
    read_values<std::uint32_t>(tiff, raster);
  } else if (is(SAMPLEFORMAT_INT, 32)) {
    read_values<std::int32_t>(tiff, raster);
  } else {
    throw Error("its numbers have " + std::to_string(bits) +
                " bits in a format that is not read: expected floats of 32 or 64 bits, or whole "
                "numbers of 8, 16 or 32");
  }
}
}  // namespace

Raster read_tiff(const std::string& file) {
  enum { pixel_scale = 33550, tie_point = 33922 };
  const Tiff tiff = open(file);
  Raster raster;
  const auto columns = tag<std::uint32_t>(tiff.get(), TIFFTAG_IMAGEWIDTH, 0);
  const auto rows = tag<std::uint32_t>(tiff.get(), TIFFTAG_IMAGELENGTH, 0);
  if (columns < 2 || rows < 2 || std::uint64_t(columns) * rows > kMaxCells) {
    throw Error("has " + std::to_string(columns) + " x " + std::to_string(rows) +
                " cells, expected at least 2 x 2 and at most " + std::to_string(kMaxCells));
  }
  if (tag<std::uint16_t>(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 1) != 1) {
    throw Error("has several bands, expected one");
  }
  if (is_scaled(tiff.get())) {
    throw Error("has values with a scale or an offset: gdal_translate -unscale writes plain ones");
  }
  const auto scale = tags<double>(tiff.get(), pixel_scale);
  const auto tie = tags<double>(tiff.get(), tie_point);
  bool points = false;
  read_keys(tiff.get(), raster, points);
  if (scale.size() < 2 || !(scale[0] > 0 && scale[1] > 0) || tie.size() != 6 || tie[0] != 0 ||
      tie[1] != 0) {
    throw Error(
        "has no georeference of a corner and a cell size (rotated rasters are not read): gdalwarp "
        "writes one");
  }
  raster.columns = int(columns);
  raster.rows = int(rows);
  raster.step = {scale[0], scale[1]};
  const double half = points ? 0 : 0.5;
  raster.south_west = {tie[3] + half * scale[0], tie[4] - (rows - 1 + half) * scale[1]};
  read_any_values(tiff.get(), raster);
  return raster;
}
}  // namespace exposure
