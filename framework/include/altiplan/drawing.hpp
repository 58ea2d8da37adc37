// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "altiplan/shape.hpp"

namespace altiplan {

/// A solid of a layer, as viewers show it and mission files hold it.
struct Drawn {
  /// unknown: blocked because nobody knows what is there; a page hides it until it is asked for.
  enum class Role { obstacle, keep_out, keep_in, threat, unknown };
  Shape shape;
  Role role = Role::obstacle;
  std::string name;  ///< for the reader; "" where it has none
};

/// What a layer looks like beside its ground. For the eye: the layer's queries alone say what is
/// blocked.
struct Drawing {
  std::vector<Drawn> shapes;
  std::vector<std::array<Vec3, 3>> triangles;  ///< surfaces that are no shapes
};
}  // namespace altiplan
