// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "altiplan/shape.hpp"

namespace altiplan {

/// A solid of a layer, as shown by viewers and written to mission files.
struct Drawn {
  /// unknown: unobserved space, treated as blocked; the page hides it by default.
  enum class Role { obstacle, keep_out, keep_in, threat, unknown };
  Shape shape;
  Role role = Role::obstacle;
  std::string name;  ///< display name; "" where it has none
};

/// Appearance of a layer apart from its ground. For display only: the layer's queries alone define
/// what is blocked.
struct Drawing {
  std::vector<Drawn> shapes;
  std::vector<std::array<Vec3, 3>> triangles;  ///< surfaces other than shapes
  bool keeps_in_all = false;  ///< the vehicle must be in all keep_in shapes; else in one of them
};
}  // namespace altiplan
