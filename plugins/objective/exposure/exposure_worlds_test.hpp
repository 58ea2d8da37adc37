// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "altiplan/random.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::exposure_test {

/// A grid of values as a test sees it, and as a file.
struct Values {
  int columns = 8;
  int rows = 7;
  double step = 20;
  Vec3 south_west{-10, -15, 0};  ///< of the first centre
  std::vector<double> values{};  ///< rows from the south; NaN: none

  double at(int i, int j) const { return values[std::size_t(j * columns + i)]; }
  std::string text() const {
    std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                       "\nxllcenter " + std::to_string(south_west.x()) + "\nyllcenter " +
                       std::to_string(south_west.y()) + "\ncellsize " + std::to_string(step) +
                       "\nNODATA_value -9\n";
    for (int j = rows - 1; j >= 0; --j) {
      for (int i = 0; i < columns; ++i) {
        text += (std::isnan(at(i, j)) ? "-9" : std::to_string(at(i, j))) + " ";
      }
      text += "\n";
    }
    return text;
  }
};

/// Halves, so that the file holds them exactly; zeros among them, and voids where asked.
inline Values random_values(SplitMix64& random, bool voids) {
  Values values;
  for (int n = 0; n < values.columns * values.rows; ++n) {
    const double value = std::floor(random.uniform() * 20) / 2 * (random.uniform() < 0.8);
    values.values.push_back(voids && random.uniform() < 0.1 ? NAN : value);
  }
  return values;
}

/// The objective of a file with these values.
inline std::shared_ptr<const Objective> objective_of(const Values& values,
                                                     const std::string& more = "") {
  const testing::TempFolder folder;
  const std::string file = folder.write("field.asc", values.text()).string();
  return testing::make_objective("exposure", "{file: '" + file + "'" + more + "}");
}
}  // namespace altiplan::exposure_test
