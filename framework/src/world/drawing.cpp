// SPDX-License-Identifier: Apache-2.0
#include "altiplan/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan {

std::string name_at(const Drawing& drawing, const Vec3& p) {
  const Drawn* in_the_way = nullptr;
  const Drawn* around = nullptr;
  double nearest = kInfinity;
  double from_border = kInfinity;                   // of `around`; negative outside of it
  const auto is_beyond = [&](const Shape& shape) {  // farther than the nearest, by its box alone
    const Box box = bounds(shape);
    const Vec3 off = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0);
    return off.norm() > std::max(nearest, 0.0);
  };
  for (const Drawn& drawn : drawing.shapes) {
    if (drawn.role != Drawn::Role::keep_in && nearest < kInfinity && is_beyond(drawn.shape)) {
      continue;
    }
    const double distance = signed_distance(drawn.shape, p);
    if (drawn.role != Drawn::Role::keep_in) {
      in_the_way = distance < nearest ? &drawn : in_the_way;
      nearest = std::min(nearest, distance);
    } else if (around == nullptr ||
               (drawing.keeps_in_all ? -distance < from_border : -distance > from_border)) {
      around = &drawn;
      from_border = -distance;
    }
  }
  const Drawn* part = nearest <= from_border ? in_the_way : around;
  return part == nullptr ? "" : part->name;
}
}  // namespace altiplan
