// SPDX-License-Identifier: Apache-2.0
#include "altiplan/flown_route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "altiplan/energy.hpp"
#include "altiplan/measures.hpp"
#include "uniform_motion.hpp"
#include "words.hpp"

namespace altiplan {

/// Trapezoids of acceleration, whose jerk sets in and ends as raised cosines within `jerk_time_s`:
/// ArduPilot's (AC_WPNav's SCurve) with its times, the usual ones without a jerk time.
Ramp ramp(double from_mps, double to_mps, const Acceleration& acceleration) {
  const auto& [a, jerk, jerk_time_s, radius] = acceleration;
  const double change = std::abs(to_mps - from_mps);
  double seconds = change / a;
  if (std::isfinite(jerk) && change > 0) {
    const double sets_in_s = jerk_time_s + a / jerk;
    const double half = jerk_time_s / 2;
    seconds = change >= a * sets_in_s ? change / a + sets_in_s
                                      : 2 * (half + std::sqrt(half * half + change / jerk));
  }
  return {seconds, (from_mps + to_mps) / 2 * seconds};
}

namespace {

/// The greatest number at most `high` that satisfies what all numbers below it satisfy, and `low`.
template <class Condition>
double greatest(double low, double high, const Condition& satisfies) {
  if (satisfies(high)) {
    return high;
  }
  for (int n = 0; n < 200; ++n) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) {
      break;
    }
    (satisfies(middle) ? low : high) = middle;
  }
  return low;
}

/// The greatest speed, at most `max_mps`, that can be reached from another within that distance.
double reachable(double from_mps, double metres, double max_mps, const Acceleration& acceleration) {
  if (from_mps >= max_mps) {
    return max_mps;
  }
  if (!std::isfinite(acceleration.jerk_mps3)) {
    return std::min(max_mps, std::sqrt(from_mps * from_mps + 2 * acceleration.mps2 * metres));
  }
  return greatest(from_mps, max_mps,
                  [&](double v) { return ramp(from_mps, v, acceleration).metres <= metres; });
}

/// Of a line that is long enough but for rounding.
Sprint sprint_along(double metres, double from_mps, double to_mps, double max_mps,
                    const Acceleration& acceleration) {
  double top = max_mps;
  if (!std::isfinite(acceleration.jerk_mps3)) {
    const double squares = from_mps * from_mps + to_mps * to_mps;
    top = std::min(max_mps, std::sqrt((2 * acceleration.mps2 * metres + squares) / 2));
  } else {
    top = greatest(std::max(from_mps, to_mps), max_mps, [&](double v) {
      return ramp(from_mps, v, acceleration).metres + ramp(v, to_mps, acceleration).metres <=
             metres;
    });
  }
  top = std::max({top, from_mps, to_mps});
  Sprint flown{ramp(from_mps, top, acceleration), top, {}, ramp(top, to_mps, acceleration)};
  flown.level.metres = std::max(0.0, metres - flown.up.metres - flown.down.metres);
  flown.level.seconds = top > 0 ? flown.level.metres / top : 0;
  return flown;
}
}  // namespace

std::optional<Sprint> sprint(double metres, double from_mps, double to_mps, double max_mps,
                             const Acceleration& acceleration) {
  constexpr double kRounding = 1e-9;
  return ramp(from_mps, to_mps, acceleration).metres > metres * (1 + kRounding)
             ? std::nullopt
             : std::optional(sprint_along(metres, from_mps, to_mps, max_mps, acceleration));
}

double corner_speed(double turn, double radius_m, double mps2) {
  return std::sqrt(mps2 * radius_m * std::tan((kPi - turn) / 2));
}

namespace {

/// A part of a leg that may be flown at one speed.
struct Stretch {
  FlownPhase phase;  ///< at that speed
  double metres = 0;
  bool ends_leg = false;
  bool waits = false;

  double top_mps() const { return metres > 0 ? metres / phase.seconds : 0; }
};

std::vector<Stretch> stretches_of(const Leg& leg, double time_s, const Request& request) {
  std::vector<Stretch> all;
  if (leg.turns() || leg.waits()) {
    const double seconds = leg_duration(leg, time_s, request);
    const double speed = leg.turns() ? leg.air_length() / seconds : 0;
    all.push_back({{leg.from, leg.to, speed, speed, seconds,
                    leg.turns() && request.vehicle.wing ? leg.radius : 0},
                   leg.waits() ? 0 : leg.length(),
                   false,
                   leg.waits()});
  } else {
    in_uniform_motion(leg, time_s, request,
                      [&](const Vec3& a, double t0, const Vec3& b, double t1) {
                        const double metres = (b - a).norm();
                        const double seconds = t1 - t0;
                        const double speed = seconds > 0 ? metres / seconds : 0;
                        all.push_back({{a, b, speed, speed, seconds, 0}, metres, false, false});
                        return std::isfinite(seconds);  // the vehicle gets no farther
                      });
  }
  if (!all.empty()) {
    all.back().ends_leg = true;
  }
  return all;
}

/// The greatest speed at which a waypoint between two legs may be passed.
double passing_speed(const Leg& before, const Leg& after, const Acceleration& acceleration) {
  if (!acceleration.corner_radius_m || before.waits() || after.waits()) {
    return 0;
  }
  const double turn = turn_angle_in_space(before.track(1), after.track(0));
  const double within =
      std::min({*acceleration.corner_radius_m, before.length() / 2, after.length() / 2});
  return corner_speed(turn, within, acceleration.mps2);
}

/// From rest to rest, with the acceleration.
class Accelerated {
 public:
  Accelerated(const Route& route, const Request& request)
      : acceleration_(request.vehicle.acceleration) {
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      const Leg leg = route.leg(i);
      const double passes = i > 0 ? passing_speed(route.leg(i - 1), leg, acceleration_) : 0;
      for (Stretch& stretch : stretches_of(leg, 0, request)) {
        if (leg.turns()) {  // not faster than its radius allows
          const double maximum = std::sqrt(acceleration_.mps2 * leg.radius);
          stretch.phase.seconds = std::max(stretch.phase.seconds, stretch.metres / maximum);
        }
        const bool begins_leg = stretches_.empty() || stretches_.back().ends_leg;
        const double before = stretches_.empty() ? 0 : stretches_.back().top_mps();
        begins_.push_back(std::min({begins_leg ? passes : kInfinity, before, stretch.top_mps()}));
        stretches_.push_back(std::move(stretch));
      }
    }
    begins_.push_back(0);
    limit_by_acceleration();
  }

  void fly(const std::function<void(const FlownPhase&)>& use) const {
    for (std::size_t n = 0; n < stretches_.size(); ++n) {
      const Stretch& stretch = stretches_[n];
      if (stretch.waits || !std::isfinite(stretch.phase.seconds)) {
        use(stretch.phase);
      } else if (stretch.metres > 0) {
        fly(stretch, begins_[n], begins_[n + 1], use);
      }
    }
  }

 private:
  /// Forwards what can be reached, backwards from what can be braked.
  void limit_by_acceleration() {
    for (std::size_t n = 0; n < stretches_.size(); ++n) {
      begins_[n + 1] = reachable(begins_[n], stretches_[n].metres, begins_[n + 1], acceleration_);
    }
    for (std::size_t n = stretches_.size(); n-- > 0;) {
      begins_[n] = reachable(begins_[n + 1], stretches_[n].metres, begins_[n], acceleration_);
    }
  }

  void fly(const Stretch& stretch, double from_mps, double to_mps,
           const std::function<void(const FlownPhase&)>& use) const {
    const Sprint flown =
        sprint_along(stretch.metres, from_mps, to_mps, stretch.top_mps(), acceleration_);
    const Vec3 way = (stretch.phase.to - stretch.phase.from) / stretch.metres;
    double along = 0;
    const auto part = [&](const Ramp& ramp, double begin_mps, double end_mps) {
      if (ramp.seconds > 0) {
        use({stretch.phase.from + along * way, stretch.phase.from + (along + ramp.metres) * way,
             begin_mps, end_mps, ramp.seconds, stretch.phase.turn_radius_m});
      }
      along += ramp.metres;
    };
    part(flown.up, from_mps, flown.top_mps);
    part(flown.level, flown.top_mps, flown.top_mps);
    part(flown.down, flown.top_mps, to_mps);
  }

  const Acceleration& acceleration_;
  std::vector<Stretch> stretches_;
  std::vector<double> begins_;  ///< speed at the beginning of each, then at the end of the last
};

/// Integral of f over [0, 1] by Gauss-Legendre quadrature with eight points.
template <class Function>
double integral(const Function& f) {
  constexpr std::array<double, 4> kAt{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                      0.9602898564975363};
  constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873,
                                          0.2223810344533745, 0.1012285362903763};
  double sum = 0;
  for (std::size_t i = 0; i < kAt.size(); ++i) {
    sum += kWeight[i] * (f((1 - kAt[i]) / 2) + f((1 + kAt[i]) / 2));
  }
  return sum / 2;
}

constexpr double kSecondsPerHour = 3600;

/// A straight phase cut at a share of its length.
std::pair<FlownPhase, FlownPhase> cut(const FlownPhase& phase, double share) {
  const double from = phase.from_mps * phase.from_mps;
  const double to = phase.to_mps * phase.to_mps;
  FlownPhase first = phase;
  FlownPhase rest = phase;
  first.to = rest.from = phase.from + share * (phase.to - phase.from);
  first.to_mps = rest.from_mps = std::sqrt(from + share * (to - from));
  const double sum = phase.from_mps + phase.to_mps;
  first.seconds = phase.seconds * share * sum / (phase.from_mps + first.to_mps);
  rest.seconds = phase.seconds * (1 - share) * sum / (rest.from_mps + phase.to_mps);
  return {first, rest};
}

/// Of steady flight at each moment: what it takes to accelerate is got back in braking.
double energy_of(const FlownPhase& phase, const Wind& wind, const Request& request,
                 const Power& power) {
  if (phase.seconds == 0 || phase.seconds == kInfinity) {
    return phase.seconds;  // infinite where the wind keeps the vehicle from its way
  }
  const Vec3 way = phase.to - phase.from;
  const double metres = way.norm();
  if (phase.turn_radius_m == 0 && metres > 0) {
    const std::vector<double> borders = wind.crossings(phase.from, phase.to);
    if (!borders.empty()) {
      const auto [first, rest] = cut(phase, borders[borders.size() / 2]);
      return energy_of(first, wind, request, power) + energy_of(rest, wind, request, power);
    }
  }
  if (phase.turn_radius_m > 0) {
    constexpr double kGravity = 9.80665;
    const double bank =
        request.vehicle.wing
            ? std::atan(phase.from_mps * phase.from_mps / (kGravity * phase.turn_radius_m))
            : 0;
    const double middle_m = (phase.from.z() + phase.to.z()) / 2;
    return power.watts({phase.from_mps, way.z() / phase.seconds, bank, middle_m}) * phase.seconds /
           kSecondsPerHour;
  }
  const auto watts = [&](double share) {  // of the time
    const double speed = phase.from_mps + share * (phase.to_mps - phase.from_mps);
    const double along =
        metres > 0 ? share * (phase.from_mps + speed) / (phase.from_mps + phase.to_mps) : 0;
    const Vec3 here = phase.from + along * way;
    const Vec3 ground = metres > 0 ? Vec3(way * (speed / metres)) : Vec3::Zero();
    return power.watts({(ground - wind.at(here)).head<2>().norm(), ground.z(), 0, here.z()});
  };
  // Nothing changes in level flight at one speed.
  const bool is_steady = phase.from_mps == phase.to_mps && way.z() == 0;
  return (is_steady ? watts(0.5) : integral(watts)) * phase.seconds / kSecondsPerHour;
}

/// The way flown in a time, as a share of a straight phase's.
double share_flown(const FlownPhase& phase, double seconds) {
  const double share = seconds / phase.seconds;
  const double mps = phase.from_mps + share * (phase.to_mps - phase.from_mps);
  const double sum = phase.from_mps + phase.to_mps;
  return sum > 0 ? share * (phase.from_mps + mps) / sum : share;
}

/// Of a phase that begins at a time, in the winds of that time. In turns the power depends on none.
double energy_of(FlownPhase phase, double time_s, const Request& request, const Power& power) {
  if (request.wind.changes.empty() || phase.turn_radius_m > 0) {
    return energy_of(phase, request.wind, request, power);
  }
  double wh = 0;
  double left_s = request.wind.in_force_until(time_s) - time_s;
  while (phase.seconds > left_s && std::isfinite(phase.seconds)) {
    FlownPhase first = phase;
    if ((phase.to - phase.from).norm() > 0) {
      std::tie(first, phase) = cut(phase, share_flown(phase, left_s));
    } else {
      phase.seconds -= left_s;
    }
    first.seconds = left_s;
    wh += energy_of(first, request.wind.in_force(time_s), request, power);
    time_s += left_s;
    left_s = request.wind.in_force_until(time_s) - time_s;
  }
  return wh + energy_of(phase, request.wind.in_force(time_s), request, power);
}
}  // namespace

void fly(const Route& route, const Request& request,
         const std::function<void(const FlownPhase&)>& use) {
  const Route legs = without_repeats(route);
  if (!request.vehicle.wing && request.vehicle.acceleration.takes_time()) {
    if (request.wind.changes.empty()) {
      Accelerated(legs, request).fly(use);
    } else {  // no wind changes its speeds, and a leg that is cut would be begun twice
      Request steady = request;
      steady.wind.changes.clear();
      Accelerated(legs, steady).fly(use);
    }
    return;
  }
  const bool changes = !request.wind.changes.empty();
  double time_s = request.start.time_s;
  for (std::size_t i = 0; i < legs.leg_count(); ++i) {
    for (const Stretch& stretch : stretches_of(legs.leg(i), changes ? time_s : 0, request)) {
      use(stretch.phase);
      time_s += stretch.phase.seconds;
    }
  }
}

double flown_time(const Route& route, const Request& request) {
  double seconds = 0;
  fly(route, request, [&](const FlownPhase& phase) { seconds += phase.seconds; });
  return seconds;
}

double flown_energy(const Route& route, const Request& request, const Power& power) {
  double wh = 0;
  double time_s = request.start.time_s;
  fly(route, request, [&](const FlownPhase& phase) {
    wh += energy_of(phase, time_s, request, power);
    time_s += phase.seconds;
  });
  return wh;
}

double leg_energy(const Leg& leg, double time_s, const Request& request, const Power& power) {
  double wh = 0;
  for (const Stretch& stretch :
       stretches_of(leg, request.wind.changes.empty() ? 0 : time_s, request)) {
    wh += energy_of(stretch.phase, time_s, request, power);
    time_s += stretch.phase.seconds;
  }
  return wh;
}

double track_energy(const std::vector<std::pair<double, Vec3>>& track, const Request& request,
                    const Power& power) {
  double wh = 0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const auto& [before_s, from] = track[i - 1];
    const auto& [after_s, to] = track[i];
    if (after_s > before_s) {
      const double speed = (to - from).norm() / (after_s - before_s);
      wh += energy_of({from, to, speed, speed, after_s - before_s, 0}, before_s, request, power);
    }
  }
  return wh;
}

std::optional<Violation> energy_violation(double needed_wh, const Vehicle& vehicle) {
  const double available = vehicle.energy != nullptr ? vehicle.energy->available_wh() : kInfinity;
  if (!std::isfinite(available) || needed_wh <= available) {
    return std::nullopt;
  }
  const std::string may = fixed(available) + " Wh of the battery may be used";
  return Violation{"energy",
                   0,
                   needed_wh,
                   available,
                   std::isfinite(needed_wh)
                       ? "the flight takes " + fixed(needed_wh) + " Wh, where " + may
                       : "the power of part of the flight is not known, where " + may,
                   "",
                   "Wh"};
}
}  // namespace altiplan
