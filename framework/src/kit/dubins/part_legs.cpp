// SPDX-License-Identifier: Apache-2.0
#include "part_legs.hpp"

namespace altiplan::kit {

std::vector<Leg> part_legs(std::span<const PathPart> parts, double radius, const Pose& from,
                           const Vec3& to, const Vec3& wind) {
  double total = 0;
  for (const PathPart& part : parts) {
    total += part.size;
  }
  std::vector<Leg> legs;
  Pose at = from;
  for (const PathPart& part : parts) {
    if (part.size == 0) {
      continue;
    }
    const double climb = (to.z() - from.position.z()) * (part.size / total);
    const Vec3 drift = radius * part.size * wind;
    if (part.sense != 0) {
      legs.push_back(Leg::turning(at, part.sense * part.size, radius, climb, drift));
      at.heading += part.sense * part.size;
    } else {
      const Vec3 flown = radius * part.size * unit_heading(at.heading) + drift;
      legs.push_back(Leg::straight(at.position, at.position + flown + Vec3(0, 0, climb)));
    }
    at.position = legs.back().to;
  }
  if (legs.empty() && to != from.position) {
    legs.push_back(Leg::straight(from.position, to));
  }
  if (!legs.empty()) {
    legs.back().to = to;
  }
  return legs;
}
}  // namespace altiplan::kit
