// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/ground_rules.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::kit {

GroundRules::GroundRules(const Request& request, double needed, bool asks_world)
    : request_(request), needed_(needed), asks_world_(asks_world) {
  const auto& bands = request.limits.altitude;
  exist_ = request.world->has_ground() ||
           std::any_of(bands.begin(), bands.end(), [](const AltitudeBand& band) {
             return band.datum == AltitudeBand::Datum::ground;
           });
  if (asks_world) {
    sort_layers();
  }
  if (exist_) {
    find_gaps();
  }
}

void GroundRules::sort_layers() {
  obstacles_ = *request_.world;
  for (const Layer& layer : request_.world->layers()) {
    const Ground* ground = layer.environment->ground();
    if (ground != nullptr && ground->is_all()) {
      obstacles_ = obstacles_.without(layer.id);
      bare_ground_ = bare_ground_.with(layer);
    }
  }
}

void GroundRules::find_gaps() {
  constexpr double kRounding = 1e-5;  // of heights that are sums, in metres
  double slope = 0;
  for (const Layer& layer : bare_ground_.layers()) {
    // Anything below this blocks the leg itself.
    needed_gap_ = 0;
    too_low_ = Refusal::clearance;
    if (needed_ > 0) {
      slope = std::max(slope, layer.environment->ground()->slope(request_.volume.grown(needed_)));
    }
  }
  needed_gap_ = obstacles_.has_ground() ? -kInfinity : needed_gap_;
  certain_gap_ = needed_ > 0 ? needed_ * std::hypot(1, slope) : 0;
  const auto held_to = [&](double gap, Refusal refusal) {
    too_low_ = gap >= needed_gap_ ? refusal : too_low_;
    needed_gap_ = std::max(needed_gap_, gap);
    certain_gap_ = std::max(certain_gap_, gap);
  };
  for (const AltitudeBand& band : request_.limits.altitude) {
    if (band.datum == AltitudeBand::Datum::ground) {
      held_to(band.min, Refusal::altitude);
      ceiling_ = std::min(ceiling_, band.max);
    }
  }
  if (request_.limits.min_ground_clearance) {
    held_to(*request_.limits.min_ground_clearance, Refusal::ground_clearance);
  }
  needed_gap_ -= kLengthTolerance + kRounding;
  certain_gap_ += kRounding;
}

GroundRules::Refusal GroundRules::floor_limits(const Vec3& a, const Vec3& b) const {
  const World& world = *request_.world;
  const Limits& limits = request_.limits;
  if (!world.ground_below(a, b)) {
    return Refusal::no_ground;
  }
  const auto is_lower = [&](double min) {
    return world.ground_gap(a, b, min) < min - kLengthTolerance;
  };
  if (limits.min_ground_clearance && is_lower(*limits.min_ground_clearance)) {
    return Refusal::ground_clearance;
  }
  for (const AltitudeBand& band : limits.altitude) {
    if (band.datum == AltitudeBand::Datum::ground && is_lower(band.min)) {
      return Refusal::altitude;
    }
  }
  return Refusal::none;
}

bool GroundRules::below_ceilings(const Vec3& a, const Vec3& b) const {
  return std::all_of(request_.limits.altitude.begin(), request_.limits.altitude.end(),
                     [&](const AltitudeBand& band) {
                       return band.datum != AltitudeBand::Datum::ground || band.max == kInfinity ||
                              request_.world->ground_gap_max(a, b) <= band.max + kLengthTolerance;
                     });
}

GroundRules::Refusal GroundRules::heights(const Vec3& a, const Vec3& b) const {
  const Refusal low = floor_limits(a, b);
  return low == Refusal::none && !below_ceilings(a, b) ? Refusal::altitude : low;
}

GroundRules::Refusal GroundRules::floors(const Vec3& a, const Vec3& b) const {
  const Refusal low = floor_limits(a, b);
  return low == Refusal::none && asks_world_ && bare_ground_.blocked(a, b, needed_)
             ? Refusal::clearance
             : low;
}
}  // namespace altiplan::kit
