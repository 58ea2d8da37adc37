// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/flight/track_judge.hpp"

namespace altiplan::host {
namespace {

/// A step of a track, in the air mass.
struct AirStep {
  double time_s = 0;
  Vec3 way{0, 0, 0};  ///< displacement through the air

  double run() const { return way.head<2>().norm(); }
};

class WingJudge {
 public:
  WingJudge(const Track& track, const Request& request, const Limits& limits)
      : track_(track),
        wind_(request.wind),
        speed_(request.vehicle.wing->airspeed_mps),
        radius_(limits.min_turn_radius),
        limits_(limits) {}

  std::vector<Violation> operator()() {
    AirStep before;
    for (at_ = 0; at_ + 1 < track_.size(); ++at_) {
      const AirStep step = step_from(at_);
      if (step.time_s > 0) {
        judge_speed(step);
        judge_climb(step);
        judge_turn(before, step);
        before = step;
      }
    }
    return std::move(found_);
  }

 private:
  AirStep step_from(std::size_t i) const {
    const auto& [t0, a] = track_[i];
    const auto& [t1, b] = track_[i + 1];
    return {t1 - t0, b - a - (t1 - t0) * wind_.at(a)};
  }

  /// At most the airspeed, and at least the chord of the tightest turn.
  void judge_speed(const AirStep& step) {
    const double flown = speed_ * step.time_s;
    const double half_turn = radius_ > 0 ? flown / (2 * radius_) : kPi;
    const double chord = half_turn < kPi / 2 ? 2 * radius_ * std::sin(half_turn) : 0;
    const double rounding = 1e-6 * flown + kLengthTolerance;
    if (step.run() > flown + rounding || step.run() < chord - rounding) {
      report("speed", step.run() / step.time_s, speed_, "m/s",
             "the track goes through the air at %.9g m/s, where the airspeed is %.9g m/s");
    }
  }

  void judge_climb(const AirStep& step) {
    const double flown = speed_ * step.time_s;
    const double limit = step.way.z() < 0 ? limits_.max_descent() : limits_.max_climb;
    if (limit < kPi / 2 &&
        std::abs(step.way.z()) > flown * std::tan(limit) * (1 + 1e-6) + kLengthTolerance) {
      report("climb_angle", degrees(std::atan2(std::abs(step.way.z()), flown)), degrees(limit),
             "deg",
             step.way.z() < 0 ? "the descent angle through the air is %.9g degrees, above the "
                                "limit of %.9g degrees"
                              : "the climb angle through the air is %.9g degrees, above the limit "
                                "of %.9g degrees");
    }
  }

  void judge_turn(const AirStep& before, const AirStep& step) {
    if (!has_heading(before.way) || !has_heading(step.way)) {
      return;
    }
    const double flown = speed_ * (before.time_s + step.time_s) / 2;
    const double rounding =
        kAngleTolerance + 2 * kLengthTolerance * (1 / before.run() + 1 / step.run());
    const double turn = turn_angle_horizontal(before.way, step.way) - rounding;
    const double radius = turn > 0 ? flown / (2 * std::sin(turn / 2)) : kInfinity;
    if (radius < radius_ - kLengthTolerance) {
      report("turn_radius", radius, radius_, "m",
             "the track turns on a radius of %.9g m in the air, below the limit of %.9g m");
    }
  }

  /// Once for each limit.
  void report(const char* rule, double value, double limit, const char* unit, const char* format) {
    const bool is_known = std::any_of(found_.begin(), found_.end(), [&](const Violation& other) {
      return other.constraint == rule;
    });
    if (!is_known) {
      char message[128];
      std::snprintf(message, sizeof message, format, value, limit);
      found_.push_back({rule, at_, value, limit, message, "", unit});
    }
  }

  const Track& track_;
  const Wind& wind_;
  double speed_;
  double radius_;
  const Limits& limits_;
  std::size_t at_ = 0;
  std::vector<Violation> found_;
};
}  // namespace

std::vector<Violation> wing_violations(const Track& track, const Request& request,
                                       const Limits& limits) {
  return WingJudge(track, request, limits)();
}

Limits limits_of_legs(const Request& request) {
  Limits limits = request.limits;
  limits.min_turn_radius = 0;
  if (request.vehicle.wing) {
    limits.max_climb = kPi / 2;
    limits.max_sink.reset();
  }
  return limits;
}

double arrival_distance(const Request& request) {
  constexpr double kShare = 0.1;  // of the turn radius
  const auto& wing = request.vehicle.wing;
  return std::max(request.goal.tolerance_m, wing ? kShare * wing->turn_radius() : 0);
}

double distance_from(const Goal& goal, const Vec3& p) {
  const Vec3 way = p - goal.position;
  return goal.loiter ? std::hypot(way.head<2>().norm() - goal.loiter->radius, way.z()) : way.norm();
}

bool at_goal(const Vec3& p, const Request& request) {
  return distance_from(request.goal, p) <= arrival_distance(request) + kLengthTolerance;
}
}  // namespace altiplan::host
