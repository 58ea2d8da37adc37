// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/height_field.hpp"
#include "altiplan/params.hpp"
#include "gdal.hpp"

namespace terrain {

enum class Voids { refuse, fill_m, neighbours };

struct Params {
  altiplan::Path file;
  std::vector<altiplan::Path> tiles;
  Voids voids = Voids::refuse;
  std::optional<double> fill_m;
  std::optional<double> nodata;
  std::string crs;
  std::optional<int> band;
  std::int64_t max_posts = 100'000'000;

  void describe(altiplan::Fields& f) {
    f("file", file)
        .doc(
            "elevation model: GeoTIFF, SRTM .hgt, DTED, ESRI ASCII grid or ENVI; heights apply at "
            "the cells' centres")
        .required();
    f("tiles", tiles)
        .doc(
            "further files of the same grid, side by side with `file`: they are one model, closed "
            "where no tile lies");
    f("voids", voids,
      {{"refuse", Voids::refuse}, {"fill_m", Voids::fill_m}, {"neighbours", Voids::neighbours}})
        .doc(
            "posts without a height: reject the file (refuse), use the height fill_m (fill_m), "
            "or use the mean of their neighbours, inward from the void's border (neighbours)");
    f("fill_m", fill_m).unit("m").range(-1000, 10000).doc("height of voids, with voids: fill_m");
    f("nodata", nodata).doc("the number that marks a void, if the file does not declare it");
    f("crs", crs)
        .doc(
            "coordinate system (EPSG:4326) of a file that has none; local: its numbers are the "
            "world's "
            "metres");
    f("band", band).at_least(1).doc("band with the heights, for a file that has several");
    f("max_posts", max_posts)
        .at_least(4)
        .doc(
            "a file from which more posts are needed (all, or those around the volume) is rejected "
            "before anything is allocated");
    f.check((voids == Voids::fill_m) == fill_m.has_value(),
            voids == Voids::fill_m ? "voids: fill_m requires fill_m, the height of filled voids"
                                   : "fill_m, the height of voids, requires voids: fill_m");
  }
};

/// Lowest plausible ground of the Earth, with a margin; a number beyond it marks a void.
inline constexpr double kLowest = -1000;
inline constexpr double kHighest = 10000;

/// Range of a model's posts, its rows numbered from the south.
using Part = altiplan::HeightField::Part;

/// An elevation model as in its file: posts on a grid along the axes of its coordinate system.
/// Heights are read on demand (read_posts).
struct Dem {
  altiplan::Path file;
  std::vector<Dem> tiles;  ///< of which it consists, where it has several files
  Part place{};            ///< of a tile, in the model that it is part of
  int columns = 0;
  int rows = 0;
  std::array<double, 2> south_west;  ///< of the first post, in the system's own units
  std::array<double, 2> step;        ///< between posts, likewise
  gdal::Reference crs;               ///< null: longitude and latitude of WGS 84
  std::string crs_name;
  std::string crs_code;          ///< "EPSG:32632", "" if the file gives none
  std::string datum;             ///< of the heights: "EGM96 height", "" if the file names none
  bool above_ellipsoid = false;  ///< in the file: read_posts brings heights to sea level
  bool geographic = false;       ///< degrees; otherwise lengths of `unit_m`
  bool local = false;            ///< the world's metres, without a coordinate system
  double unit_m = 1;

  std::vector<float> numbers;     ///< of the whole file in its order, if they are read already
  gdal::Dataset dataset;          ///< null if they are
  void* band = nullptr;           ///< of the dataset
  bool from_north = true;         ///< order of the file's rows
  std::array<float, 2> nodata{};  ///< numbers that mark voids; NaN: none
  double scale = 1;               ///< metres = unit (scale number + offset)
  double offset = 0;
  double unit = 1;

  Part whole() const { return {0, 0, columns, rows}; }
};

/// Reads everything from a file except its heights. Throws altiplan::ParameterError, which names
/// the parameter at fault; too many posts are left to `expect_few` if a part of them may suffice.
Dem read_dem(const Params& params, bool may_read_a_part);

/// Throws altiplan::ParameterError if the part has more posts than params.max_posts, or if a block
/// of the file, which is decoded as a whole, does.
void expect_few(const Params& params, const Dem& dem, const Part& part);

/// Heights in metres, rows from the south, each from the west; voids are treated as requested.
struct Posts {
  Part part;
  std::vector<float> heights;
  std::size_t voids = 0;  ///< number of filled voids
};

/// Reads the part, or the whole model if voids in the part are rejected, or filled from their
/// surroundings. Throws altiplan::ParameterError likewise. One thread at a time.
Posts read_posts(const Params& params, const Dem& dem, const Part& part);

[[noreturn]] void refuse(const Params& params, const std::string& why, const char* key = "file");
std::string number(double value);
}  // namespace terrain
