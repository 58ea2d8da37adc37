// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

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
        .doc("a file that declares more posts is refused before anything is allocated");
    f.check((voids == Voids::fill_m) == fill_m.has_value(),
            voids == Voids::fill_m ? "voids: fill_m needs fill_m, the height that voids get"
                                   : "fill_m is the height of voids: it needs voids: fill_m");
  }
};

/// An elevation model as its file has it: posts on a grid along the axes of its coordinate system.
struct Dem {
  int columns = 0;
  int rows = 0;
  std::vector<float> heights;        ///< metres; rows from the south, each from the west
  std::array<double, 2> south_west;  ///< of the first post, in the system's own units
  std::array<double, 2> step;        ///< between posts, likewise
  gdal::Reference crs;
  std::string crs_name;
  bool geographic = false;  ///< degrees; otherwise lengths of `unit_m`
  double unit_m = 1;
  std::size_t voids = 0;  ///< that were filled
};

/// Throws altiplan::ParameterError, which names the parameter to blame.
Dem read_dem(const Params& params);
}  // namespace terrain
