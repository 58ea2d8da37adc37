// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <queue>
#include <vector>

#include "altiplan/leg.hpp"
#include "reference/body_obstacles.hpp"
#include "reference/random_bodies.hpp"

// Motions of a body that turns, moment by moment, and its least gap to obstacles on them: no point
// of it moves faster than a bound, so that the moments between two are known to within it.
namespace altiplan::oracle {

struct Moment {
  Matrix held;
  Vector at;
};

/// Over t in [0, 1].
struct Motion {
  std::function<Moment(Real)> moment;
  Real speed;  ///< no point of the body moves by more per t
};

inline Real outer(const RandomBody& body) {
  Real most = 0;
  for (const Convex& part : body.parts) {
    for (const Vector& p : part.points) {
      most = std::max(most, p.norm() + part.ball);
    }
  }
  return most;
}

inline Gap gap_at(const Obstacles& obstacles, const RandomBody& body, const Moment& moment) {
  Gap least;
  for (const Convex& part : body.parts) {
    least = nearer(least, obstacles.gap(placed(part, moment.held, moment.at)));
  }
  return least;
}

/// The least gap on a motion, by best-first halving.
inline Gap gap_on(const Obstacles& obstacles, const RandomBody& body, const Motion& motion) {
  constexpr Real kEnough = 1e-4L;    // metres
  constexpr Real kTouching = 1e-9L;  // more than what separation() leaves of no gap
  constexpr int kMostMoments = 5000;
  struct Part {
    Real begin, end, at_begin, at_end, low;
  };
  const auto nearer_low = [](const Part& a, const Part& b) { return a.low > b.low; };
  std::priority_queue<Part, std::vector<Part>, decltype(nearer_low)> open(nearer_low);
  Gap least;
  const auto examine = [&](Real t) {
    const Gap gap = gap_at(obstacles, body, motion.moment(t));
    if (gap.high < least.high) {
      least = gap;
    }
    return gap.low;
  };
  const auto add = [&](Real begin, Real end, Real at_begin, Real at_end) {
    open.push(
        {begin, end, at_begin, at_end, (at_begin + at_end - motion.speed * (end - begin)) / 2});
  };
  const Real first = examine(0);
  add(0, 1, first, examine(1));
  for (int n = 0;
       n < kMostMoments && least.high > kTouching && open.top().low < least.high - kEnough; ++n) {
    const Part part = open.top();
    open.pop();
    const Real middle = (part.begin + part.end) / 2;
    const Real there = examine(middle);
    add(part.begin, middle, part.at_begin, there);
    add(middle, part.end, there, part.at_end);
  }
  least.low = std::min(least.low, open.top().low);
  return least;
}

/// By an angle about a unit axis: O. Rodrigues' formula.
inline Matrix rotation(const Vector& axis, Real angle) {
  Matrix cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Matrix::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * cross * cross;
}

/// The shortest rotation on the spot from one attitude to another, less than half a turn.
inline Motion rotating(const RandomBody& body, const Matrix& from, const Matrix& to,
                       const Vec3& at) {
  const Matrix turn = to * from.transpose();
  const Vector twice(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  const Real angle = std::atan2(twice.norm(), turn.trace() - 1);
  const Vector axis = twice.norm() > 0 ? Vector(twice.normalized()) : Vector(0, 0, 1);
  return {[=](Real t) -> Moment {
            return {rotation(axis, t * angle) * from, exact(at)};
          },
          angle* outer(body)};
}

/// All headings on the spot.
inline Motion turning_round(const RandomBody& body, const Matrix& from, const Vec3& at) {
  const Real angle = 2 * Real(kPi);
  return {[=](Real t) -> Moment {
            return {rotation({0, 0, 1}, t * angle) * from, exact(at)};
          },
          angle* outer(body)};
}

/// Banked toward the inside of a turn to the left, or by a negative angle to the right.
inline Matrix banked(const Matrix& level, Real bank) {
  const Vector forward = level.col(0);
  const Vector left = level.col(1);
  const Vector up = level.col(2);
  Matrix all;
  all << forward, std::cos(bank) * left - std::sin(bank) * up,
      std::cos(bank) * up + std::sin(bank) * left;
  return all;
}

/// An arc without wind, with the rolls at its ends.
inline std::vector<Motion> on_arc(const RandomBody& body, const Leg& leg, double speed_mps) {
  const Real rise = leg.to.z() - leg.from.z();
  const Real length = std::abs(Real(leg.turn)) * leg.radius;
  const Real pitch = body.body->pitches ? std::atan2(rise, length) : 0;
  const Real lean =
      std::atan(Real(speed_mps) * speed_mps / (9.80665L * leg.radius)) * (leg.turn > 0 ? 1 : -1);
  const auto level = [=, fixed = body.body->yaw](Real t) {
    return axes(fixed ? Real(*fixed) : leg.heading + t * leg.turn, pitch);
  };
  const auto at = [=](Real t) -> Vector {
    const Real inside = leg.turn > 0 ? leg.radius : -leg.radius;
    const Real now = leg.heading + t * leg.turn;
    return exact(leg.from) + Vector(inside * (std::sin(now) - std::sin(Real(leg.heading))),
                                    inside * (std::cos(Real(leg.heading)) - std::cos(now)),
                                    t * rise);
  };
  return {{[=](Real t) -> Moment {
             return {banked(level(0), t * lean), at(0)};
           },
           std::abs(lean) * outer(body)},
          {[=](Real t) -> Moment {
             return {banked(level(t), lean), at(t)};
           },
           std::hypot(length, rise) + std::abs(Real(leg.turn)) * outer(body)},
          {[=](Real t) -> Moment {
             return {banked(level(1), t * lean), at(1)};
           },
           std::abs(lean) * outer(body)}};
}
}  // namespace altiplan::oracle
