// SPDX-License-Identifier: Apache-2.0
#include "body_judge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "altiplan/attributed.hpp"
#include "altiplan/check.hpp"

#include "pieces.hpp"

namespace altiplan {
namespace {
using Eigen::AngleAxisd;
using Eigen::Matrix3d;

constexpr double kGravity = 9.80665;  // m/s²
/// A reversal: rounding decides on which side the body turns.
constexpr double kReversal = kPi - 1e-6;

/// How a body is held. Without a yaw any is possible.
struct Attitude {
  std::optional<double> yaw;
  double pitch = 0;
  double bank = 0;  ///< positive: the right side is down

  bool operator==(const Attitude&) const = default;
  Matrix3d rotation() const {
    return (AngleAxisd(yaw.value_or(0), Vec3::UnitZ()) * AngleAxisd(-pitch, Vec3::UnitY()) *
            AngleAxisd(bank, Vec3::UnitX()))
        .toRotationMatrix();
  }
};

/// Yaw and pitch on a straight path with that displacement, at a place.
Attitude attitude_on(const Vec3& way, const Vec3& at, const Request& request) {
  const Body& body = *request.vehicle.body;
  Attitude attitude{body.yaw, 0, 0};
  if (!attitude.yaw && has_heading(way)) {
    const auto into_air = request.vehicle.wing ? request.heading_on(way, at) : std::nullopt;
    attitude.yaw = into_air.value_or(std::atan2(way.y(), way.x()));
  }
  if (body.pitches) {
    const double run = way.head<2>().norm();
    const auto ground_speed_there =
        run > 0 ? ground_speed(way, request.air_speed(), request.wind.at(at)) : std::nullopt;
    const double through_air =
        ground_speed_there ? run * request.air_speed() / *ground_speed_there : run;
    attitude.pitch = std::atan2(way.z(), through_air);
  }
  return attitude;
}

class BodyOnLeg {
 public:
  BodyOnLeg(const std::optional<Approach>& before, const Leg& leg, const Request& request)
      : request_(request), body_(*request.vehicle.body), outer_(body_.outer_m()) {
    sweeps_.reserve(4);
    if (leg.turns()) {
      add_turn(before, leg);
    } else {
      add_straight(before, leg.from, leg.to);
    }
  }

  bool meets(const Environment& layer) const {
    // The last first: lines are checked at less cost than the rotations before them.
    return std::any_of(sweeps_.rbegin(), sweeps_.rend(), [&](const Sweep& sweep) {
      return std::any_of(body_.parts.begin(), body_.parts.end(), [&](const BodyPart& part) {
        return part_meets(layer, part, sweep, 0, 1);
      });
    });
  }
  const std::vector<Sweep>& sweeps() const { return sweeps_; }

 private:
  /// By halving: a piece may be met where its volume is, and surely if the body at its middle is.
  bool part_meets(const Environment& layer, const BodyPart& part, const Sweep& sweep, double begin,
                  double end) const {
    std::vector<Placement> ends;
    ends.reserve(2);
    sweep.place(begin, ends);
    sweep.place(end, ends);
    const double outer = part.outer_m;
    const double bend = sweep.bend * (end - begin) * (end - begin);
    const double grown = bend + sweep.between;
    const double length = (ends.back().at - ends.front().at).norm();
    const double middle = (begin + end) / 2;
    const bool is_short = length <= std::max(16 * outer, 1.0) || middle <= begin || middle >= end;
    // Long volumes have many obstacles about them, and rotations take several: the sphere around
    // the part tells most.
    const double reach = outer + (sweep.turn ? grown : 0) + kBodyTolerance;
    if ((!is_short || sweep.bend > 0) && !layer.blocked(ends.front().at, ends.back().at, reach)) {
      return false;
    }
    if (is_short) {
      if (!layer.meets({part, outer, ends, grown})) {
        return false;
      }
      // The convex hull of both ends connects different points of the body too.
      const double excess = bend + std::abs(sweep.angle) * (end - begin) * outer / 2;
      if (excess <= kBodyTolerance / 2) {
        return true;
      }
      std::vector<Placement> half;
      sweep.place(middle, half);
      if (layer.meets({part, outer, half, sweep.between})) {
        return true;
      }
    }
    return part_meets(layer, part, sweep, begin, middle) ||
           part_meets(layer, part, sweep, middle, end);
  }

  void add_straight(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    const Vec3 way = b - a;
    if (way.isZero(0)) {
      return;
    }
    Attitude last = attitude_before(before, a);
    Vec3 from = a;
    bool is_first = true;
    const auto add_piece = [&](const Vec3& to) {
      Attitude now = attitude_on(way, (from + to) / 2, request_);
      now.yaw = now.yaw ? now.yaw : last.yaw;
      if (last.yaw || !is_first) {
        add_rotation(from, last, now);
      }
      add_line(from, to, now);
      last = now;
      from = to;
      is_first = false;
    };
    for (const double crossing : request_.wind.crossings(a, b)) {
      add_piece(a + crossing * way);
    }
    add_piece(b);
  }

  Attitude attitude_before(const std::optional<Approach>& before, const Vec3& here) const {
    if (!before) {
      return {};
    }
    const Vec3 way = here - before->from;
    Attitude attitude = attitude_on(way, here, request_);
    if (const Vec3 heading = before->heading_at(here); !attitude.yaw && has_heading(heading)) {
      attitude.yaw = attitude_on(heading, here, request_).yaw;
    }
    return attitude;
  }

  void add_line(const Vec3& from, const Vec3& to, const Attitude& attitude) {
    Sweep sweep{attitude.rotation(), from, to - from};
    if (!attitude.yaw) {
      sweep.headings = 32;
      sweep.between = bend_of(2 * kPi / sweep.headings);
    }
    sweeps_.push_back(sweep);
  }

  /// Of a rotation by an angle about the reference point.
  double bend_of(double angle) const { return outer_ * angle * angle / 8; }

  void add_rotation(const Vec3& at, const Attitude& from, const Attitude& to) {
    if (from == to) {
      return;
    }
    const Matrix3d first = from.rotation();
    const AngleAxisd turn(to.rotation() * first.transpose());
    if (turn.angle() < 1e-9) {
      return;
    }
    Sweep sweep{first, at};
    sweep.angle = turn.angle() > kReversal ? 2 * kPi : turn.angle();
    sweep.axis = turn.axis();
    sweep.bend = bend_of(sweep.angle);
    sweeps_.push_back(sweep);
  }

  void add_turn(const std::optional<Approach>& before, const Leg& leg) {
    const double speed = request_.air_speed();
    const double rise = leg.to.z() - leg.from.z();
    Attitude level{body_.yaw.value_or(leg.heading),
                   body_.pitches ? std::atan2(rise, leg.air_length()) : 0, 0};
    Attitude banked = level;
    banked.bank = -std::copysign(std::atan(speed * speed / (kGravity * leg.radius)), leg.turn);
    if (const Attitude last = attitude_before(before, leg.from); last.yaw) {
      add_rotation(leg.from, last, level);
    }
    add_rotation(leg.from, level, banked);
    Sweep sweep{banked.rotation(), leg.from};
    sweep.turn = leg;
    sweep.angle = body_.yaw ? 0 : leg.turn;
    sweep.bend = leg.sagitta() + bend_of(sweep.angle);
    sweeps_.push_back(sweep);
    *level.yaw += sweep.angle;
    *banked.yaw += sweep.angle;
    add_rotation(leg.to, banked, level);
  }

  const Request& request_;
  const Body& body_;
  double outer_;
  std::vector<Sweep> sweeps_;
};

/// True if the layer may come that near to the turn.
bool is_near(const Environment& layer, const Leg& turn, double reach) {
  return !every_piece(turn, [&](const Piece& piece) {
    return layer.blocked(piece.a, piece.b, reach + piece.e)
               ? piece.e < reach ? Verdict::violated : Verdict::halve
               : Verdict::kept;
  });
}
}  // namespace

void Sweep::place(double t, std::vector<Placement>& all) const {
  const Vec3 at = turn ? turn->at(t) : Vec3(from + t * way);
  if (headings > 1) {
    for (int n = 0; n < headings; ++n) {
      all.push_back({AngleAxisd(2 * kPi * n / headings, Vec3::UnitZ()) * rotation, at});
    }
  } else if (angle != 0 && t > 0) {
    all.push_back({AngleAxisd(t * angle, axis) * rotation, at});
  } else {
    all.push_back({rotation, at});
  }
}

std::vector<Sweep> body_sweeps(const std::optional<Approach>& before, const Leg& leg,
                               const Request& request) {
  return BodyOnLeg(before, leg, request).sweeps();
}

bool body_ok(const std::optional<Approach>& before, const Leg& leg, const Request& request) {
  const double reach = request.vehicle.reach_m() + kBodyTolerance;
  return request.vehicle.body == nullptr ||
         (!leg.turns() && request.world->blocked_by(leg.from, leg.to, reach) == nullptr) ||
         body_meets(before, leg, request) == nullptr;
}

const Layer* body_meets(const std::optional<Approach>& before, const Leg& leg,
                        const Request& request) {
  if (request.vehicle.body == nullptr) {
    return nullptr;
  }
  const double reach = request.vehicle.body->outer_m() + kBodyTolerance;
  Box about = (leg.turns() ? leg.box() : leg_box(leg.from, leg.to)).grown(reach);
  about.min.z() = -kInfinity;  // a ground reaches further down than its bounds
  std::optional<BodyOnLeg> body;
  for (const Layer& layer : request.world->layers()) {
    if (!layer.environment->bounds().overlaps(about)) {
      continue;
    }
    const bool meets =
        attributed([&] { return "the layer '" + layer.id + "' (" + layer.plugin + ")"; },
                   [&] {
                     const Environment& environment = *layer.environment;
                     if (leg.turns() && !is_near(environment, leg, reach)) {
                       return false;
                     }
                     if (!body) {
                       body.emplace(before, leg, request);
                     }
                     return body->meets(environment);
                   });
    if (meets) {
      return &layer;
    }
  }
  return nullptr;
}
}  // namespace altiplan
