// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/move_rules.hpp"

#include <algorithm>

#include "altiplan/check.hpp"

namespace altiplan::kit {

bool turn_kept(const Vec3& incoming, const Vec3& outgoing, const Limits& limits) {
  return turn_angle_horizontal(incoming, outgoing) <=
             limits.max_turn_horizontal + kAngleTolerance &&
         turn_angle_in_space(incoming, outgoing) <= limits.max_turn_space + kAngleTolerance &&
         (limits.min_turn_radius <= 0 || radius_through(-incoming, Vec3::Zero(), outgoing) >=
                                             limits.min_turn_radius - kLengthTolerance);
}

MoveRules::MoveRules(const Request& request, const Lattice& lattice, MoveCheck check,
                     CornerRule corner)
    : request_(request),
      lattice_(lattice),
      corner_(corner),
      needed_(std::max(request.limits.min_clearance, request.vehicle.radius_m)),
      spare_(needed_ + request.world->slack() + kLengthTolerance) {
  const Limits& limits = request.limits;
  if (check == MoveCheck::cells) {
    GridSpec spec = lattice.spec();
    spec.inflation = needed_;
    const auto& layers = request.world->layers();
    const bool own_cells = std::all_of(layers.begin(), layers.end(), [](const Layer& layer) {
      return layer.environment->native_grid().has_value();
    });
    spec.rule = own_cells && !layers.empty() && needed_ == 0 ? GridSpec::Rule::native
                                                             : GridSpec::Rule::touched;
    grid_ = request.world->voxels(spec);
  }
  wants_clearance_ = check == MoveCheck::exact && !request.world->layers().empty();
  has_ground_rules_ =
      request.world->has_ground() ||
      std::any_of(limits.altitude.begin(), limits.altitude.end(), [](const AltitudeBand& band) {
        return band.datum == AltitudeBand::Datum::ground;
      });
  for (const NamedConstraint& named : request.constraints) {
    constraints_.push_back(named);
  }
  steps_ = directions_kept();
  for (int in = 0; in < kDirections; ++in) {
    for (int out = 0; out < kDirections; ++out) {
      if (in == kHere || turn_kept(lattice.step(in), lattice.step(out), limits)) {
        after_[std::size_t(in)] |= DirectionMask{1} << out;
      }
    }
  }
}

DirectionMask MoveRules::directions_kept() {
  const Limits& limits = request_.limits;
  DirectionMask kept = 0;
  int climb = 0;
  int leg = 0;
  for (int d = 0; d < kDirections; ++d) {
    if ((lattice_.steps() >> d & 1) == 0) {
      continue;
    }
    const double length = lattice_.step_length(d);
    const bool climb_kept = climb_angle(lattice_.step(d)) <= limits.max_climb + kAngleTolerance;
    const bool leg_kept =
        length >= limits.min_leg - kLengthTolerance && length <= limits.max_leg + kLengthTolerance;
    climb += !climb_kept;
    leg += !leg_kept;
    kept |= DirectionMask(climb_kept && leg_kept) << d;
  }
  const auto sentence = [&](const char* rule, int count) {
    return std::string(steps_refused_by_.empty() ? "" : ", ") + rule + " rules out " +
           std::to_string(count) + " of " + std::to_string(__builtin_popcount(lattice_.steps())) +
           " directions";
  };
  if (climb > 0) {
    steps_refused_by_ += sentence("climb_angle", climb);
  }
  if (leg > 0) {
    steps_refused_by_ += sentence("leg_length", leg);
  }
  return kept;
}

bool MoveRules::keeps_ground(const Vec3& a, const Vec3& b) {
  const World& world = *request_.world;
  const Limits& limits = request_.limits;
  if (!world.ground_below(a, b)) {
    ++refused_[by_no_ground];
    return false;
  }
  if (limits.min_ground_clearance && world.ground_gap(a, b, *limits.min_ground_clearance) <
                                         *limits.min_ground_clearance - kLengthTolerance) {
    ++refused_[by_ground];
    return false;
  }
  for (const AltitudeBand& band : limits.altitude) {
    if (band.datum == AltitudeBand::Datum::ground &&
        (world.ground_gap(a, b, band.min) < band.min - kLengthTolerance ||
         (band.max < kInfinity && world.ground_gap_max(a, b) > band.max + kLengthTolerance))) {
      ++refused_[by_altitude];
      return false;
    }
  }
  return true;
}

bool MoveRules::admitted(const std::optional<Vec3>& before, const Vec3& a, const Vec3& b) {
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (!constraints_[i].admits({before, a, b})) {
      ++refused_[by_constraint];
      refused_constraint_ = request_.constraints[i].name;
      admit_needed_parent_ =
          admit_needed_parent_ || (before && constraints_[i].admits({std::nullopt, a, b}));
      return false;
    }
  }
  return true;
}

bool MoveRules::leg_free(const std::optional<Vec3>& before, const Vec3& a, const Vec3& b,
                         double length, double clearance_a, double clearance_b) {
  ++moves_checked_;
  if (has_ground_rules_ && !keeps_ground(a, b)) {
    return false;
  }
  if (!constraints_.empty() && !admitted(before, a, b)) {
    return false;
  }
  // Clearance is 1-Lipschitz: two balls of half the leg around its ends hold all of it.
  if (!wants_clearance_ || std::min(clearance_a, clearance_b) > spare_ + length / 2) {
    return true;
  }
  if (const Layer* layer = request_.world->blocked_by(a, b, needed_)) {
    ++refused_[by_clearance];
    refused_layer_ = layer->id;
    return false;
  }
  return true;
}

bool MoveRules::any_leg_ok(const std::optional<Vec3>& before, const Vec3& a, const Vec3& b) {
  ++moves_checked_;
  if (leg_ok(before, a, b, request_)) {
    return true;
  }
  if (!before || !leg_ok(std::nullopt, a, b, request_)) {
    ++refused_[by_link];
    const auto found = leg_violations(before, a, b, request_, 0);
    refused_link_ = found.empty() ? "" : found.front().constraint;
  } else {
    ++refused_[by_turn];
  }
  return false;
}

std::string MoveRules::refusals() const {
  const std::string names[rule_count] = {
      "blocked cells",
      request_.limits.min_turn_radius > 0 ? "turn limits" : "turn_angle",
      "clearance to '" + refused_layer_ + "'",
      "no ground below",
      "ground_clearance",
      "altitude",
      refused_constraint_,
      refused_link_ + " where start or goal join the lattice"};
  std::vector<int> order;
  for (int rule = 0; rule < rule_count; ++rule) {
    if (refused_[std::size_t(rule)] > 0) {
      order.push_back(rule);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return refused_[std::size_t(a)] > refused_[std::size_t(b)];
  });
  std::string text;
  for (const int rule : order) {
    text += (text.empty() ? "" : ", ") + names[rule] + " (" +
            std::to_string(refused_[std::size_t(rule)]) + ")";
  }
  return text.empty() || steps_refused_by_.empty() ? text + steps_refused_by_
                                                   : text + "; " + steps_refused_by_;
}
}  // namespace altiplan::kit
