// SPDX-License-Identifier: Apache-2.0
#include "body_judge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "altiplan/attributed.hpp"

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

  Matrix3d rotation() const {
    return (AngleAxisd(yaw.value_or(0), Vec3::UnitZ()) * AngleAxisd(-pitch, Vec3::UnitY()) *
            AngleAxisd(bank, Vec3::UnitX()))
        .toRotationMatrix();
  }
};

/// Yaw and pitch on a straight path with that displacement, at a height.
Attitude attitude_on(const Vec3& way, double z, const Request& request) {
  const Body& body = *request.vehicle.body;
  const double run = way.head<2>().norm();
  const auto ground_speed_there =
      run > 0 ? ground_speed(way, request.air_speed(), request.wind.at(z)) : std::nullopt;
  Attitude attitude{body.yaw, 0, 0};
  if (!attitude.yaw && has_heading(way)) {
    const auto into_air = request.vehicle.wing ? request.heading_on(way, z) : std::nullopt;
    attitude.yaw = into_air.value_or(std::atan2(way.y(), way.x()));
  }
  if (body.pitches) {
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
    return std::any_of(sweeps_.begin(), sweeps_.end(), [&](const Sweep& sweep) {
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
    if ((!is_short || sweep.bend > 0) &&
        !layer.blocked(ends.front().at, ends.back().at, outer + grown + kBodyTolerance)) {
      return false;
    }
    if (is_short) {
      if (!layer.meets({part, outer, ends, grown})) {
        return false;
      }
      if (bend <= kBodyTolerance / 2) {
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
    double begin = 0;
    std::vector<double> ends = request_.wind.crossings(a.z(), b.z());
    ends.push_back(1);
    for (const double end : ends) {
      const Vec3 from = begin == 0 ? a : Vec3(a + begin * way);
      const Vec3 to = end == 1 ? b : Vec3(a + end * way);
      Attitude now = attitude_on(way, (from.z() + to.z()) / 2, request_);
      now.yaw = now.yaw ? now.yaw : last.yaw;
      if (last.yaw || begin > 0) {
        add_rotation(from, last, now);
      }
      add_line(from, to, now);
      last = now;
      begin = end;
    }
  }

  Attitude attitude_before(const std::optional<Approach>& before, const Vec3& here) const {
    if (!before) {
      return {};
    }
    const Vec3 way = here - before->from;
    Attitude attitude = attitude_on(way, here.z(), request_);
    if (const Vec3 heading = before->heading_at(here); !attitude.yaw && has_heading(heading)) {
      attitude.yaw = attitude_on(heading, here.z(), request_).yaw;
    }
    return attitude;
  }

  void add_line(const Vec3& from, const Vec3& to, const Attitude& attitude) {
    if (attitude.yaw) {
      const Matrix3d rotation = attitude.rotation();
      sweeps_.push_back({[=](double t, std::vector<Placement>& all) {
                           all.push_back({rotation, from + t * (to - from)});
                         },
                         0, 0});
      return;
    }
    // The hull of the body at any heading.
    constexpr int kHeadings = 32;
    std::vector<Matrix3d> rotations;
    for (int n = 0; n < kHeadings; ++n) {
      rotations.push_back(Attitude{2 * kPi * n / kHeadings, attitude.pitch, 0}.rotation());
    }
    sweeps_.push_back({[=](double t, std::vector<Placement>& all) {
                         for (const Matrix3d& rotation : rotations) {
                           all.push_back({rotation, from + t * (to - from)});
                         }
                       },
                       0, bend_of(2 * kPi / kHeadings)});
  }

  /// Of a rotation by an angle about the reference point.
  double bend_of(double angle) const { return outer_ * angle * angle / 8; }

  void add_rotation(const Vec3& at, const Attitude& from, const Attitude& to) {
    const Matrix3d first = from.rotation();
    const AngleAxisd turn(to.rotation() * first.transpose());
    if (turn.angle() < 1e-9) {
      return;
    }
    const bool reverses = turn.angle() > kReversal;
    const double angle = reverses ? 2 * kPi : turn.angle();
    sweeps_.push_back({[=, axis = turn.axis()](double t, std::vector<Placement>& all) {
                         all.push_back({AngleAxisd(t * angle, axis) * first, at});
                       },
                       bend_of(angle), 0});
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
    const double yaw_rate = body_.yaw ? 0 : leg.turn;
    sweeps_.push_back({[=](double t, std::vector<Placement>& all) {
                         Attitude here = banked;
                         *here.yaw += t * yaw_rate;
                         all.push_back({here.rotation(), leg.at(t)});
                       },
                       leg.sagitta() + bend_of(yaw_rate), 0});
    *level.yaw += yaw_rate;
    *banked.yaw += yaw_rate;
    add_rotation(leg.to, banked, level);
  }

  const Request& request_;
  const Body& body_;
  double outer_;
  std::vector<Sweep> sweeps_;
};

/// True if the layer may come that near to the leg.
bool is_near(const Environment& layer, const Leg& leg, double reach) {
  return leg.turns()
             ? !every_piece(leg,
                            [&](const Piece& piece) {
                              return layer.blocked(piece.a, piece.b, reach + piece.e)
                                         ? piece.e < reach ? Verdict::violated : Verdict::halve
                                         : Verdict::kept;
                            })
             : layer.blocked(leg.from, leg.to, reach);
}
}  // namespace

std::vector<Sweep> body_sweeps(const std::optional<Approach>& before, const Leg& leg,
                               const Request& request) {
  return BodyOnLeg(before, leg, request).sweeps();
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
                     if (!is_near(environment, leg, reach)) {
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
