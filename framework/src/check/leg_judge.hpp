// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/request.hpp"
#include "altiplan/swept_volume.hpp"
#include "constraint_answers.hpp"
#include "leg_parts.hpp"
#include "pieces.hpp"
#include "words.hpp"

namespace altiplan {

/// Checks one leg against every constraint, the cheap ones first: one call of `report` (with a
/// function that makes the violation) per violated constraint, until report returns false.
template <class Report>
class LegJudge {
 public:
  LegJudge(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
           const Request& request, std::size_t at, const Report& report)
      : before_(before),
        a_(a),
        b_(b),
        leg_(b - a),
        request_(request),
        limits_(request.limits),
        at_(at),
        report_(report) {}

  /// A turn, a wait, or a straight leg as above.
  LegJudge(const std::optional<Approach>& before, const Leg& leg, const Request& request,
           std::size_t at, const Report& report)
      : LegJudge(before, leg.from, leg.to, request, at, report) {
    if (leg.turns()) {
      turn_ = &leg;
      leg_ = leg.track(0);
    }
    wait_ = leg.waits() ? &leg : nullptr;
  }

  void judge() const {
    if (!is_finite(a_) || !is_finite(b_)) {
      report_([&] { return Violation{"finite", at_, 0, 0, "a coordinate is not finite"}; });
      return;
    }
    if (const std::string problem = wait_ != nullptr   ? wait_problem(*wait_, request_)
                                    : turn_ != nullptr ? turn_problem(*turn_)
                                                       : "";
        !problem.empty()) {
      report_([&] { return Violation{"route", at_, 0, 0, problem}; });
      return;
    }
    (void)(keeps_place(a_, at_) && keeps_place(b_, at_ + 1) && keeps_turn() && keeps_size() &&
           keeps_bend() && keeps_heights() && keeps_constraints() && keeps_off() && keeps_body());
  }
  void judge_bend() const { (void)keeps_bend(); }

 private:
  // Each returns whether to continue. `scale` converts value and limit to the message's unit.
  bool at_least(double value, double limit, double tolerance, const char* rule, const char* what,
                const char* unit, double scale = 1) const {
    return value >= limit - tolerance || report_([&] {
             return beyond(rule, at_, value * scale, limit * scale, unit, what, true);
           });
  }
  bool at_most(double value, double limit, double tolerance, const char* rule, const char* what,
               const char* unit, double scale = 1) const {
    return value <= limit + tolerance || report_([&] {
             return beyond(rule, at_, value * scale, limit * scale, unit, what, false);
           });
  }
  /// `angle` is evaluated only if the limit is below `widest`, the maximum of any angle.
  template <class Angle>
  bool at_most_angle(const Angle& angle, double limit, double widest, const char* rule,
                     const char* what) const {
    return limit >= widest ||
           at_most(angle(), limit, kAngleTolerance, rule, what, "deg", degrees(1));
  }

  bool keeps_place(const Vec3& p, std::size_t index) const {
    if (!request_.volume.contains(p, kLengthTolerance) && !report_([&] {
          const double outside =
              std::max((request_.volume.min - p).maxCoeff(), (p - request_.volume.max).maxCoeff());
          return Violation{"volume",
                           index,
                           outside,
                           0,
                           place(p) + " lies " + fixed(outside) + " m outside the volume",
                           "",
                           "m"};
        })) {
      return false;
    }
    return !request_.level_m || std::abs(p.z() - *request_.level_m) <= kLengthTolerance ||
           report_([&] {
             return Violation{
                 "level_flight",
                 index,
                 p.z(),
                 *request_.level_m,
                 place(p) + " is not on the level of " + fixed(*request_.level_m) + " m",
                 "",
                 "m"};
           });
  }

  /// The geometry that a turn alone has: its box, its radius, and the drift of the air.
  bool keeps_turn() const {
    if (turn_ == nullptr) {
      return true;
    }
    const Box& box = box_ = turn_->box();
    if (!request_.volume.contains(box.min, kLengthTolerance) ||
        !request_.volume.contains(box.max, kLengthTolerance)) {
      const double outside = std::max((request_.volume.min - box.min).maxCoeff(),
                                      (box.max - request_.volume.max).maxCoeff());
      if (!report_([&] {
            return Violation{
                "volume", at_, outside, 0, "the turn leaves the volume by " + fixed(outside) + " m",
                "",       "m"};
          })) {
        return false;
      }
    }
    return at_least(turn_->radius, limits_.min_turn_radius, kLengthTolerance, "turn_radius",
                    "the turn radius", "m") &&
           keeps_drift();
  }

  bool keeps_drift() const {
    const double speed = request_.air_speed();
    const double time = turn_->air_length() / speed;
    // Its ends may lie on a border, beside which it is on one side.
    const Vec3 drift = time * request_.wind.at((box_.min + box_.max) / 2);
    const bool crosses = !request_.wind.is_uniform(box_);
    const double off = (turn_->drift - drift).norm();
    return (off <= kLengthTolerance && !crosses) || report_([&] {
             return Violation{"wind",
                              at_,
                              off,
                              0,
                              crosses ? "the turn crosses a border of the wind: cut it there"
                                      : "the turn drifts by " + place(turn_->drift) +
                                            " m, where the wind at its height carries it by " +
                                            place(drift) + " m",
                              "",
                              "m"};
           });
  }

  /// Climb angle through the air, which moves with the wind: the greatest in any of its layers.
  double climb_of_leg() const {
    if (turn_ != nullptr) {
      return std::atan2(std::abs(b_.z() - a_.z()), turn_->air_length());
    }
    if (request_.wind.is_calm() || !has_heading(leg_)) {
      return climb_angle(leg_);
    }
    double climb = climb_through_air(a_, b_);
    in_each_wind([&](const Vec3& from, const Vec3& to) {
      if (std::abs(to.z() - from.z()) > kLengthTolerance) {  // a leg may end on a border
        climb = std::max(climb, climb_through_air(from, to));
      }
    });
    return climb;
  }
  double climb_through_air(const Vec3& from, const Vec3& to) const {
    const double speed = request_.air_speed();
    return std::atan2(std::abs(to.z() - from.z()),
                      flight_time(from, to, speed, request_.wind) * speed);
  }

  bool keeps_course() const {
    return turn_ != nullptr || request_.wind.is_calm() || !has_heading(leg_) ||
           std::isfinite(flight_time(a_, b_, request_.air_speed(), request_.wind)) || report_([&] {
             const double wind = request_.wind.at(beaten_at()).norm();
             return Violation{
                 "wind",
                 at_,
                 wind,
                 request_.air_speed(),
                 "the leg cannot be flown: an airspeed of " + fixed(request_.air_speed()) +
                     " m/s does not hold its course in a wind of " + fixed(wind) + " m/s",
                 "",
                 "m/s"};
           });
  }

  /// Where on a leg that cannot be flown its course is not held.
  Vec3 beaten_at() const {
    Vec3 place = (a_ + b_) / 2;
    in_each_wind([&](const Vec3& from, const Vec3& to) {
      if (!std::isfinite(flight_time(from, to, request_.air_speed(), request_.wind))) {
        place = (from + to) / 2;
      }
    });
    return place;
  }

  /// Calls `use(from, to)` for the parts of a straight leg between borders of the wind.
  template <class Use>
  void in_each_wind(const Use& use) const {
    Vec3 from = a_;
    std::vector<double> ends = request_.wind.crossings(a_, b_);
    ends.push_back(1);
    for (const double end : ends) {
      const Vec3 to = a_ + end * leg_;
      use(from, to);
      from = to;
    }
  }

  bool keeps_size() const {
    if (wait_ != nullptr) {
      return true;
    }
    const double run = turn_ != nullptr ? turn_->length() : leg_.norm();
    return at_least(run, limits_.min_leg, kLengthTolerance, "leg_length", "the leg's length",
                    "m") &&
           at_most(run, limits_.max_leg, kLengthTolerance, "leg_length", "the leg's length", "m") &&
           at_most_angle([&] { return climb_of_leg(); },
                         b_.z() < a_.z() ? limits_.max_descent() : limits_.max_climb, kPi / 2,
                         "climb_angle",
                         b_.z() < a_.z() ? "the descent angle" : "the climb angle") &&
           keeps_course();
  }

  bool keeps_bend() const {
    if (!before_ || wait_ != nullptr || (turn_ != nullptr && leg_.norm() < kLengthTolerance)) {
      return true;  // of no length: the next leg is judged by the approach to it (onward)
    }
    const bool on_the_spot = request_.vehicle.turns_on_the_spot;
    // A turn begins along its tangent.
    const Vec3 next = turn_ != nullptr ? Vec3(a_ + leg_) : b_;
    return at_most_angle([&] { return horizontal_turn(*before_, a_, next, on_the_spot); },
                         limits_.max_turn_horizontal, kPi, "turn_angle", "the turn angle") &&
           at_most_angle([&] { return turn_angle_in_space(a_ - before_->from, leg_); },
                         limits_.max_turn_space, kPi, "turn_angle", "the turn angle") &&
           (limits_.min_turn_radius == 0 ||
            (turn_ != nullptr || before_->turning
                 ? keeps_tangent()
                 : at_least(corner_radius(*before_, a_, b_, on_the_spot), limits_.min_turn_radius,
                            kLengthTolerance, "turn_radius", "the turn radius", "m")));
  }

  /// Beside a turn there is no leg left to fillet a corner: it must join its neighbours
  /// tangentially, up to the rounding of a straight leg's ends. Legs below a metre count as one:
  /// many of them, each within the tolerance, would make a corner.
  bool keeps_tangent() const {
    const double corner =
        horizontal_turn(*before_, a_, a_ + leg_, request_.vehicle.turns_on_the_spot);
    const double reach = std::max(1.0, std::min((a_ - before_->from).norm(), leg_.norm()));
    return corner <= kAngleTolerance || corner * reach <= kLengthTolerance || report_([&] {
             return Violation{"turn_radius",
                              at_,
                              0,
                              limits_.min_turn_radius,
                              "the leg begins with a corner of " + fixed(degrees(corner), 6) +
                                  " degrees beside a turn, where it must be tangential",
                              "",
                              "m"};
           });
  }

  bool keeps_heights() const {
    const World& world = *request_.world;
    Vec3 end = a_;
    const bool over_ground = is_over_ground(end);
    if (!over_ground && !report_([&] {
          return Violation{"ground", at_, 0, 0,
                           "there is no ground of known height below " +
                               place(turn_ != nullptr ? end : ground_ends(world, a_, b_)) +
                               ", a point of the leg"};
        })) {
      return false;
    }
    for (const AltitudeBand& band : limits_.altitude) {
      if ((over_ground || band.datum == AltitudeBand::Datum::sea) && !keeps_band(band)) {
        return false;
      }
    }
    return !limits_.min_ground_clearance || !over_ground ||
           keeps_above(*limits_.min_ground_clearance, "ground_clearance",
                       "the height above ground");
  }

  bool keeps_band(const AltitudeBand& band) const {
    if (band.datum == AltitudeBand::Datum::sea) {
      return at_least(std::min(a_.z(), b_.z()), band.min, kLengthTolerance, "altitude",
                      "the altitude", "m") &&
             at_most(std::max(a_.z(), b_.z()), band.max, kLengthTolerance, "altitude",
                     "the altitude", "m");
    }
    const char* height = "the height above ground";
    return keeps_above(band.min, "altitude", height) &&
           (band.max == kInfinity || keeps_below(band.max, "altitude", height));
  }

  /// `looked_at` begins the part of a turn that was looked at last: where the ground ends.
  bool is_over_ground(Vec3& looked_at) const {
    const World& world = *request_.world;
    if (turn_ == nullptr || !world.has_ground()) {
      return world.ground_below(a_, b_);
    }
    // A finite slope means that the ground has no hole in the box.
    return std::isfinite(slope_of_turn()) || every_piece(*turn_, [&](const Piece& piece) {
             looked_at = piece.a;
             const bool is_whole = piece.last || std::isfinite(slope_about(piece));
             return is_whole && world.ground_below(piece.a, piece.b) ? Verdict::kept
                                                                     : Verdict::halve;
           });
  }

  double slope_about(const Piece& piece) const {
    return request_.world->ground_slope(leg_box(piece.a, piece.b).grown(piece.e));
  }

  /// Decides a piece, given the greatest difference in height of the ground below a point of it and
  /// below its partner on the chord: by the slope of the whole turn, which is asked for once, and
  /// if that does not decide by its own.
  template <class Decide>
  Verdict by_ground(const Piece& piece, const Decide& decide) const {
    if (piece.last) {
      return decide(0.0);
    }
    Verdict verdict = Verdict::halve;
    if (std::isfinite(slope_of_turn())) {
      verdict = decide(piece.e * slope_of_turn());
    }
    if (verdict != Verdict::halve) {
      return verdict;
    }
    const double slope = slope_about(piece);
    return std::isfinite(slope) ? decide(piece.e * slope) : verdict;
  }

  double slope_of_turn() const {
    if (std::isnan(slope_)) {
      slope_ = request_.world->ground_slope(box_.grown(required_clearance(request_)));
    }
    return slope_;
  }

  bool keeps_above(double limit, const char* rule, const char* what) const {
    const World& world = *request_.world;
    if (turn_ == nullptr) {
      return at_least(world.ground_gap(a_, b_, limit), limit, kLengthTolerance, rule, what, "m");
    }
    double gap = kInfinity;
    const bool is_kept = every_piece(*turn_, [&](const Piece& piece) {
      return by_ground(piece, [&](double error) {
        gap = world.ground_gap(piece.a, piece.b, limit + error);
        return gap >= limit + error - kLengthTolerance  ? Verdict::kept
               : gap < limit - error - kLengthTolerance ? Verdict::violated
                                                        : Verdict::halve;
      });
    });
    height_kept_ = is_kept ? std::max(height_kept_, limit) : height_kept_;
    return is_kept || report_([&] { return beyond(rule, at_, gap, limit, "m", what, true); });
  }

  bool keeps_below(double limit, const char* rule, const char* what) const {
    const World& world = *request_.world;
    if (turn_ == nullptr) {
      return at_most(world.ground_gap_max(a_, b_), limit, kLengthTolerance, rule, what, "m");
    }
    double gap = 0;
    const bool is_kept = every_piece(*turn_, [&](const Piece& piece) {
      gap = world.ground_gap_max(piece.a, piece.b);
      return by_ground(piece, [&](double error) {
        return gap <= limit - error + kLengthTolerance  ? Verdict::kept
               : gap > limit + error + kLengthTolerance ? Verdict::violated
                                                        : Verdict::halve;
      });
    });
    return is_kept || report_([&] { return beyond(rule, at_, gap, limit, "m", what, false); });
  }

  bool keeps_constraints() const {
    if (std::all_of(request_.constraints.begin(), request_.constraints.end(),
                    [](const NamedConstraint& named) { return named.admits_all; })) {
      return true;
    }
    std::optional<Vec3> before = before_ ? std::optional(before_->from) : std::nullopt;
    if (turn_ == nullptr) {
      return admitted({before, a_, b_, request_.world.get()});
    }
    const Polyline points = turn_->chords(kChordTolerance);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      if (!admitted({before, points[i], points[i + 1], request_.world.get()})) {
        return false;
      }
      before = points[i];
    }
    return true;
  }

  bool admitted(const Motion& motion) const {
    return std::all_of(request_.constraints.begin(), request_.constraints.end(),
                       [&](const NamedConstraint& named) {
                         return named.admits_all || named.admits(motion) ||
                                report_([&] { return refusal(named, motion); });
                       });
  }

  /// What the constraint says of the leg as a route, if it says more than that it refuses it.
  Violation refusal(const NamedConstraint& named, const Motion& motion) const {
    const std::vector<Violation> said = violations_of(named, {motion.from, motion.to}, request_);
    if (said.empty()) {
      return {named.name, at_, 0, 0,
              "the constraint does not admit the leg from " + place(motion.from) + " to " +
                  place(motion.to)};
    }
    Violation violation = said.front();
    violation.at = at_;
    return violation;
  }

  bool keeps_off() const {
    const double needed = required_clearance(request_);
    if (request_.vehicle.body != nullptr && turn_ == nullptr) {
      const double reach = request_.vehicle.reach_m() + kBodyTolerance;
      is_clear_ = needed <= reach && request_.world->blocked_by(a_, b_, reach) == nullptr;
      if (is_clear_) {
        return true;
      }
    }
    const Layer* layer =
        turn_ == nullptr ? request_.world->blocked_by(a_, b_, needed) : turn_blocked_by(needed);
    return layer == nullptr || report_([&] {
             return too_near(layer, turn_ != nullptr ? *turn_ : Leg::straight(a_, b_), request_,
                             at_);
           });
  }

  bool keeps_body() const {
    if (request_.vehicle.body == nullptr || is_clear_) {
      return true;
    }
    const Leg leg = turn_ != nullptr ? *turn_ : Leg::straight(a_, b_);
    const Layer* layer = body_meets(before_, leg, request_);
    return layer == nullptr || report_([&] { return body_violation(*layer, leg, request_, at_); });
  }

  const Layer* turn_blocked_by(double needed) const {
    const double slope = height_kept_ > -kInfinity ? slope_of_turn() : kInfinity;
    return blocked_by(*request_.world, *turn_, box_, needed, {height_kept_, slope});
  }

  const std::optional<Approach>& before_;
  const Vec3& a_;
  const Vec3& b_;
  const Leg* turn_ = nullptr;  ///< null: the leg is straight
  const Leg* wait_ = nullptr;  ///< null: the vehicle does not wait
  Vec3 leg_;                   ///< its displacement, or the rate at which a turn begins
  mutable Box box_;            ///< of the turn
  /// Of the ground within the required clearance of it; NaN: not yet asked.
  mutable double slope_ = std::nan("");
  mutable bool is_clear_ = false;            ///< of obstacles, in any attitude of the body
  mutable double height_kept_ = -kInfinity;  ///< above ground, that a turn is known to have
  const Request& request_;
  const Limits& limits_;
  std::size_t at_;
  const Report& report_;
};
}  // namespace altiplan
