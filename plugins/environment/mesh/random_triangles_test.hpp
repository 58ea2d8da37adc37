// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/random.hpp"
#include "triangles.hpp"

namespace altiplan::mesh {

inline const Box kAround{{-1, -1, -1}, {1, 1, 1}};

/// Triangles, some of them thin, some degenerate to a segment, some flat along the axes.
inline Triangle triangle(RandomStream& random, int kind) {
  Triangle t{random.in(kAround), random.in(kAround), random.in(kAround)};
  if (kind % 5 == 1) {
    t[2] = t[0] + 0.3 * (t[1] - t[0]);
  } else if (kind % 5 == 2) {
    t[2] = t[0] + 1e-7 * (t[2] - t[0]);
  } else if (kind % 5 == 3) {
    for (Vec3& corner : t) {
      corner = (4 * corner).array().round() / 4;
    }
  }
  return t;
}

}  // namespace altiplan::mesh
