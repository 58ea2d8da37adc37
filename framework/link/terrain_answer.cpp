// SPDX-License-Identifier: Apache-2.0
#include "link/terrain_answer.hpp"

#include <cmath>
#include <limits>

namespace altiplan::link {
namespace {

constexpr int kTile = 4;     ///< heights along an edge of a block
constexpr int kColumns = 8;  ///< blocks to the east; bit 8 of the mask is the first to the north
constexpr int kRows = 7;
/// Metres of a degree of latitude, as autopilots convert them (a sphere of 6,378,100 m).
constexpr double kMetresOfDegree = 111'318.84502145034;

/// Ground at a distance from the request's south-western corner.
std::optional<std::int16_t> height_at(const TerrainRequest& request, const World& world, int north,
                                      int east) {
  const double lat = request.lat / 1e7 + north * request.grid_spacing / kMetresOfDegree;
  const double lon =
      request.lon / 1e7 + east * request.grid_spacing / (kMetresOfDegree * std::cos(radians(lat)));
  const auto [x, y] = world.frame().to_local(lon, lat);
  const std::optional<double> ground = world.ground(x, y);
  using Height = std::numeric_limits<std::int16_t>;
  if (!ground || *ground < Height::min() || *ground > Height::max()) {
    return std::nullopt;
  }
  return static_cast<std::int16_t>(std::lround(*ground));
}

std::optional<TerrainData> block(const TerrainRequest& request, const World& world, int bit) {
  TerrainData data;
  data.lat = request.lat;
  data.lon = request.lon;
  data.grid_spacing = request.grid_spacing;
  data.gridbit = static_cast<std::uint8_t>(bit);
  for (int i = 0; i < kTile * kTile; ++i) {
    const auto height = height_at(request, world, bit / kColumns * kTile + i / kTile,
                                  bit % kColumns * kTile + i % kTile);
    if (!height) {
      return std::nullopt;
    }
    data.data[static_cast<std::size_t>(i)] = *height;
  }
  return data;
}
}  // namespace

Messages terrain_answer(const TerrainRequest& request, const World& world) {
  Messages answer;
  for (int bit = 0; bit < kRows * kColumns && world.frame().has_position(); ++bit) {
    if ((request.mask >> bit & 1) != 0) {
      if (const std::optional<TerrainData> data = block(request, world, bit)) {
        answer.emplace_back(*data);
      }
    }
  }
  return answer;
}
}  // namespace altiplan::link
