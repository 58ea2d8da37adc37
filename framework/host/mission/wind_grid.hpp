// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "altiplan/frame.hpp"
#include "altiplan/wind.hpp"

namespace altiplan::host {

/// The wind of a file over a volume in a frame, by GDAL's programs. A file in longitudes and
/// latitudes is brought to the frame's metres: each cell has the wind of the file's cell at its
/// centre. `bands`: toward east and north, or none. Throws Error.
std::shared_ptr<const WindGrid> read_wind_grid(const std::string& file,
                                               const std::vector<int>& bands, const Frame& frame,
                                               const Box& volume);
}  // namespace altiplan::host
