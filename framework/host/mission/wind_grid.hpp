// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/frame.hpp"
#include "altiplan/wind.hpp"

namespace altiplan::host {

struct WindFile {
  std::shared_ptr<const WindGrid> grid;
  std::optional<double> valid_s;  ///< seconds since 1970-01-01 UTC, where the file says so
};

/// The wind of a file over a volume in a frame, by GDAL's programs. A file in longitudes and
/// latitudes is brought to the frame's metres: each cell has the wind of the file's cell at its
/// centre. `bands`: toward east and north, or none. Throws Error.
WindFile read_wind_grid(const std::string& file, const std::vector<int>& bands, const Frame& frame,
                        const Box& volume);
}  // namespace altiplan::host
