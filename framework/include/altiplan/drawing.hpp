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

/// The name of the part that holds the place or is nearest to it, "" if it has none. Of keep-in
/// shapes one of which must hold the place it is the one that the place is deepest in, as far as
/// its border; where all must, the one whose border is nearest, or that it is farthest out of.
ALTIPLAN_API std::string name_at(const Drawing& drawing, const Vec3& p);
}  // namespace altiplan
