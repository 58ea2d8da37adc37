// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/environment.hpp"
#include "altiplan/kit/layers/scalar_field.hpp"
#include "price.hpp"

namespace exposure {

/// A field of the world, or of a layer, asked at the corners of cells over the volume.
struct Sampled {
  std::string layer;
  std::string of;
  altiplan::Vec3 cell_m{50, 50, 10};

  /// Throws ParameterError.
  altiplan::kit::ScalarField field(const altiplan::Site& site, const Price& price,
                                   double elsewhere) const;
};
}  // namespace exposure
