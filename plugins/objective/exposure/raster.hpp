// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace exposure {

/// Values at the centres of a file's cells, in the file's own coordinates.
struct Raster {
  int columns = 0;
  int rows = 0;
  std::array<double, 2> south_west{0, 0};  ///< of the first centre
  std::array<double, 2> step{0, 0};        ///< between centres, positive
  std::vector<float> values;               ///< rows from the south, each from the west; NaN: none
  std::string crs;                         ///< "EPSG:4326"; "": the file names none
};

/// Most cells of a file.
inline constexpr std::size_t kMaxCells = 100'000'000;

/// An ESRI ASCII grid. Throws altiplan::Error without the file's name.
Raster read_text_grid(const std::string& file);

/// A GeoTIFF of one band. Throws likewise.
Raster read_tiff(const std::string& file);

/// Throws altiplan::Error, naming the cell, unless every value is at least 0 or none, and some is
/// a value.
void expect_costs(const Raster& raster);
}  // namespace exposure
