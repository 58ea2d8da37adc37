// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "dem.hpp"

namespace terrain {

/// A small model of the commonest kinds, without GDAL, whose loading takes longer than most plans:
/// SRTM .hgt, and GeoTIFF in longitude and latitude (WGS 84) with one band of heights in metres.
/// Empty for every other file, also for a damaged one: GDAL reads it, or says what is wrong. What
/// is read is the same to the bit.
std::optional<Dem> read_plain(const Params& params, const std::filesystem::path& file);
}  // namespace terrain
