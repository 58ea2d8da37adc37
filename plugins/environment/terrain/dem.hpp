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
  Voids voids = Voids::refuse;
  std::optional<double> fill_m;
  std::optional<double> nodata;
  std::string crs;
  std::optional<int> band;
  std::int64_t max_posts = 100'000'000;

  void describe(altiplan::Fields& f) {
    f("file", file)
        .doc(
            "elevation model: GeoTIFF, SRTM .hgt, DTED, ESRI ASCII grid or ENVI; a cell's height "
            "stands at its centre")
        .required();
    f("voids", voids,
      {{"refuse", Voids::refuse}, {"fill_m", Voids::fill_m}, {"neighbours", Voids::neighbours}})
        .doc(
            "posts without a height: the file is refused, they get the height fill_m, or the mean "
            "of their neighbours, inward from the void's border");
    f("fill_m", fill_m).unit("m").range(-1000, 10000).doc("height of voids, with voids: fill_m");
    f("nodata", nodata).doc("the number that marks a void, where the file does not say it");
    f("crs", crs).doc("coordinate system (EPSG:4326) of a file that has none");
    f("band", band).at_least(1).doc("which band holds the heights, for a file that has several");
    f("max_posts", max_posts)
        .at_least(4)
        .doc(
            "a file of which more posts are needed (all, or those about the volume) is refused "
            "before anything is allocated");
    f.check((voids == Voids::fill_m) == fill_m.has_value(),
            voids == Voids::fill_m ? "voids: fill_m needs fill_m, the height that voids get"
                                   : "fill_m is the height of voids: it needs voids: fill_m");
  }
};

/// What the ground of the Earth can be, with room to spare; beyond it a number marks a void.
inline constexpr double kLowest = -1000;
inline constexpr double kHighest = 10000;

/// Which posts of a model, its rows counted from the south.
using Part = altiplan::HeightField::Part;

/// An elevation model as its file has it: posts on a grid along the axes of its coordinate system.
/// Their heights are read where they are asked for (read_posts).
struct Dem {
  int columns = 0;
  int rows = 0;
  std::array<double, 2> south_west;  ///< of the first post, in the system's own units
  std::array<double, 2> step;        ///< between posts, likewise
  gdal::Reference crs;
  std::string crs_name;
  bool geographic = false;  ///< degrees; otherwise lengths of `unit_m`
  double unit_m = 1;

  gdal::Dataset dataset;
  void* band = nullptr;           ///< of the dataset
  bool from_north = true;         ///< the file's rows
  std::array<float, 2> nodata{};  ///< numbers that mark voids; NaN: none
  double scale = 1;               ///< metres = unit (scale number + offset)
  double offset = 0;
  double unit = 1;

  Part whole() const { return {0, 0, columns, rows}; }
};

/// All of a file but its heights. Throws altiplan::ParameterError, which names the parameter to
/// blame; too many posts are left to `expect_few` where a part of them may do.
Dem read_dem(const Params& params, bool may_read_a_part);

/// Throws altiplan::ParameterError where the part has more posts than params.max_posts, or a block
/// of the file, which is decoded as a whole, has.
void expect_few(const Params& params, const Dem& dem, const Part& part);

/// Heights in metres, rows from the south, each from the west; voids are treated as asked for.
struct Posts {
  Part part;
  std::vector<float> heights;
  std::size_t voids = 0;  ///< that were filled
};

/// The part, or the whole model where voids in the part are refused, or filled by what lies around
/// them. Throws altiplan::ParameterError likewise. One thread at a time.
Posts read_posts(const Params& params, const Dem& dem, const Part& part);

[[noreturn]] void refuse(const Params& params, const std::string& why, const char* key = "file");
std::string number(double value);
}  // namespace terrain
