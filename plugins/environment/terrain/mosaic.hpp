// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dem.hpp"

namespace terrain {

/// The model of params.file and params.tiles. Throws altiplan::ParameterError as read_dem does, and
/// where the tiles are not of one grid.
Dem read_mosaic(const Params& params, bool may_read_a_part);

/// The posts of a model that has tiles, as read_posts gives them.
Posts read_tiles(const Params& params, const Dem& dem, const Part& part);
}  // namespace terrain
