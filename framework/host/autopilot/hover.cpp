// SPDX-License-Identifier: Apache-2.0
// ArduPilot's copter (AC_WPNav, SCurve, mode_auto), and PX4's (FlightTaskAuto, PositionSmoothing).
#include <algorithm>
#include <cmath>

#include "host/autopilot/flight.hpp"

namespace altiplan::host {
namespace {

constexpr double kGroundStep = 10;    // metres between heights above the ground
constexpr double kCornerSpacing = 4;  // metres between the chords of a corner
constexpr double kAtEdge = 3;         // metres within which it is on a circle
// Metres that it swings out of a circle above the ground, and below it: as seen in ArduPilot's
// simulation (docs/decisions/0006).
constexpr double kCircleSwing = 2.5;
constexpr double kTerrainMargin = 10;  // metres: WP_TER_MARGIN
constexpr double kMaxRounds = 40;      // of a circle above the ground, that are followed
constexpr double kAtHome = 10;         // metres within which a return only goes up and down
constexpr double kTouchDown = 10;      // metres above the ground from which it sinks slowly
constexpr double kBeginsBeside = 10;   // metres beside its place at which a landing begins

/// The height of the ground as ArduPilot's copter follows it: within its rates and accelerations.
struct LaggingGround {
  double mps2;
  double z = 0;
  double rate = 0;

  double follow(double ground, double seconds, double sink, double climb, double margin) {
    constexpr double kStep = 0.2;
    const int steps = int(std::ceil(seconds / kStep));
    const double dt = seconds / steps;
    for (int n = 0; n < steps; ++n) {
      const double wanted = std::clamp(ground - z, -sink, climb);
      rate += std::clamp(wanted - rate, -mps2 * dt, mps2 * dt);
      z += rate * dt;
    }
    z = std::clamp(z, ground - margin, ground + margin);
    return z;
  }
};

const char* climb_parameter(formats::Autopilot autopilot) {
  return autopilot.is_px4()      ? "MPC_Z_V_AUTO_UP"
         : autopilot.is_copter() ? "WP_SPD_UP"
                                 : "Q_WP_SPD_UP";
}

const char* sink_parameter(formats::Autopilot autopilot) {
  return autopilot.is_px4()      ? "MPC_Z_V_AUTO_DN"
         : autopilot.is_copter() ? "WP_SPD_DN"
                                 : "Q_WP_SPD_DN";
}

Vec3 at_height(const Eigen::Vector2d& at, double z) { return {at.x(), at.y(), z}; }
}  // namespace

Hover::Hover(Flight& flight, const Eigen::Vector2d& place, double z)
    : at(place), low(z), high(z), flight_(flight) {
  constexpr double kOfQuadPlane = 5;  // Q_WP_SPD
  const bool hovers_alone = flight.autopilot().is_px4() || flight.autopilot().is_copter();
  speed_mps[0] = speed_mps[1] = hovers_alone ? flight.cruise_mps() : kOfQuadPlane;
  climb_mps[0] = climb_mps[1] = flight.parameter(climb_parameter(flight.autopilot()));
  sink_mps[0] = sink_mps[1] = flight.parameter(sink_parameter(flight.autopilot()));
}

std::array<double, 2> Hover::climb_rates() const {
  const double own = flight_.parameter(climb_parameter(flight_.autopilot()));
  return {std::min(own, climb_mps[0]), std::max(own, climb_mps[1])};
}

std::array<double, 2> Hover::sink_rates() const {
  const double own = flight_.parameter(sink_parameter(flight_.autopilot()));
  return {std::min(own, sink_mps[0]), std::max(own, sink_mps[1])};
}

double Hover::climb_acceleration() const {
  return flight_.autopilot().is_copter() ? flight_.parameter("WP_ACC_Z") : 1;
}

double Hover::reach(double acceptance) const {
  const formats::Autopilot autopilot = flight_.autopilot();
  if (!autopilot.is_px4()) {
    return autopilot.is_copter() ? flight_.parameter("WP_RADIUS_M") : 2;
  }
  return acceptance > 0 ? acceptance : flight_.parameter("NAV_ACC_RAD");
}

void Hover::climb(std::size_t command, const char* what, double low_m, double high_m) {
  flight_.begin(command, what).ground =
      is_on_ground ? FlownPart::Ground::touched_from_above : FlownPart::Ground::kept_off;
  for (const Eigen::Vector2d& place : leave_circle()) {
    const auto [bottom, top] = heights_at(place);
    flight_.add_column(place, std::min(bottom, low_m), std::max(top, high_m),
                       std::min(reach(), 2.0));
  }
  if (left_) {
    left_->centre.above_ground.reset();
  }
  const double minimum = std::max({low_m - high, low - high_m, 0.0});
  const double maximum = std::max(high_m - low, high - low_m);
  const auto [slow_climb, fast_climb] = climb_rates();
  const double first =
      flight_.autopilot().is_px4() ? flight_.parameter("MPC_TKO_SPEED") : slow_climb;
  const bool rises = low_m >= low;
  const double fastest = rises ? std::max(first, fast_climb) : sink_rates()[1];
  const double slowest = rises ? std::min(first, slow_climb) : sink_rates()[0];
  flight_.take({minimum / fastest, maximum / slowest + 5});
  low = low_m;
  high = high_m;
  previous_.reset();
  stops = true;
  is_on_ground = false;
}

void Hover::return_from(std::size_t command, const Whereabouts& place, double low_m, double high_m,
                        const Eigen::Vector2d& to) {
  const double off_line = flight_.autopilot().is_px4() ? 1 : std::min(reach(), 10.0);
  const double climbs_m = std::max(low_m - high, 0.0);
  if (low_m != low || high_m != high) {
    // What the mission may pass is judged with it, and the ground lies below that.
    flight_.begin(command, "the climb of its return").ground =
        FlownPart::Ground::touched_from_above;
    flight_.add_tower(place, std::min(low, low_m), std::max(high, high_m), std::min(reach(), 2.0));
    const auto [slowest, fastest] = climb_rates();
    flight_.take({climbs_m / fastest, (high_m - low) / slowest + 5});
  }
  low = low_m;
  high = high_m;
  const bool is_there = place.radius_m <= kAtHome && (to - place.at).norm() <= place.radius_m;
  flight_.begin(command, "the way home").ground =
      is_there ? FlownPart::Ground::touched_from_above : FlownPart::Ground::kept_off;
  flight_.add_fan(place, 0, to, {{0, low, high}}, off_line);
  const double along = (to - place.at).norm();
  flight_.take({std::max(along - place.radius_m, 0.0) / speed_mps[1],
                (along + place.radius_m) / speed_mps[0] + 6.5});
  at = to;
}

void Hover::join(std::size_t command, const Whereabouts& place, const Destination& to) {
  FlownPart& way = flight_.begin(command, "the way back to the mission");
  way.speed_mps = speed_mps[1];
  const double along = (to.at - place.at).norm();
  const double near = place.radius_m;
  if (flight_.autopilot().is_px4() && near <= kAtHome + reach() && along <= near + 1) {
    way.ground = FlownPart::Ground::touched_from_above;  // up or down, where it takes off or lands
  }
  std::vector<Flight::Level> levels{
      {0, std::min(place.low_m, to.low), std::max(place.high_m, to.high)}};
  if (along > 2 * near + 1) {
    // A way that begins as far away as may be sinks first, one that begins nearby climbs last.
    const auto early = [&](double from, double end) {
      return from + 2 * near / (along + near) * (end - from);
    };
    const double low = to.low < place.low_m ? early(place.low_m, to.low) : place.low_m;
    const double high = to.high > place.high_m ? early(place.high_m, to.high) : place.high_m;
    levels = {{-near, place.low_m, place.high_m}, {near, low, high}, {along, to.low, to.high}};
  }
  flight_.add_fan(place, 0, to.at, levels,
                  flight_.autopilot().is_px4() ? 1 : std::min(reach(), 10.0));
  const double vertical = std::max(std::max(to.high - place.low_m, 0.0) / climb_mps[0],
                                   std::max(place.high_m - to.low, 0.0) / sink_mps[0]);
  flight_.take({std::max(along - near, 0.0) / speed_mps[1] * 0.95,
                std::max((along + near) / speed_mps[0], vertical) + 6.5});
  at = to.at;
  low = to.low;
  high = to.high;
}

void Hover::cut_corner(const Eigen::Vector2d& to, double z) {
  const double radius = reach();
  if (!previous_ || radius <= kCornerSpacing / 2) {
    return;  // within the reach of the legs
  }
  const Vec3 corner = at_height(at, low);
  const Vec3 back = *previous_ - corner;
  const Vec3 onward = at_height(to, z) - corner;
  const double room_back = back.head<2>().norm();
  const double room_onward = onward.head<2>().norm();
  if (room_back < 1e-6 || room_onward < 1e-6) {
    return;
  }
  const int chords = int(std::ceil(radius / kCornerSpacing));
  for (int n = 1; n <= chords; ++n) {
    const double before = radius * n / chords;
    const Vec3 a = corner + back * std::min(1.0, before / room_back);
    const Vec3 b = corner + onward * std::min(1.0, before / room_onward);
    flight_.add_strip(a, a.z() + high - low, b, b.z() + high - low, kCornerSpacing / 2);
  }
}

// ArduPilot counts the turns of a point that the vehicle is up to 2.2 s behind, turns always
// clockwise in some versions, and begins the next leg where the vehicle would come to rest.
std::vector<Eigen::Vector2d> Hover::leave_circle() {
  constexpr double kSpacing = 3;  // metres
  if (!left_) {
    return {at};
  }
  const Left& left = *left_;
  const double stop = left.speed_mps * (left.speed_mps / 5 + 0.4);
  const double end_m = std::min(left.to_m, left.from_m + 2 * kPi * left.radius);
  std::vector<Eigen::Vector2d> places;
  for (const double sense : {-1.0, 1.0}) {
    for (double along = left.from_m; along < end_m + stop + kSpacing; along += kSpacing) {
      const double angle = left.begun + sense * std::min(along, end_m) / left.radius;
      const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d ahead = sense * Eigen::Vector2d(-out.y(), out.x());
      const Eigen::Vector2d here =
          left.centre.at + left.radius * out + std::max(0.0, along - end_m) * ahead;
      const Eigen::Vector2d rest = here + stop * ahead;
      places.push_back(here);
      if (along <= end_m) {
        flight_.add_strip(at_height(here, low), high, at_height(rest, low), high, kAtEdge);
        places.push_back(rest);
      }
    }
  }
  return places;
}

std::array<double, 2> Hover::heights_at(const Eigen::Vector2d& place) const {
  if (!left_ || !left_->centre.above_ground) {
    return {low, high};
  }
  const auto grounds = flight_.known_grounds(place);
  const auto [lowest, highest] = std::minmax(grounds[0], grounds[1]);
  return {lowest + *left_->centre.above_ground - left_->lags_m[0],
          highest + *left_->centre.above_ground + left_->lags_m[1]};
}

void Hover::go_on_circling(double seconds) {
  if (left_) {
    left_->to_m += seconds * left_->speed_mps;
  }
}

void Hover::follow_ground(const Destination& to) {
  const double length = (to.at - at).norm();
  const int steps = std::max(1, int(std::ceil(length / kGroundStep)));
  const std::array<double, 2> begun = flight_.known_grounds(at);
  const double starts[] = {low, high};
  // Of the fastest flight, at the slowest rates and at the fastest.
  const double mps2 = climb_acceleration();
  // ArduPilot's copter slows down before it is this far off.
  const double margin =
      flight_.autopilot().is_copter() ? flight_.parameter("WP_TER_MARGIN") : kTerrainMargin;
  LaggingGround lagging[][2] = {{{mps2, begun[0]}, {mps2, begun[0]}},
                                {{mps2, begun[1]}, {mps2, begun[1]}}};
  Vec3 before = at_height(at, low);
  double before_high = high;
  for (int n = 1; n <= steps; ++n) {
    const double part = double(n) / steps;
    const Eigen::Vector2d p = at + part * (to.at - at);
    const std::array<double, 2> grounds = flight_.known_grounds(p);
    double lowest = kInfinity;
    double highest = -kInfinity;
    for (int ground : {0, 1}) {
      double lag[2];
      for (int rate : {0, 1}) {
        lag[rate] = lagging[ground][rate].follow(grounds[ground], length / steps / speed_mps[1],
                                                 sink_mps[rate], climb_mps[rate],
                                                 margin > 0 ? margin : kInfinity);
      }
      for (const double start : starts) {
        const double before_above = start - begun[ground];
        const double above = before_above + part * (*to.above_ground - before_above);
        lowest = std::min({lowest, lag[0] + above, lag[1] + above, grounds[ground] + above});
        highest = std::max({highest, lag[0] + above, lag[1] + above, grounds[ground] + above});
      }
    }
    const Vec3 here = at_height(p, lowest);
    // ArduPilot's ground is in whole metres.
    flight_.add_strip(before, before_high, here, highest, std::min(reach(), 2.0) + 1);
    before = here;
    before_high = highest;
  }
  low = before.z();
  high = before_high;
}

// Side by side, so that the width adds nothing to the heights.
void Hover::add_beside(const Destination& to, double distance) {
  const Eigen::Vector2d leg = to.at - at;
  const Eigen::Vector2d ahead = leg.norm() > 1e-6 ? leg.normalized() : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const int strips = int(std::ceil(2 * distance / kCornerSpacing));
  for (int n = 0; n < strips; ++n) {
    const double aside = distance * ((2.0 * n + 1) / strips - 1);
    flight_.add_leg(at_height(at + aside * left - distance * ahead, low), high,
                    at_height(to.at + aside * left + distance * ahead, to.low), to.high,
                    kCornerSpacing / 2);
  }
}

void Hover::go(std::size_t command, const char* what, const Destination& to) {
  flight_.begin(command, what).speed_mps = speed_mps[1];
  const double vertical = std::max(std::max(to.high - low, 0.0) / climb_mps[0],
                                   std::max(high - to.low, 0.0) / sink_mps[0]);
  const double rise = std::max(to.low - high, 0.0);  // at least
  const double drop = std::max(low - to.high, 0.0);
  const double along = (to.at - at).norm();
  const Vec3 from = at_height(at, low);
  const bool is_px4 = flight_.autopilot().is_px4();
  if (!stops && !to.above_ground) {
    cut_corner(to.at, to.low);
  }
  // PX4 keeps within a metre of its line, unless it has reached a place without going there;
  // ArduPilot within the radius of the blended corners.
  const bool is_skipped = is_px4 && along < reach(next_acceptance_m);
  const double beside =
      std::max(is_skipped ? reach(next_acceptance_m) : 0, is_off_track_ ? reach() : 0);
  is_off_track_ = is_skipped;
  const Hover begun = *this;
  for (const Eigen::Vector2d& place : leave_circle()) {
    at = place;
    const auto [begin_low, begin_high] = begun.heights_at(place);
    low = begin_low;
    high = begin_high;
    if (to.above_ground) {
      follow_ground(to);
    } else {
      flight_.add_leg(at_height(at, low), high, at_height(to.at, to.low), to.high,
                      is_px4 ? 1.0 : std::min(reach(), 10.0));
      add_beside(to, beside);
      low = to.low;
      high = to.high;
    }
  }
  left_.reset();
  const double a = is_px4 ? 3 : 2.5;
  const double both_ends = speed_mps[1] / a + a / (is_px4 ? 4 : 1);  // v / a + a / jerk
  flight_.take({std::max({along / speed_mps[1], rise / climb_mps[1], drop / sink_mps[1]}) * 0.95,
                std::max(along / speed_mps[0], vertical) + both_ends});
  previous_ = from;
  at = to.at;
}

void Hover::arc(std::size_t command, const Destination& to, double angle) {
  flight_.begin(command, "the arc").speed_mps = speed_mps[1];
  const Eigen::Vector2d chord = to.at - at;
  const double radius = chord.norm() / (2 * std::sin(std::abs(angle) / 2));
  // Clockwise arcs have their centre to the right of the chord, or to the left beyond half a turn.
  const double sense = angle > 0 ? 1 : -1;
  const Eigen::Vector2d right(chord.y(), -chord.x());
  const Eigen::Vector2d centre =
      at + chord / 2 + sense * right.normalized() * radius * std::cos(std::abs(angle) / 2);
  const double start = std::atan2(at.y() - centre.y(), at.x() - centre.x());
  const int pieces = std::max(2, int(std::ceil(std::abs(angle) / 0.1)));
  Vec3 before = at_height(at, low);
  for (int n = 1; n <= pieces; ++n) {
    const double share = double(n) / pieces;
    const double bearing = start - angle * share;
    const Vec3 here =
        at_height(centre + radius * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)),
                  low + share * (to.low - low));
    const double sagitta = radius * angle * angle / (8.0 * pieces * pieces);
    flight_.add_strip(before, before.z() + high - low, here, here.z() + to.high - to.low,
                      reach() + sagitta);
    before = here;
  }
  const double length = radius * std::abs(angle);
  flight_.take(
      {length / speed_mps[1], length / std::min(speed_mps[0], std::sqrt(1.25 * radius)) + 6.5});
  at = to.at;
  low = to.low;
  high = to.high;
  previous_.reset();
  left_.reset();
}

// It does not slow down there, and may begin anywhere, as late as it comes.
std::array<double, 2> Hover::lags_on_circle(const Eigen::Vector2d& centre, double radius, double v,
                                            double turns,
                                            const std::array<double, 2>& begun) const {
  constexpr int kSides = 48;
  constexpr int kBegins = 12;
  const double mps2 = climb_acceleration();
  std::array<double, 2> lags = begun;
  const auto sinks = sink_rates();
  const auto climbs = climb_rates();
  std::array<std::array<double, 2>, kSides> grounds;
  for (int side = 0; side < kSides; ++side) {
    const double angle = 2 * kPi * side / kSides;
    grounds[side] =
        flight_.known_grounds(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  const double side_s = 2 * kPi * radius / kSides / v;
  const int sides = kSides * int(std::ceil(std::min(turns, kMaxRounds)) + 1);
  const auto fly = [&](int ground, int begin, int sense, double off, int rate) {
    LaggingGround lagging{mps2, grounds[begin][ground] + off};
    double before = 0;  // the greatest lag of the round before
    double now = 0;
    for (int side = 1; side <= sides; ++side) {
      const double here = grounds[(begin + sense * side + kSides * sides) % kSides][ground];
      const double lag = lagging.follow(here, side_s, sinks[rate], climbs[rate], kInfinity) - here;
      lags = {std::max(lags[0], -lag), std::max(lags[1], lag)};
      now = std::max(now, std::abs(lag));
      if (side % kSides == 0) {
        if (side > 2 * kSides && now <= before) {
          return true;  // in step
        }
        before = std::exchange(now, 0);
      }
    }
    return turns <= kMaxRounds;
  };
  bool is_known = true;
  for (int begin = 0; begin < kSides; begin += kSides / kBegins) {
    for (const int ground : {0, 1}) {
      for (const int sense : {-1, 1}) {
        for (const double off : {-begun[0], begun[1]}) {
          for (const int rate : {0, 1}) {
            is_known = fly(ground, begin, sense, off, rate) && is_known;
          }
        }
      }
    }
  }
  if (!is_known) {
    return {kInfinity, kInfinity};
  }
  return lags;
}

void Hover::circle(std::size_t command, const Destination& centre, double radius, double turns,
                   bool clockwise) {
  constexpr double kAtCentre = 0.5;
  const Eigen::Vector2d off = at - centre.at;
  const bool is_from_centre = off.norm() <= kAtCentre;
  Destination edge = centre;
  if (!is_from_centre) {
    edge.at = centre.at + radius * off.normalized();
  }
  const double rise = std::max(std::abs(edge.high - low), std::abs(high - edge.low));
  if (std::hypot(is_from_centre ? radius : (edge.at - at).norm(), rise) > kAtEdge) {
    stops = true;
    go(command, "the way to its circle", edge);
  } else {  // it circles at its present height
    edge.low = low;
    edge.high = high;
  }
  const double v = std::min({speed_mps[0], std::sqrt(0.5 * 2.5 * radius), radians(20) * radius});
  flight_.begin(command, "its circle").speed_mps = v;
  const double inner = is_from_centre ? 0 : radius;
  std::array<double, 2> lags{0, 0};
  if (centre.above_ground) {
    // Above and below the height above the ground with which it comes.
    const auto grounds = flight_.known_grounds(edge.at);
    const auto [lowest, highest] = std::minmax(grounds[0], grounds[1]);
    lags = lags_on_circle(centre.at, radius, v, turns,
                          {std::max(highest + *centre.above_ground - low, 0.0),
                           std::max(high - lowest - *centre.above_ground, 0.0)});
    if (!std::isfinite(lags[0])) {
      flight_.remark(Remark::Weight::not_judged, "not_judged", command,
                     "so many turns above the ground, which it does not follow fast enough, are "
                     "not judged");
      lags = {0, 0};
    }
    for (double& lag : lags) {
      lag += kCircleSwing;
    }
    flight_.add_disc(centre, std::max(inner - kCircleSwing, 0.0), radius + kCircleSwing, -lags[0],
                     lags[1]);
  } else {
    flight_.add_disc(centre, inner, radius, std::min(low, edge.low), std::max(high, edge.high));
  }
  const double seconds = 2 * kPi * radius * turns / v;
  flight_.take({0.9 * seconds, 1.1 * seconds + 15});
  const double begun = std::atan2(off.y(), off.x());
  const double left = begun - (clockwise ? 1 : -1) * 2 * kPi * turns;
  at = centre.at + radius * Eigen::Vector2d(std::cos(left), std::sin(left));
  low = edge.low;
  high = edge.high;
  previous_.reset();
  stops = true;
  const double beyond = 2 * kPi * radius * (turns - std::floor(turns));
  left_ = Left{centre, lags, radius, v, begun, beyond - 2.5 * v, beyond - v};
  if (is_from_centre) {
    left_->to_m += 2 * kPi * radius;
  }
  if (centre.above_ground) {  // anywhere on it
    constexpr int kSides = 48;
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2 * kPi * side / kSides;
      const auto [lowest, highest] =
          heights_at(centre.at + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      low = std::min(low, lowest);
      high = std::max(high, highest);
    }
  }
}

void Hover::land(std::size_t command, const char* what) {
  FlownPart& part = flight_.begin(command, what);
  part.ground = FlownPart::Ground::touched_from_above;
  const double foot = std::min(low, flight_.ground(at));
  for (const Eigen::Vector2d& place : leave_circle()) {
    flight_.add_column(place, std::min(foot, flight_.ground(place)), heights_at(place)[1],
                       std::min(reach(), 2.0));
  }
  left_.reset();
  const double height = high - foot;
  const double last = std::min(height, kTouchDown);
  const bool is_px4 = flight_.autopilot().is_px4();
  if (is_px4 && flight_.parameter("NAV_ACC_RAD") > kBeginsBeside) {
    flight_.remark(Remark::Weight::not_judged, "NAV_ACC_RAD", command,
                   "NAV_ACC_RAD: it sinks from farther beside its place, which is not judged");
  }
  const double fast = is_px4                            ? flight_.parameter("MPC_LAND_SPEED")
                      : flight_.autopilot().is_copter() ? flight_.parameter("LAND_SPD_MS")
                                                        : flight_.parameter("Q_LAND_FINAL_SPD");
  const double slow = is_px4 ? std::min(fast, flight_.parameter("MPC_LAND_CRWL")) : fast;
  auto [slow_sink, fast_sink] = sink_rates();
  if (flight_.autopilot().is_copter() && !is_px4 && flight_.parameter("LAND_SPD_HIGH_MS") > 0) {
    slow_sink = fast_sink = flight_.parameter("LAND_SPD_HIGH_MS");
  }
  const double above = height - last;
  flight_.take({above / fast_sink + last / 2 / fast, above / slow_sink + last / slow + 5});
  low = high = foot;
  previous_.reset();
  stops = true;
  is_on_ground = true;
}
}  // namespace altiplan::host
