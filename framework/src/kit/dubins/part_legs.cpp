// SPDX-License-Identifier: Apache-2.0
#include "part_legs.hpp"

namespace altiplan::kit {
namespace {

/// Shorter parts, metres, have no leg: they are rounding, and as straight legs noise.
constexpr double kNoLength = kLengthTolerance / 2;

/// Makes the legs end at `to`. Rounding takes them past it, by 1e-4 m after 500 km: the last
/// straight leg takes that up, as a turn that ends elsewhere than its circle would be no turn.
void end_at(std::vector<Leg>& legs, const Vec3& to) {
  const Vec3 off = to - legs.back().to;
  std::size_t last = legs.size() - 1;
  while (last > 0 && legs[last].turns()) {
    --last;
  }
  if (!legs[last].turns()) {
    legs[last].to += off;
    for (std::size_t i = last + 1; i < legs.size(); ++i) {
      legs[i].from += off;
      legs[i].to += off;
    }
  }
  legs.back().to = to;
}
}  // namespace

std::vector<Leg> part_legs(std::span<const PathPart> parts, double radius, const Pose& from,
                           const Vec3& to, const Vec3& wind) {
  double total = 0;
  for (const PathPart& part : parts) {
    total += part.size;
  }
  std::vector<Leg> legs;
  Pose at = from;
  for (const PathPart& part : parts) {
    // A turn that bends by more would leave a corner.
    if (radius * part.size < kNoLength && (part.sense == 0 || part.size <= kAngleTolerance)) {
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
  if (legs.empty() && (to - from.position).norm() >= kNoLength) {
    legs.push_back(Leg::straight(from.position, to));
  }
  if (!legs.empty()) {
    end_at(legs, to);
  }
  return legs;
}
}  // namespace altiplan::kit
