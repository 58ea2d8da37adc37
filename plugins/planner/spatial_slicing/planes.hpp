// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "altiplan/kit/lattice/lattice.hpp"

namespace altiplan::slicing {

/// The planes between start and goal, numbered from the start.
struct Planes {
  int axis = 0;   ///< they are perpendicular to it
  int first = 0;  ///< cell of plane 0 on that axis
  int step = 1;   ///< cells from one plane to the next, toward the goal
  int count = 0;

  /// Through every `apart`-th cell centre between the two.
  Planes(const Request& request, const kit::Lattice& lattice, int upright_to, int apart)
      : axis(upright_to) {
    const GridSpec& spec = lattice.spec();
    const Vec3& start = request.start.position;
    const Vec3& goal = request.goal.position;
    const int sign = goal[axis] < start[axis] ? -1 : 1;
    // In cells toward the goal.
    const auto place = [&](const Vec3& p) {
      return sign * ((p[axis] - spec.origin[axis]) / spec.cell[axis] - 0.5);
    };
    const double rounding = kLengthTolerance / spec.cell[axis];
    const int end = spec.counts[std::size_t(axis)] - 1;
    const double lowest = sign > 0 ? 0 : -end;
    const double after_start = std::floor(place(start) + rounding) + 1;
    const double before_goal = std::ceil(place(goal) - rounding) - 1;
    const int low = int(std::clamp(after_start, lowest, lowest + end + 1));
    const int high = int(std::clamp(before_goal, lowest - 1, lowest + end));
    step = sign * apart;
    first = sign * low + step - sign;
    count = std::max(0, high - low + 1) / apart;
  }
  int cell(int plane) const { return first + plane * step; }
};
}  // namespace altiplan::slicing
