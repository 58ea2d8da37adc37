// SPDX-License-Identifier: Apache-2.0
// Take-offs and landings of aeroplanes.
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/autopilot/flight.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr double kBesidePath = 8;    // metres beside a path
constexpr double kRunOut = 200;      // metres beyond a landing's point
constexpr double kLevelsOff = 15;    // metres above a take-off's height
constexpr double kMaxClimb = 100e3;  // metres that a take-off may lead ahead
constexpr double kOffGround = 10;    // metres of a landing above the ground, as of a home

Eigen::Vector2d ahead(double heading) { return {std::cos(heading), std::sin(heading)}; }
}  // namespace

// AP_Landing_Slope: the slope leads to a point before the landing's, from which the flare takes it
// on. The greatest speed gives the lowest slope, and so does a flare that sinks at TECS_LAND_SINK
// all the time, as that of older versions.
Wing::Aim Wing::lowest_aim(double sinks_m, double length, double z) const {
  if (flight_.autopilot().is_px4() || sinks_m <= 0) {
    return {};
  }
  const double v = true_speed(1, z);
  const double flare = flight_.parameter("LAND_FLARE_ALT");
  const double by_time = flight_.parameter("LAND_FLARE_SEC") * sinks_m / length * v;
  const double height = by_time <= 0 ? flare : flare > 0 ? std::min(by_time, 2 * flare) : by_time;
  return {std::min(v * height / flight_.parameter("TECS_LAND_SINK"), length / 2),
          std::min(height, sinks_m)};
}

void Wing::land(std::size_t command, const Destination& to) {
  FlownPart& part = flight_.begin(command, "the landing");
  part.ground = FlownPart::Ground::touched_along;
  const std::optional<Whereabouts> joined = leave_joined(to);
  const Eigen::Vector2d begin = from_.at;
  const double begin_low = low();
  const double begin_high = high();
  const double foot = std::min(to.low, flight_.ground(to.at));
  const Vec3 touch(to.at.x(), to.at.y(), std::max(to.low, foot));
  part.foot_m = touch.z();
  const auto ground = flight_.world().ground(to.at.x(), to.at.y());
  if (const double off = touch.z() - ground.value_or(touch.z()); off > kOffGround) {
    flight_.remark(Remark::Weight::fails, "landing", command,
                   "ends " + with_decimals(off, 1) +
                       " m above the ground: an aeroplane lands at the height of the item",
                   off, kOffGround);
  }
  // Its turn onto the slope, which has no least height.
  Leg slope;
  slope.to = to;
  if (has_track_) {
    cut_corner(slope);
  }
  does_arrive_ = true;
  const double slope_min_m = std::exchange(slope_min_m_, 0);
  std::vector<std::vector<Passed>> passed(members_.size());
  for (std::size_t n = 0; n < members_.size(); ++n) {
    fly(members_[n], slope, passed[n]);
  }
  fill_between(passed);
  slope_min_m_ = slope_min_m;
  if (!does_arrive_) {
    flight_.remark(Remark::Weight::not_judged, "not_judged", command,
                   "how the aeroplane gets to its landing is not judged: it circles the point");
  }
  const double length = std::max((to.at - begin).norm(), 1.0);
  const double sinks = begin_high - touch.z();
  const double fast = true_speed(1, touch.z());
  const double needed = sinks / length * fast;
  if (!flight_.autopilot().is_px4() && needed > sink_mps_) {
    flight_.remark(Remark::Weight::fails, "sink_rate", command,
                   "the landing sinks faster than the autopilot's limit (TECS_SINK_MAX), and ends "
                   "beyond its point: begin it at least " +
                       with_decimals(std::ceil(sinks * fast / sink_mps_), 0) +
                       " m before, or at most " +
                       with_decimals(std::floor(length * sink_mps_ / fast), 0) + " m above it",
                   needed, sink_mps_);
  }
  const Aim aim = lowest_aim(begin_high - touch.z(), length, touch.z());
  const Eigen::Vector2d aimed = to.at + aim.before_m / length * (begin - to.at);
  const double drawn = touch.z() + aim.before_m / length * (begin_high - touch.z());
  const Vec3 lowest(aimed.x(), aimed.y(), std::min(touch.z() + aim.height_m, drawn));
  flight_.add_strip({begin.x(), begin.y(), begin_low}, begin_high, lowest, drawn, kBesidePath);
  flight_.add_strip(lowest, drawn, touch, touch.z(), kBesidePath);
  if (joined && length < to_settle(*joined)) {
    flight_.remark(Remark::Weight::not_judged, "not_judged", command,
                   "a landing that begins within " + with_decimals(to_settle(*joined), 0) +
                       " m of its point where a return joins the mission is not judged");
  }
  if (joined) {
    const double aimed_m = (aimed - begin).norm();
    flight_.add_fan(*joined, room_to_turn(fast), to.at,
                    {{0, begin_low, begin_high},
                     {aimed_m, lowest.z(), std::max(begin_high, drawn)},
                     {length, touch.z(), touch.z()}},
                    kBesidePath);
    flight_.take({0, kPi * room_to_turn(fast) / true_speed(0, touch.z())});
  }
  flight_.take({length / (speed_mps[1] + flight_.wind_mps),
                length / std::max(speed_mps[0] - flight_.wind_mps, 1.0) * 1.5 + 30});
  roll_out(command, touch, (to.at - begin).normalized());
}

void Wing::roll_out(std::size_t command, const Vec3& touch, const Eigen::Vector2d& course) {
  flight_.begin(command, "the roll-out").ground = FlownPart::Ground::touched_along;
  Vec3 before = touch;
  for (int step = 1; step <= 10; ++step) {  // on the ground, or a little above
    const Eigen::Vector2d beyond = touch.head<2>() + kRunOut * step / 10 * course;
    const Vec3 here(beyond.x(), beyond.y(), flight_.ground(beyond));
    flight_.add_strip(before, before.z() + 2, here, here.z() + 2, kBesidePath);
    before = here;
  }
  flight_.take({});
}

void Wing::take_off(std::size_t command, const Eigen::Vector2d& from, double heading, double z,
                    double spread) {
  FlownPart& part = flight_.begin(command, "the climb after take-off");
  part.ground = FlownPart::Ground::touched_along;
  const double foot = part.foot_m = flight_.ground(from);
  const double height = std::max(z - foot, 1.0);
  const bool is_px4 = flight_.autopilot().is_px4();
  const double against = speed_mps[0] / std::max(speed_mps[0] - flight_.wind_mps, 1.0);
  const double with = speed_mps[1] / (speed_mps[1] + flight_.wind_mps);
  const double steep =
      against * (is_px4 ? flight_.parameter("FW_T_CLMB_MAX") / speed_mps[0]
                        : std::tan(radians(flight_.parameter("PTCH_LIM_MAX_DEG"))));
  const double shallow = with * (is_px4 ? 2 / speed_mps[1] : std::tan(radians(4)));
  const bool is_judged = height / shallow <= kMaxClimb;
  if (!is_judged) {
    flight_.remark(Remark::Weight::not_judged, "not_judged", command,
                   "a climb after take-off that may lead " +
                       std::to_string(std::lround(height / shallow / 1000)) +
                       " km ahead is not judged: give it a lower altitude, and climb on by "
                       "waypoints or a circle");
  }
  const int gaps = is_judged ? int(std::ceil(spread * height / shallow / kBesidePath)) : 0;
  for (int ray = 0; ray <= gaps; ++ray) {  // side by side
    const double course = heading + spread * (2.0 * ray / std::max(gaps, 1) - 1);
    const Vec3 near(from.x() + height / steep * std::cos(course),
                    from.y() + height / steep * std::sin(course), foot + shallow * height / steep);
    const Vec3 far(from.x() + height / shallow * std::cos(course),
                   from.y() + height / shallow * std::sin(course), z);
    flight_.add_strip({from.x(), from.y(), foot}, foot, near, z, kBesidePath);
    flight_.add_strip(near, is_px4 ? z : z + kLevelsOff, far, is_px4 ? z : z + kLevelsOff,
                      kBesidePath);
  }
  flight_.take({height / steep / (speed_mps[1] + flight_.wind_mps),
                height / shallow / std::max(speed_mps[0] - flight_.wind_mps, 1.0) + 10});
  start_on(from + height / steep * ahead(heading), from + height / shallow * ahead(heading), z);
  if (!is_px4) {  // it levels off late, and fast
    for (Member& member : members_) {
      member.high = z + kLevelsOff;
    }
    changing_mps_[1] *= 1.25;
  }
}
}  // namespace altiplan::host
