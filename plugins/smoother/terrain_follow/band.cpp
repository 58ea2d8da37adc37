// SPDX-License-Identifier: Apache-2.0
#include "band.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/check.hpp"

namespace terrain_follow {
using namespace altiplan;

Plan::Plan(const Polyline& route) {
  constexpr double kSame = kLengthTolerance / 10;
  for (const Vec3& p : route) {
    const double step = points_.empty() ? kInfinity : (p - points_.back()).head<2>().norm();
    if (step <= kSame) {
      points_.back().z() = points_.size() > 1 ? p.z() : points_.back().z();
      continue;
    }
    along_.push_back(points_.empty() ? 0 : along_.back() + step);
    points_.push_back(p);
  }
  corners_.push_back(0);
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    constexpr double kStraight = 1e-9;  // radians
    if (turn_angle_horizontal(points_[i] - points_[i - 1], points_[i + 1] - points_[i]) >
        kStraight) {
      corners_.push_back(along_[i]);
    }
  }
  corners_.push_back(along_.back());
}

double Plan::span(const Polyline& route) {
  double maximum = 0;
  for (const Vec3& p : route) {
    maximum = std::max(maximum, (p - route.front()).head<2>().norm());
  }
  return maximum;
}

Plan::Share Plan::share_at(double s) const {
  const auto after = std::upper_bound(along_.begin() + 1, along_.end() - 1, s);
  const std::size_t leg = std::size_t(after - along_.begin()) - 1;
  return {leg, std::clamp((s - along_[leg]) / (along_[leg + 1] - along_[leg]), 0.0, 1.0)};
}

Vec3 Plan::at(double s, double z) const {
  const auto [leg, share] = share_at(s);
  const Vec3 p = share >= 1 ? points_[leg + 1]
                            : Vec3(points_[leg] + share * (points_[leg + 1] - points_[leg]));
  return {p.x(), p.y(), z};
}

double Plan::route_height(double s) const {
  const auto [leg, share] = share_at(s);
  return points_[leg].z() + share * (points_[leg + 1].z() - points_[leg].z());
}

Band::Band(const Request& request, const Plan& plan, const Polyline& route)
    : plan_(plan), places_(request) {
  Limits& limits = places_.limits;
  limits.min_leg = 0;
  limits.max_leg = kInfinity;
  limits.max_turn_horizontal = kPi;
  limits.max_turn_space = kPi;
  limits.min_turn_radius = 0;
  limits.max_climb = kPi / 2;
  limits.max_sink.reset();
  places_.vehicle.body.reset();
  places_.wind = {};
  // A constraint that refuses a leg of no length everywhere is one on legs.
  std::erase_if(places_.constraints, [&](const NamedConstraint& named) {
    return named.admits_all || std::none_of(route.begin(), route.end(), [&](const Vec3& p) {
             return named.admits({std::nullopt, p, p, places_.world.get()});
           });
  });
}

bool Band::permits(const Vec3& a, const Vec3& b) const {
  return leg_ok(std::nullopt, a, b, places_);
}

Column Band::column(double s) const {
  double z = plan_.route_height(s);
  if (!find_height(s, z)) {
    return {s};
  }
  return {s, farthest(s, z, places_.volume.min.z()), farthest(s, z, places_.volume.max.z())};
}

/// The last permitted height on the way from one that is, or slightly farther.
double Band::farthest(double s, double from, double to) const {
  constexpr double kFine = 1e-5;
  if (permits(plan_.at(s, from), plan_.at(s, to))) {
    return to;
  }
  while (std::abs(to - from) > kFine) {
    const double middle = (from + to) / 2;
    (permits(plan_.at(s, from), plan_.at(s, middle)) ? from : to) = middle;
  }
  return to;
}

/// Moves z to a permitted height near it, in steps of a metre at least.
bool Band::find_height(double s, double& z) const {
  const Box& volume = places_.volume;
  const double step = std::max(1.0, (volume.max.z() - volume.min.z()) / 10000);
  const double first = z;
  for (double off = 0; first - off >= volume.min.z() || first + off <= volume.max.z();
       off += step) {
    for (const double there : {first - off, first + off}) {
      const Vec3 p = plan_.at(s, there);
      if (permits(p, p)) {
        z = there;
        return true;
      }
    }
  }
  return false;
}
}  // namespace terrain_follow
