// SPDX-License-Identifier: Apache-2.0
// ArduPilot's aeroplane (AP_L1_Control, AP_TECS, altitude.cpp) and PX4's (FixedWingModeManager,
// DirectionalGuidance). The ways that a plan leaves open, of speed and of when a turn begins, are
// flown one by one with the autopilot's law of guidance (Park, Deyst and How 2004, equation 1).
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/autopilot/flight.hpp"

namespace altiplan::host {
namespace {

constexpr double kTimeStep = 0.4;        // seconds
constexpr double kLevel = 0.05;          // metres
constexpr double kOnTrack = 1;           // metres: the reach of the track itself
constexpr double kAnewAbove = 4;         // metres: 5, but for what it swings
constexpr double kReach = 8;             // metres: more than half of a step of time
constexpr int kFractions = 5;            // of the distance at which a turn begins
constexpr double kPx4HeightRadius = 10;  // NAV_FW_ALT_RAD
constexpr double kPx4LevelBefore = 80;   // metres before an item at which its ramp has ended

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}
Eigen::Vector2d unit(double heading) { return {std::cos(heading), std::sin(heading)}; }
Eigen::Vector2d turned_by(const Eigen::Vector2d& by, const Eigen::Vector2d& v) {
  return {by.x() * v.x() - by.y() * v.y(), by.x() * v.y() + by.y() * v.x()};
}
/// True airspeed an indicated one, in the standard atmosphere. Autopilots that measure a warm or a
/// cold sensor are some percent off.
double air_ratio(double z) {
  return std::pow(1 - 2.25577e-5 * std::clamp(z, -500.0, 9000.0), -2.128);
}
constexpr double kAboveGround = 10;    // metres that a height above the ground is kept within
constexpr double kSwings = 1.4;        // how far it swings out when it joins a circle
constexpr double kEitherWay = 2.5;     // radians to turn, beyond which it turns left or right
constexpr double kClimbInTurn = 0.45;  // the same while it turns
constexpr double kStarts = 2;          // seconds until it climbs
constexpr double kTurning = 0.3;       // of the greatest turn, from which on it counts as one
constexpr double kColdest = 0.97;
constexpr double kWarmest = 1.08;
}  // namespace

HeldRates held_rates(formats::Autopilot autopilot, const ParameterFile& parameters, double z) {
  const Parameters value(autopilot, parameters);
  if (autopilot.is_px4()) {
    return {Wing::kSlow * value("FW_T_CLMB_R_SP"), Wing::kSlow * value("FW_T_SINK_R_SP")};
  }
  const double faster = air_ratio(z) * kWarmest;
  return {kClimbInTurn * value("TECS_CLMB_MAX") / faster,
          Wing::kSlow * value("TECS_SINK_MAX") / faster};
}

Wing::Wing(Flight& flight) : flight_(flight) {
  const bool is_px4 = flight.autopilot().is_px4();
  climb_mps_ = flight.parameter(is_px4 ? "FW_T_CLMB_R_SP" : "TECS_CLMB_MAX");
  sink_mps_ = flight.parameter(is_px4 ? "FW_T_SINK_R_SP" : "TECS_SINK_MAX");
  l1_s_ =
      is_px4 ? 2.24 : 0.318 * flight.parameter("NAVL1_DAMPING") * flight.parameter("NAVL1_PERIOD");
  slope_min_m_ = is_px4 ? 0 : flight.parameter("ALT_SLOPE_MIN");
  lag_s_ = is_px4 ? 1 : flight.parameter("TECS_HDEM_TCONST");
  const double v = flight.parameter(is_px4 ? "FW_AIRSPD_TRIM" : "AIRSPEED_CRUISE");
  set_speed(v, v);
}

void Wing::set_speed(double slowest, double fastest) {
  // On its next leg it may still be as fast as before.
  changing_mps_[0] = is_flying() ? std::min(changing_mps_[0], slowest) : slowest;
  changing_mps_[1] = is_flying() ? std::max(changing_mps_[1], fastest) : fastest;
  speed_mps[0] = slowest;
  speed_mps[1] = fastest;
}

double Wing::max_turn_rate(double v) const {
  const double bank =
      radians(flight_.parameter(flight_.autopilot().is_px4() ? "FW_R_LIM" : "ROLL_LIMIT_DEG"));
  return kGravity * std::tan(bank) / v;
}

void Wing::make_members(const std::function<Member(int, double)>& make) {
  members_.clear();
  for (int speed = 0; speed < 2; ++speed) {
    for (int n = 0; n < kFractions; ++n) {
      members_.push_back(make(speed, double(n) / (kFractions - 1)));
    }
  }
}

void Wing::start(const Eigen::Vector2d& at, double z, const Eigen::Vector2d& toward, bool is_item) {
  make_members([&](int speed, double fraction) {
    return Member{at, bearing_of(toward - at), z, z, speed, fraction};
  });
  from_ = {at, z, z, {}};
  has_track_ = is_item;
}

void Wing::start_on(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double z) {
  const double heading = bearing_of(to - from);
  make_members([&](int speed, double fraction) {
    return Member{from + fraction * (to - from),
                  heading + radians(20 * fraction - 10),
                  z,
                  z,
                  speed,
                  fraction};
  });
  from_ = {from, z, z, {}};
  has_track_ = false;
}

Eigen::Vector2d Wing::mean_place() const {
  Eigen::Vector2d sum(0, 0);
  for (const Member& member : members_) {
    sum += member.at;
  }
  return sum / double(std::max<std::size_t>(members_.size(), 1));
}

double Wing::low() const {
  double low = kInfinity;
  for (const Member& member : members_) {
    low = std::min(low, member.low);
  }
  return low;
}

double Wing::high() const {
  double high = -kInfinity;
  for (const Member& member : members_) {
    high = std::max(high, member.high);
  }
  return high;
}

double Wing::true_airspeed(int speed, double z) const {
  return changing_mps_[speed] *
         (flight_.autopilot().is_px4() ? 1 : air_ratio(z) * (speed == 0 ? kColdest : kWarmest));
}

double Wing::true_speed(int speed, double z) const {
  constexpr double kLeast = 1;  // against the wind
  return std::max(true_airspeed(speed, z) + (speed == 0 ? -1 : 1) * flight_.wind_mps, kLeast);
}

double Wing::turn_distance(double v, const Leg& leg) const {
  if (flight_.autopilot().is_px4()) {
    return std::max(flight_.parameter("NAV_ACC_RAD"), l1_s_ * v);
  }
  if (leg.acceptance_m > 0) {
    return leg.acceptance_m;
  }
  if (leg.pass_by_m > 0) {
    return 0;
  }
  double angle = kPi / 2;
  if (leg.next && !leg.turns_at_90) {
    const Eigen::Vector2d in = leg.to.at - from_.at;
    const Eigen::Vector2d out = leg.next->at - leg.to.at;
    angle = std::abs(std::atan2(cross(in, out), in.dot(out)));
  }
  const double ratio = air_ratio(leg.to.low) * kWarmest;
  return std::min(flight_.parameter("WP_RADIUS") * ratio * ratio, l1_s_ * v) *
         std::min(angle, kPi / 2) / (kPi / 2);
}

std::array<double, 2> Wing::sought_heights(const Leg& leg, const Destination& from,
                                           const Eigen::Vector2d& at, double share) const {
  const bool is_px4 = flight_.autopilot().is_px4();
  double low = kInfinity;
  double high = -kInfinity;
  if (leg.to.above_ground) {
    const auto begun = flight_.known_grounds(from.at);
    const auto grounds = flight_.known_grounds(at);
    for (const int ground : {0, 1}) {
      for (const double start : {from.low, from.high}) {
        const double above = from.above_ground.value_or(start - begun[ground]);
        const double sought = grounds[ground] + above + share * (*leg.to.above_ground - above);
        low = std::min(low, sought);
        high = std::max(high, sought);
      }
    }
    return {low, high};
  }
  for (const double to : {leg.to.low, leg.to.high}) {
    for (const double start : {from.low, from.high, std::clamp(to, from.low, from.high)}) {
      const double sought = sought_height(leg, from, start, to, share);
      low = std::min(low, sought);
      high = std::max(high, sought);
    }
  }
  // It may be above the ramp by now, or climb steeply up to CLIMB_SLOPE_HGT. A ramp from a height
  // above the ground is cut at the number of that height, as if it were one above the sea.
  constexpr double kSteepBelow = 25;
  const bool may_climb_steeply = !sinks_ && from.low < flight_.home_ground + kSteepBelow;
  const bool may_be_steep = !has_track_ || may_climb_steeply;
  if (may_be_steep && !is_px4) {
    return {std::min(low, leg.to.low), std::max(high, leg.to.high)};
  }
  if (from.above_ground && !is_px4) {
    return {std::min(low, leg.to.low), high};
  }
  return {low, high};
}

double Wing::sought_height(const Leg& leg, const Destination& from, double start, double to,
                           double share) const {
  if (flight_.autopilot().is_px4()) {
    const double length = (leg.to.at - from.at).norm();
    const double level = std::max(kPx4LevelBefore, l1_s_ * speed_mps[1]);
    if (leg.at_once || !has_track_ || length <= level) {
      return to;
    }
    return start + (to - start) * std::min(1.0, share * length / (length - level));
  }
  const bool is_at_once = (leg.at_once && to >= start) || std::abs(to - start) < slope_min_m_;
  return is_at_once ? to : start + share * (to - start);
}

double Wing::highest_ahead(const Leg& leg, const Destination& from, const Eigen::Vector2d& at,
                           const Eigen::Vector2d& track, double left, double v) const {
  constexpr double kLook = 100;  // metres
  const double slope = climb_mps_ / 2 / v;
  const double far = std::min(left, flight_.parameter("TERRAIN_LOOKAHD"));
  double highest = -kInfinity;
  for (double ahead = kLook; ahead <= far; ahead += kLook) {
    const auto grounds = flight_.known_grounds(at + ahead * track);
    highest = std::max(highest, std::max(grounds[0], grounds[1]) - ahead * slope);
  }
  const auto begun = flight_.known_grounds(from.at);
  const double before = from.above_ground.value_or(from.high - std::min(begun[0], begun[1]));
  return highest + std::max(before, *leg.to.above_ground);
}

double Wing::slow_climb_of(bool turns) const {
  return flight_.autopilot().is_px4() ? kSlow : turns ? kClimbInTurn : kSlowClimb;
}

void Wing::seek_heights(Member& member, double sought, double highest, double seconds,
                        double slow_climb) const {
  // The low one sinks quickly and climbs slowly, the high one the other way round.
  const auto seek = [&](double z, double wanted, double sinks, double climbs) {
    const double quick = wanted < z ? sinks : std::max(climbs, kSlow);
    return z + seconds * std::clamp((wanted - z) / (lag_s_ / (quick * quick)), -sink_mps_ * sinks,
                                    climb_mps_ * climbs);
  };
  member.low = seek(member.low, sought, kQuick, slow_climb);
  member.high = seek(member.high, highest, kSlow, kQuick);
}

double Wing::fly(Member& member, const Leg& leg, std::vector<Passed>& passed) {
  const double v = true_speed(member.speed, leg.to.low);
  const double distance = member.fraction * turn_distance(v, leg);
  const Destination from =
      has_track_ ? from_ : Destination{member.at, member.low, member.high, std::nullopt};
  const Eigen::Vector2d begin = from.at;
  const Eigen::Vector2d along = leg.to.at - begin;
  const double length = std::max(along.norm(), 1e-6);
  const Eigen::Vector2d track = along / length;
  const double finish = length + leg.pass_by_m;
  const double l1 = l1_s_ * v;
  // ArduPilot scales the radius of its circle, too.
  const double ratio = air_ratio(leg.to.low) * (member.speed == 0 ? kColdest : kWarmest);
  const double circle_m = leg.circle_m * ratio * ratio;
  // The slow roll into tight turns, the fast into wide ones.
  const double weak = member.speed == 0 || flight_.autopilot().is_px4() ? 1 : kWeakTurn;
  const double max_rate = max_turn_rate(v);
  const double roll = max_rate * kTimeStep / (member.speed == 0 ? 0.4 : 1.2);
  double rate = 0;
  const bool is_rough = leg.to.above_ground.has_value();
  const bool climbed = member.climbs;
  // ArduPilot begins its climb anew where it is above it (ALT_SLOPE_MAXHGT).
  struct Anew {
    double share;
    double high;
  };
  std::optional<Anew> anew;
  const bool climbs =
      !flight_.autopilot().is_px4() && !is_rough && leg.to.low - from.low >= slope_min_m_;
  const int max_steps = int((4 * (length + (member.at - begin).norm()) / v + 200) / kTimeStep);
  Vec3 before(member.at.x(), member.at.y(), member.low);
  double before_high = member.high;
  double drawn_heading = member.heading;
  double seconds = 0;
  double undrawn = 0;
  bool was_on_line = false;
  Eigen::Vector2d velocity = unit(member.heading);  // its direction
  for (int step = 0;; ++step) {
    if (step == max_steps) {
      does_arrive_ = false;
      break;
    }
    const Eigen::Vector2d off = member.at - begin;
    const double done = off.dot(track);
    if ((leg.to.at + leg.pass_by_m * track - member.at).norm() <= distance || done >= finish) {
      break;
    }
    // Steer to the place on the track that lies the distance of guidance ahead.
    const bool is_behind = off.norm() > l1 && done < -0.7071 * off.norm();
    const bool is_near = (leg.to.at - member.at).norm() < 3 * circle_m;
    // ArduPilot points at the item itself, or at the beginning of a track that lies ahead.
    const bool is_direct = !flight_.autopilot().is_px4() && (!has_track_ || is_behind || is_near);
    const double beside = is_direct ? 0 : cross(track, off);
    const Eigen::Vector2d target = has_track_ && is_behind ? begin : leg.to.at;
    const Eigen::Vector2d along_track =
        is_direct ? Eigen::Vector2d((target - member.at).normalized()) : track;
    const double to_track = std::asin(std::clamp(beside / l1, -0.7071, 0.7071));
    const double from_track = std::atan2(cross(along_track, velocity), along_track.dot(velocity));
    // ArduPilot's angle may be more than half a turn, which it takes on the side of its heading.
    double eta = -(from_track + to_track);
    eta = flight_.autopilot().is_px4() ? std::remainder(eta, 2 * kPi) : eta;
    const double turns = flight_.autopilot().is_px4() ? eta : from_track;
    if (std::abs(turns) > kEitherWay) {  // some fly on the left, some on the right
      eta = int(std::lround(member.fraction * (kFractions - 1))) % 2 == 0 ? 1 : -1;
      eta *= kEitherWay;
    }
    eta = std::clamp(eta, -kPi / 2, kPi / 2);
    const double wanted = weak * std::clamp(2.25 * v / l1 * std::sin(eta), -max_rate, max_rate);
    rate += std::clamp(wanted - rate, -roll, roll);
    const double dt = std::min(kTimeStep, std::max((finish - done) / v, 0.02));
    const double turned = rate * dt;
    const Eigen::Vector2d half = unit(turned / 2);  // a turn by half of it
    const Eigen::Vector2d middle = turned_by(half, velocity);
    velocity = turned_by(half, middle);
    member.at += v * dt * middle;
    member.heading += turned;
    seconds += dt;
    undrawn += v * dt;
    const double way = (member.at - begin).dot(track);
    const bool is_before_item = way <= length;
    const double share = std::clamp(way / length, 0.0, 1.0);
    const auto [sought, ramp_high] = sought_heights(leg, from, member.at, share);
    double sought_high = ramp_high;
    if (anew && leg.to.low - anew->high < slope_min_m_) {
      sought_high = std::max(ramp_high, leg.to.low);
    } else if (anew) {
      const double done_anew = (share - anew->share) / std::max(1 - anew->share, 1e-6);
      sought_high = std::max(ramp_high, anew->high + done_anew * (leg.to.low - anew->high));
    }
    if (climbs && member.high > sought_high + kAnewAbove) {
      anew = {share, member.high};
    }
    const double old_low = member.low;
    const double old_high = member.high;
    const double highest =
        is_rough
            ? std::max(sought_high, highest_ahead(leg, from, member.at, track, finish - done, v))
            : sought_high;
    const bool starts = !climbed && seconds < kStarts;
    const double slow_climb = starts ? 0 : slow_climb_of(std::abs(rate) > kTurning * max_rate);
    seek_heights(member, sought, highest, dt, slow_climb);
    member.climbs = member.low > old_low;
    const bool is_level =
        std::abs(member.low - old_low) < 1e-3 && std::abs(member.high - old_high) < 1e-3;
    const bool bends = std::abs(member.heading - drawn_heading) > 0.05;
    const double line =
        leg.at_once || is_rough ? sought : from.low + share * (leg.to.low - from.low);
    const Vec3 here(member.at.x(), member.at.y(), std::min({member.low, sought, line}));
    const double here_high = std::max({member.high, highest, line});
    const bool is_settled =
        has_track_ && std::abs(cross(track, off)) < kOnTrack && std::abs(from_track) < 0.05;
    passed.push_back({here, here_high, is_settled});
    if (bends || !is_level || (is_rough && undrawn > 15) || undrawn > 200) {
      const double nominal = from.low + share * (leg.to.low - from.low);
      const bool is_on_line = has_track_ && !is_rough && is_before_item &&
                              std::abs(cross(track, member.at - begin)) < kOnTrack &&
                              std::max(here_high - nominal, nominal - here.z()) < kLevel;
      if (!(was_on_line && is_on_line)) {  // else the track itself covers it
        flight_.add_strip(before, before_high, here, here_high, is_rough ? kAboveGround : kReach);
      }
      was_on_line = is_on_line;
      before = here;
      before_high = here_high;
      drawn_heading = member.heading;
      undrawn = 0;
    }
  }
  const bool is_on_line = was_on_line && (member.at - begin).dot(track) <= length + kOnTrack &&
                          member.high - member.low < kLevel &&
                          std::abs(member.low - leg.to.low) < kLevel;
  if (!is_on_line) {
    flight_.add_strip(before, before_high, {member.at.x(), member.at.y(), member.low}, member.high,
                      kReach);
  }
  return seconds;
}

void Wing::circle_until_high(std::size_t command, const Leg& leg) {
  const double off = std::max(std::abs(low() - leg.to.low), std::abs(high() - leg.to.low));
  if (!flight_.autopilot().is_px4() || leg.to.above_ground || off <= kPx4HeightRadius) {
    return;
  }
  circle(command, "its circle until the height is reached", leg.to,
         flight_.parameter("NAV_LOITER_RAD"), true,
         {0, off / std::min(climb_mps_, sink_mps_), true}, leg.next, false);
}

void Wing::cut_corner(const Leg& leg) {
  if (!before_) {
    return;
  }
  const Vec3 corner = from_.point();
  const Vec3 back = before_->point() - corner;
  const Vec3 onward = leg.to.point() - corner;
  const double room_back = back.head<2>().norm();
  const double room_onward = onward.head<2>().norm();
  if (room_back < 1 || room_onward < 1) {
    return;
  }
  const double spread = std::max(from_.high - from_.low, leg.to.high - leg.to.low);
  const int chords = int(std::ceil(cut_m_ / kReach));
  for (int n = 1; n <= chords; ++n) {
    const double before = cut_m_ * n / chords;
    const Vec3 a = corner + back * std::min(1.0, before / room_back);
    const Vec3 b = corner + onward * std::min(1.0, before / room_onward);
    flight_.add_strip(
        {a.x(), a.y(), std::min(a.z(), corner.z())}, std::max(a.z(), corner.z()) + spread,
        {b.x(), b.y(), std::min(b.z(), corner.z())}, std::max(b.z(), corner.z()) + spread, kReach);
  }
}

void Wing::fill_between(const std::vector<std::vector<Passed>>& passed) {
  const std::size_t half = passed.size() / 2;  // of each of the speeds
  const auto fill = [&](const std::vector<Passed>& one, const std::vector<Passed>& other) {
    for (std::size_t n = 0; n < std::min(one.size(), other.size()); ++n) {
      const Passed& a = one[n];
      const Passed& b = other[n];
      if (a.is_settled && b.is_settled) {
        return;
      }
      if ((a.at - b.at).head<2>().norm() > kReach) {
        flight_.add_strip(a.at, a.high, b.at, b.high, kReach);
      }
    }
  };
  for (std::size_t n = 0; n < half; ++n) {
    fill(passed[n], passed[n + half]);
    if (n + 1 < half) {
      fill(passed[n], passed[n + 1]);
      fill(passed[n + half], passed[n + 1 + half]);
    }
  }
}

void Wing::go(std::size_t command, const char* what, const Leg& leg) {
  flight_.begin(command, what).speed_mps = speed_mps[1];
  TimeSpan time{kInfinity, 0};
  std::optional<Whereabouts> still_joined;
  if (const auto joined = leave_joined(leg.to)) {
    const auto [arrival, way_time] = add_ways(*joined, leg.to, 0, 0);
    time = way_time;
    const double v = true_speed(1, std::max(joined->high_m, leg.to.high));
    if ((leg.to.at - joined->at).norm() < to_settle(*joined)) {
      still_joined = arrival;
      still_joined->radius_m = room_to_turn(v) + std::max(turn_distance(v, leg), leg.pass_by_m);
    }
    if (leg.to.above_ground) {
      flight_.remark(Remark::Weight::not_judged, "not_judged", command,
                     "the first way of a return along the mission to a height above the ground is "
                     "not judged");
    }
  }
  does_arrive_ = true;
  sinks_ = low() > leg.to.high && from_.low >= leg.to.high;
  if (has_track_) {
    cut_corner(leg);
  }
  if (has_track_) {
    // The track itself, which the latest turn overshoots and the first one cuts.
    const Vec3 a = from_.point();
    if (!leg.to.above_ground && !from_.above_ground) {
      flight_.add_leg(a, from_.high, leg.to.point(), leg.to.high, kBesideTrack);
    }
  }
  std::vector<std::vector<Passed>> passed(members_.size());
  for (std::size_t n = 0; n < members_.size(); ++n) {
    const double seconds = fly(members_[n], leg, passed[n]);
    time.min_s = std::min(time.min_s, 0.95 * seconds);
    time.max_s = std::max(time.max_s, 1.05 * seconds + 2);
  }
  fill_between(passed);
  flight_.take(time);
  if (!does_arrive_) {
    flight_.remark(Remark::Weight::not_judged, "not_judged", command,
                   "how the aeroplane gets here is not judged: it circles the item");
  }
  const double length = (leg.to.at - from_.at).norm();
  const double rise = leg.to.low - from_.low;
  const double limit = rise > 0 ? climb_mps_ : sink_mps_;
  const double needed = length > 0 ? std::abs(rise) / length * speed_mps[1] : 0;
  if (has_track_ && !flight_.autopilot().is_px4() && !leg.to.above_ground && needed > limit) {
    flight_.remark(Remark::Weight::fails, rise > 0 ? "climb_rate" : "sink_rate", command,
                   std::string(rise > 0 ? "climbs" : "sinks") +
                       " faster than the autopilot's limit (" +
                       (rise > 0 ? "TECS_CLMB_MAX" : "TECS_SINK_MAX") +
                       "): the item is passed at another height",
                   needed, limit);
  }
  before_ = has_track_ ? std::optional(from_) : std::nullopt;
  cut_m_ = turn_distance(true_speed(1, leg.to.low), leg);
  changing_mps_[0] = speed_mps[0];
  changing_mps_[1] = speed_mps[1];
  circle_until_high(command, leg);
  from_ = leg.to;
  has_track_ = true;
  joined_ = still_joined;
}

std::array<double, 2> Wing::lags_on_circle(const Destination& centre, double radius,
                                           double v) const {
  constexpr int kSides = 48;
  std::array<double, 2> lags = {kAboveGround, kAboveGround};
  for (const double sense : {-1.0, 1.0}) {
    Member member{};
    for (int side = 0; side <= 2 * kSides; ++side) {  // the first round brings it into step
      const auto grounds =
          flight_.known_grounds(centre.at + radius * unit(sense * 2 * kPi * side / kSides));
      const auto [lowest, highest] = std::minmax(grounds[0], grounds[1]);
      if (side == 0) {
        member.low = lowest;
        member.high = highest;
      }
      seek_heights(member, lowest, highest, 2 * kPi * radius / kSides / v, slow_climb_of(true));
      lags[0] = std::max(lags[0], lowest - member.low + kAboveGround);
      lags[1] = std::max(lags[1], member.high - highest + kAboveGround);
    }
  }
  return lags;
}

double Wing::steady_radius(double radius, double z) const {
  // ArduPilot scales the radius, too.
  const double ratio = flight_.autopilot().is_px4() ? 1 : air_ratio(z) * kWarmest;
  const double v = true_speed(1, z);
  return std::max(radius * ratio * ratio, v / (kWeakest * max_turn_rate(v)));
}

double Wing::widest_radius(double radius, double z) const {
  const double steady = steady_radius(radius, z);
  const bool is_tight = steady == steady_radius(0, z);
  // Faster than its circle allows, it flies loops beside it.
  const double carried = true_speed(1, z) / true_airspeed(1, z);  // by the wind
  return (is_tight ? 2 : kSwings * carried) * steady;
}

std::array<double, 2> Wing::heights_at(const Destination& to, const Eigen::Vector2d& at) const {
  if (!to.above_ground) {
    return {to.low, to.high};
  }
  const auto grounds = flight_.known_grounds(at);
  const auto [lowest, highest] = std::minmax(grounds[0], grounds[1]);
  return {lowest + *to.above_ground, highest + *to.above_ground};
}

void Wing::circle(std::size_t command, const char* what, const Destination& centre, double radius,
                  bool clockwise, const Stay& stay, const std::optional<Destination>& next,
                  bool leaves_on_tangent) {
  joined_.reset();
  flight_.begin(command, what).speed_mps = speed_mps[1];
  const double z = heights_at(centre, centre.at)[0];
  double below = 0;  // the height that is sought
  double above = 0;
  for (const Member& member : members_) {
    const auto [lowest, highest] = heights_at(centre, member.at);
    below = std::max(below, lowest - member.low);
    above = std::max(above, member.high - highest);
  }
  const double v = true_speed(1, z);
  const double steady = steady_radius(radius, z);
  const double widest = widest_radius(radius, z);
  // A small circle is joined from within; a large one along a tangent, or beyond it.
  const double inner = radius < 150 ? 0 : 0.75 * radius;
  const std::array<double, 2> lags =
      centre.above_ground ? lags_on_circle(centre, steady, v) : std::array<double, 2>{0, 0};
  if (centre.above_ground) {
    flight_.add_disc(centre, inner, widest, -below - lags[0], above + lags[1]);
  } else {
    flight_.add_disc(centre, inner, widest, centre.low - below, centre.high + above);
  }
  const double round = 2 * kPi * radius;
  const double climb = std::max(below, above) / std::min(climb_mps_, sink_mps_);
  const double stays_s =
      stay.seconds + stay.turns * round / (speed_mps[1] + flight_.wind_mps) * 0.9;
  flight_.take(
      {stays_s, stay.seconds + climb +
                    (stay.turns + 1) * round / std::min(speed_mps[0], true_speed(0, z)) * 1.1});
  const double sense = clockwise ? -1 : 1;
  if (!next) {                   // it may leave it anywhere
    constexpr int kPlaces = 13;  // the last one is the first
    members_.clear();
    for (int n = 0; n < 2 * kPlaces; ++n) {
      members_.push_back({centre.at, 2 * kPi * n / (kPlaces - 1), z, z, n / kPlaces, 0.5});
    }
  }
  // ArduPilot stays for its turns or its time, whether it has reached the height or not.
  const bool is_level = stay.until_high || flight_.autopilot().is_px4();
  const double left_below =
      is_level ? 0 : std::max(below - kClimbInTurn * climb_mps_ * stays_s, 0.0);
  const double left_above = is_level ? 0 : std::max(above - kSlow * sink_mps_ * stays_s, 0.0);
  for (Member& member : members_) {
    Eigen::Vector2d p = member.at;
    for (int n = 0; n < 4; ++n) {
      const Eigen::Vector2d toward = next ? next->at - p : unit(member.heading);
      const double heading = bearing_of(toward) + (member.fraction - 0.5) * radians(20);
      const double scaled = member.speed == 0 ? radius : 1.1 * steady;
      p = centre.at + scaled * unit(heading - sense * kPi / 2);
      member.heading = heading;
    }
    member.at = p;
    const auto [lowest, highest] = heights_at(centre, p);
    member.low = lowest - left_below - lags[0];
    member.high = highest + left_above + lags[1];
  }
  from_ = centre;
  before_.reset();
  has_track_ = !leaves_on_tangent || flight_.autopilot().is_px4();
  if (leaves_on_tangent) {
    from_.at = mean_place();
  }
}
}  // namespace altiplan::host
