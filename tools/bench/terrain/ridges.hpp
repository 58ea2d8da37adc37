// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "altiplan/environment.hpp"
#include "altiplan/height_field.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::bench {

/// A layer with ground, and the elevation model that it holds.
struct Relief {
  std::shared_ptr<const Environment> layer;
  const HeightField* field;
};

/// Sharp ridges of all sizes and directions on a square of that side, with posts 25 m apart, and
/// mountain ranges across it, whose passes lie in the north and the south by turns.
Relief ridges(double side_m, std::uint64_t seed, int barriers);
/// The ground of an elevation model, as the layer `terrain` reads it.
Relief relief_of(host::Registry& registry, const std::string& file);
/// The same ground with a shut ring of cliffs up to `top_m` around a place.
Relief with_cliffs(const HeightField& field, const Vec3& middle, double radius_m, double top_m);

/// The height below which that share of the posts lies; voids do not count.
double height_quantile(const HeightField& field, double share);
/// The lowest post within `reach_m` of a place on each axis.
Vec3 lowest_post(const HeightField& field, const Vec3& about, double reach_m);
}  // namespace altiplan::bench
