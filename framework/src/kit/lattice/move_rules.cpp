// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/move_rules.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "altiplan/swept_volume.hpp"

namespace altiplan::kit {

namespace {
bool length_kept(double length, const Limits& limits) {
  return length >= limits.min_leg - kLengthTolerance && length <= limits.max_leg + kLengthTolerance;
}

double slope_limit(const Vec3& leg, const Limits& limits) {
  return leg.z() < 0 ? limits.max_descent() : limits.max_climb;
}

bool climb_kept(const Vec3& leg, const Limits& limits) {
  return climb_angle(leg) <= slope_limit(leg, limits) + kAngleTolerance;
}

/// Comparison of an angle with a limit by its cosine: a product of two vectors, and of their
/// lengths, against the limit's cosine.
enum class Told { kept, broken, nothing };
Told by_cosine(double dot, double lengths, double limit_cosine) {
  const double over = dot - limit_cosine * lengths;
  return std::abs(over) <= 1e-9 * lengths ? Told::nothing : over > 0 ? Told::kept : Told::broken;
}

}  // namespace

namespace {
bool is_everywhere(const Wind& wind) {
  return wind.layers.size() == 1 && wind.layers.front().above_m == -kInfinity &&
         !wind.layers.front().grid;
}

/// True if the judge may refuse a leg for the wind: for its climb through the air, or as one whose
/// course cannot be held.
bool wind_may_refuse(const Request& request) {
  return !request.wind.is_calm() &&
         (request.limits.max_slope() < kPi / 2 || request.wind.max_speed() >= request.air_speed());
}

/// With that alone to judge.
Request wind_alone(const Request& request) {
  Request alone;
  alone.world = std::make_shared<const World>();
  alone.vehicle = request.vehicle;
  alone.vehicle.body = nullptr;
  alone.wind = request.wind;
  alone.limits.max_climb = request.limits.max_climb;
  alone.limits.max_sink = request.limits.max_sink;
  alone.volume = {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
  return alone;
}
}  // namespace

bool MoveRules::cells_decide(const Request& request) {
  return !GroundRules(request, 0, false).exist() && !request.judges_pairs() &&
         !(wind_may_refuse(request) && !is_everywhere(request.wind)) && !request.limits.turns() &&
         request.limits.max_route_length == kInfinity;
}

namespace {
std::shared_ptr<const VoxelGrid> occupancy(const Request& request, const Lattice& lattice,
                                           double clearance) {
  GridSpec spec = lattice.spec();
  spec.inflation = clearance;
  const auto& layers = request.world->layers();
  const bool own_cells = std::all_of(layers.begin(), layers.end(), [](const Layer& layer) {
    return layer.environment->info().native_grid.has_value();
  });
  spec.rule = own_cells && !layers.empty() && spec.inflation == 0 ? GridSpec::Rule::native
                                                                  : GridSpec::Rule::touched;
  return request.world->voxels(spec, request.budget);
}
}  // namespace

std::shared_ptr<const VoxelGrid> occupancy(const Request& request, const Lattice& lattice) {
  return occupancy(request, lattice,
                   std::max(request.limits.min_clearance, request.vehicle.radius_m));
}

std::string beyond_cells(const Request& request) {
  const Limits& limits = request.limits;
  if (limits.turns()) {
    return "limits on turns";
  }
  if (limits.min_leg > 0 || limits.max_leg < kInfinity) {
    return "limits on the length of legs";
  }
  if (limits.max_route_length < kInfinity) {
    return "a limit on the route's length";
  }
  if (request.wind.max_speed() >= request.air_speed()) {
    return "a wind as fast as the vehicle";
  }
  if (request.world->has_ground()) {
    return "the ground of a layer";
  }
  const bool over_ground =
      limits.min_ground_clearance ||
      std::any_of(limits.altitude.begin(), limits.altitude.end(), [](const AltitudeBand& band) {
        return band.datum == AltitudeBand::Datum::ground;
      });
  if (over_ground) {
    return "constraints on the ground below";
  }
  if (request.vehicle.body != nullptr) {
    return "the vehicle's body";
  }
  return request.constraints.empty() ? ""
                                     : "the constraint '" + request.constraints.front().name + "'";
}

MoveRules::MoveRules(const Request& request, const Lattice& lattice, MoveCheck check,
                     CornerRule corner)
    : request_(request),
      lattice_(lattice),
      corner_(corner),
      needed_(std::max(request.limits.min_clearance, request.vehicle.radius_m)),
      reach_(std::max(request.vehicle.reach_m() + kBodyTolerance,
                      needed_ + request.world->over_approximation() + kLengthTolerance)),
      asks_world_(check == MoveCheck::exact),
      ground_(request, needed_, asks_world_) {
  const Limits& limits = request.limits;
  const auto cosine = [](double limit) { return std::cos(std::min(limit + kAngleTolerance, kPi)); };
  cosines_ = {cosine(limits.max_climb), cosine(limits.max_descent()),
              cosine(limits.max_turn_horizontal), cosine(limits.max_turn_space)};
  if (check == MoveCheck::cells) {
    grid_ = occupancy(request, lattice);
    if (request.vehicle.body != nullptr) {
      wide_grid_ = occupancy(request, lattice, reach_);
    }
  }
  judges_pairs_ = request.judges_pairs();
  if (ground_.exist()) {
    if (!GroundSteps::fit(lattice)) {
      throw ParameterError("cell_m", "the volume would have more than 32,000 levels of cells");
    }
    ground_steps_.emplace(lattice, ground_);
  }
  if (!ground_.obstacles().layers().empty()) {
    clearance_steps_.emplace(lattice, ground_.obstacles(), needed_);
    if (request.vehicle.body != nullptr && ground_.bare_ground().layers().empty()) {
      wide_steps_.emplace(lattice, ground_.obstacles(), reach_);
    }
  }
  for (const NamedConstraint& named : request.constraints) {
    if (!named.admits_all) {
      constraints_.push_back(named);
    }
  }
  if (wind_may_refuse(request)) {
    in_wind_ = wind_alone(request);
    wind_varies_ = !is_everywhere(request.wind);
  }
  steps_ = directions_kept();
  headings_last_ = request.headings_last();
  find_turns();
}

void MoveRules::find_turns() {
  const bool limited = request_.limits.turns();
  for (int in = 0; in < (headings_last_ ? kSteps : kDirections); ++in) {
    for (int d = 0; d < kDirections; ++d) {
      const int out = step_after(in, d);
      const Approach before(-lattice_.step(direction_of(in)), heading_vector(in));
      if (in == kHere || d == kHere || !limited ||
          turn_ok(before, Vec3::Zero(), lattice_.step(d), request_)) {
        after_[std::size_t(in)] |= StepMask{1} << out;
        before_[std::size_t(out)] |= StepMask{1} << in;
      }
    }
  }
}

Vec3 MoveRules::heading_vector(int step) const {
  const int heading = heading_of(step);
  if (heading < 0) {
    return Vec3::Zero();
  }
  const Cell o = heading_offset(heading);
  return lattice_.spec().cell.cwiseProduct(Vec3(o[0], o[1], 0));
}

std::optional<Approach> MoveRules::approach(int step, const Vec3& here, bool at_start) const {
  const std::optional<Approach> first = request_.before_start();
  if (step == kHere) {
    return at_start ? first : std::optional(onward(first, request_.start.position));
  }
  const Vec3 from = here - lattice_.step(direction_of(step));
  if (heading_of(step) >= 0) {
    return Approach(from, heading_vector(step));
  }
  // Vertical from the start, or from the cell of a link, in the same column.
  return Approach(from, onward(first, request_.start.position).heading_at(here));
}

/// True if the climb of a leg, in wind that through the air and its course, is kept.
bool MoveRules::keeps_climb(const Vec3& a, const Vec3& b) const {
  return in_wind_ ? leg_ok(std::nullopt, a, b, *in_wind_) : climb_kept(b - a, request_.limits);
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
    const bool is_climb_kept = wind_varies_ || keeps_climb(Vec3::Zero(), lattice_.step(d));
    const bool keeps_length = length_kept(lattice_.step_length(d), limits);
    climb += !is_climb_kept;
    leg += !keeps_length;
    kept |= DirectionMask(is_climb_kept && keeps_length) << d;
  }
  const auto sentence = [&](const std::string& rule, int count) {
    return std::string(steps_refused_by_.empty() ? "" : ", ") + rule + " rules out " +
           std::to_string(count) + " of " + std::to_string(__builtin_popcount(lattice_.steps())) +
           " directions";
  };
  if (climb > 0) {
    steps_refused_by_ += sentence(climb_rule(), climb) + lower_cells(climb);
  }
  if (leg > 0) {
    steps_refused_by_ += sentence("leg_length", leg);
  }
  return kept;
}

MoveRules::Rule MoveRules::rule_of(GroundRules::Refusal refusal) {
  using Refusal = GroundRules::Refusal;
  return refusal == Refusal::no_ground          ? by_no_ground
         : refusal == Refusal::ground_clearance ? by_ground
         : refusal == Refusal::altitude         ? by_altitude
                                                : by_clearance;
}

bool MoveRules::keeps_ground(const Vec3& a, const Vec3& b) {
  const GroundRules::Refusal refusal = ground_.heights(a, b);
  if (refusal != GroundRules::Refusal::none) {
    ++refused_[rule_of(refusal)];
  }
  return refusal == GroundRules::Refusal::none;
}

bool MoveRules::constraints_admit(const std::optional<Approach>& before, const Vec3& a,
                                  const Vec3& b) {
  const World* world = request_.world.get();
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    const auto from = before ? std::optional(before->from) : std::nullopt;
    if (!constraints_[i].admits({from, a, b, world})) {
      ++refused_[by_constraint];
      refused_constraint_ = constraints_[i].name;
      admit_needed_parent_ =
          admit_needed_parent_ || (before && constraints_[i].admits({std::nullopt, a, b, world}));
      return false;
    }
  }
  return true;
}

bool MoveRules::keeps_off(const World& layers, const Vec3& a, const Vec3& b) {
  const Layer* layer = layers.blocked_by(a, b, needed_);
  if (layer != nullptr) {
    ++refused_[by_clearance];
    refused_layer_ = layer->id;
  }
  return layer == nullptr;
}

DirectionMask MoveRules::places_free(const Cell& c, DirectionMask wanted, bool inward) {
  moves_checked_ += __builtin_popcount(wanted);
  if (ground_steps_) {
    wanted = ground_steps_->permitted(c, wanted);
  }
  if (clearance_steps_ && wanted != 0) {
    const DirectionMask kept = clearance_steps_->permitted(c, wanted);
    if (kept != wanted) {
      refused_[by_clearance] += __builtin_popcount(wanted & ~kept);
      refused_layer_ = clearance_steps_->layer();
    }
    wanted = kept;
  }
  for (DirectionMask left = wind_varies_ ? wanted : 0; left != 0; left &= left - 1) {
    const int d = __builtin_ctz(left);
    const Vec3 here = lattice_.position(c);
    const Vec3 there = here + lattice_.step(d);
    if (!(inward ? keeps_climb(there, here) : keeps_climb(here, there))) {
      ++refused_[by_climb];
      wanted &= ~(DirectionMask{1} << d);
    }
  }
  return wanted;
}

DirectionMask MoveRules::legs_free(const std::optional<Approach>& before, const Cell& c,
                                   const Vec3& here, DirectionMask wanted) {
  const bool has_body = request_.vehicle.body != nullptr;
  if (!has_body) {
    wanted = places_free(c, wanted);
  }
  if (!judges_pairs_) {
    return wanted;
  }
  DirectionMask kept = 0;
  for (DirectionMask left = wanted; left != 0; left &= left - 1) {
    const int d = __builtin_ctz(left);
    const Vec3 there = here + lattice_.step(d);
    const bool is_free =
        has_body ? body_free(before, c, d, here, there) : constraints_admit(before, here, there);
    kept |= DirectionMask(is_free) << d;
  }
  return kept;
}

bool MoveRules::sees(const std::optional<Approach>& before, const Cell& a, const Cell& b) {
  ++moves_checked_;
  if (grid_ != nullptr && !line_of_sight(*grid_, a, b)) {
    ++refused_[by_cells];
    return false;
  }
  const bool is_wide = wide_grid_ != nullptr && line_of_sight(*wide_grid_, a, b);
  return keeps_rules(before, lattice_.position(a), lattice_.position(b), is_wide);
}

bool MoveRules::keeps_rules(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                            bool is_wide) {
  return keeps_limits(before, a, b) && (!ground_.exist() || keeps_ground(a, b)) &&
         (is_wide ? constraints_admit(before, a, b) : admits(before, a, b)) &&
         (!asks_world_ || keeps_off(*request_.world, a, b));
}

bool MoveRules::keeps_limits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                             double length) {
  const Limits& limits = request_.limits;
  if (!length_kept(length, limits)) {
    ++refused_[by_leg_length];
    return false;
  }
  const Vec3 leg = b - a;
  if (in_wind_) {
    if (!keeps_climb(a, b)) {
      ++refused_[by_climb];
      return false;
    }
  } else if (slope_limit(leg, limits) < kPi / 2) {
    const double cosine = leg.z() < 0 ? cosines_.sink : cosines_.climb;
    const Told told = by_cosine(leg.head<2>().norm(), length, cosine);
    if (told == Told::broken || (told == Told::nothing && !climb_kept(leg, limits))) {
      ++refused_[by_climb];
      return false;
    }
  }
  if (before && limits.turns() && !keeps_turn(*before, a, leg)) {
    ++refused_[by_turn];
    return false;
  }
  return true;
}

bool MoveRules::keeps_turn(const Approach& before, const Vec3& a, const Vec3& outgoing) const {
  const Limits& limits = request_.limits;
  const Vec3 incoming = a - before.from;
  const double runs = incoming.head<2>().squaredNorm() * outgoing.head<2>().squaredNorm();
  constexpr double kUpright = 1e-9;  // of the squares: a leg above it has a heading
  const double all = incoming.squaredNorm() * outgoing.squaredNorm();
  if (limits.min_turn_radius > 0 || runs < kUpright * all || !has_heading(incoming) ||
      !has_heading(outgoing)) {
    return turn_ok(before, a, a + outgoing, request_);
  }
  const Told flat =
      limits.max_turn_horizontal >= kPi
          ? Told::kept
          : by_cosine(incoming.head<2>().dot(outgoing.head<2>()), std::sqrt(runs), cosines_.turn);
  const Told space = limits.max_turn_space >= kPi
                         ? Told::kept
                         : by_cosine(incoming.dot(outgoing), std::sqrt(all), cosines_.turn_space);
  return flat == Told::kept && space == Told::kept
             ? true
             : flat != Told::broken && space != Told::broken &&
                   turn_ok(before, a, a + outgoing, request_);
}

bool MoveRules::any_leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
  ++moves_checked_;
  if (leg_ok(before, a, b, request_)) {
    return true;
  }
  if (!before || !leg_ok(std::nullopt, a, b, request_)) {
    ++refused_[by_link];
    refused_link_ = {before, a, b};
  } else {
    ++refused_[by_turn];
  }
  return false;
}
}  // namespace altiplan::kit
