// SPDX-License-Identifier: Apache-2.0
#include "host/judge/slanted_end.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {

double SlantedEnd::needed(double z) const {
  return std::clamp((z - foot_m) / 2, 0.0, std::max(clearance_m, 0.0));
}

// What is needed is linear between the foot and twice the clearance above it: there the leg,
// lowered by it, is straight.
double SlantedEnd::margin(const World& world, const Vec3& from, const Vec3& to) const {
  const double rise = to.z() - from.z();
  double shares[] = {0, 0, 0, 1};
  for (const int n : {0, 1}) {
    const double z = foot_m + n * 2 * std::max(clearance_m, 0.0);
    shares[n + 1] = std::isfinite(z) && rise != 0 ? std::clamp((z - from.z()) / rise, 0.0, 1.0) : 0;
  }
  std::sort(std::begin(shares), std::end(shares));
  const auto lowered = [&](double share) {
    Vec3 p = from + share * (to - from);
    p.z() -= needed(p.z());
    return p;
  };
  double least = kInfinity;
  for (int n = 0; n < 3; ++n) {
    if (shares[n] < shares[n + 1]) {
      const double gap = world.ground_gap(lowered(shares[n]), lowered(shares[n + 1]));
      if (!(gap >= least)) {
        least = gap;
      }
    }
  }
  return least;
}

Vec3 SlantedEnd::worst(const World& world, Vec3 from, Vec3 to) const {
  constexpr double kNear = 1;
  while ((to - from).norm() > kNear) {
    const Vec3 middle = (from + to) / 2;
    (margin(world, from, middle) <= margin(world, middle, to) ? to : from) = middle;
  }
  return (from + to) / 2;
}
}  // namespace altiplan::host
