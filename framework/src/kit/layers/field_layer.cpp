// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/field_layer.hpp"

#include "altiplan/error.hpp"

namespace altiplan::kit {

WholeField::WholeField(HeightField field) : field_(std::move(field)) {
  if (field_.void_posts() > 0) {
    throw Error("expected a height at each post, found " + std::to_string(field_.void_posts()) +
                " without one");
  }
  const auto& [x, y] = field_.origin();
  const auto& [dx, dy] = field_.spacing();
  bounds_ = {{x, y, -kInfinity},
             {x + (field_.columns() - 1) * dx, y + (field_.rows() - 1) * dy, kInfinity}};
}
}  // namespace altiplan::kit
