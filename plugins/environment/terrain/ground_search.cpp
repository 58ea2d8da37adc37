// SPDX-License-Identifier: Apache-2.0
#include "ground_search.hpp"

#include "altiplan/kit/layers/field_within.hpp"

namespace terrain {

bool is_within(const altiplan::HeightField& field, const altiplan::Vec3& a, const altiplan::Vec3& b,
               double distance) {
  altiplan::kit::GroundWithin ground(a, b, distance);
  altiplan::kit::search_field(ground, field);
  return ground.found();
}
}  // namespace terrain
