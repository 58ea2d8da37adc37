// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/autopilot/failsafe_return.hpp"

/// \file What the motions of hovering vehicles and of wings have in common.
namespace altiplan::host {

/// Where a command sends the vehicle: a place in plan, and a height above sea level or the ground.
struct Destination {
  Eigen::Vector2d at{0, 0};
  double low = 0;  ///< above sea level; `high` differs where a new home may count or not
  double high = 0;
  std::optional<double> above_ground;  ///< the height follows the ground

  Vec3 point() const { return {at.x(), at.y(), low}; }
};

/// How a VTOL slows down on wings, m/s²: VT_B_DEC_MSS, Q_TRANS_DECEL.
inline constexpr double kVtolBrakes = 2;

/// A flight as far as it is known.
class Flight {
 public:
  Flight(FlownMission& mission, const World& world, const Parameters& parameters)
      : mission_(mission), world_(world), parameters_(parameters) {}

  double parameter(std::string_view name) const { return parameters_(name); }
  /// Of a copter, without orders.
  double cruise_mps() const {
    return autopilot().is_px4() ? std::min(parameter("MPC_XY_CRUISE"), parameter("MPC_XY_VEL_MAX"))
                                : parameter("WP_SPD");
  }
  bool is_given(std::string_view name) const { return parameters_.is_given(name); }
  formats::Autopilot autopilot() const { return parameters_.autopilot(); }
  const World& world() const { return world_; }

  /// Begins a part, to which strips are added.
  FlownPart& begin(std::size_t command, std::string what);
  /// Ends the current part, which takes so long.
  void take(const TimeSpan& time);
  /// The same, at the end of the current part.
  void hold(double seconds);
  /// The parts of this command, or of the commands up to another, are flown until now again.
  void fly_again(std::size_t command, std::size_t last);
  void remark(Remark::Weight weight, const char* rule, std::size_t command, std::string message,
              double value = 0, double limit = 0);

  /// Ground there, else the height of home.
  double ground(const Eigen::Vector2d& at) const;
  /// The ground there as an autopilot may know it: that of the world, and ArduPilot's, which it
  /// interpolates in a grid, and shifts by what this is off at home.
  std::array<double, 2> known_grounds(const Eigen::Vector2d& at) const;
  /// Adds a strip from one place to another; where `follows`, its heights are above the ground.
  void add_strip(const Vec3& from, double from_high, const Vec3& to, double to_high, double reach);
  /// Adds a whole leg, on any of the lines that autopilots take for straight: these are up to
  /// L² tan(latitude) / (8 R) apart.
  void add_leg(const Vec3& from, double from_high, const Vec3& to, double to_high, double reach);
  /// Adds a vertical motion.
  void add_column(const Eigen::Vector2d& at, double low, double high, double reach);
  /// Heights between which a vehicle is so far along its way; linear from one to the next, and as
  /// the first and the last beyond them.
  struct Level {
    double at_m;
    double low;
    double high;
  };
  /// Adds the straight ways from anywhere within `beside_m` of a disc to a place. The heights of
  /// the disc do not count; levels count from its centre.
  void add_fan(const Whereabouts& from, double beside_m, const Eigen::Vector2d& to,
               const std::vector<Level>& levels, double reach);
  /// Adds what lies above a disc.
  void add_tower(const Whereabouts& place, double low, double high, double reach);
  /// Adds a whole disc at heights from `low` to `high`, as circles that lie close; where a height
  /// above the ground is given, from that much below it to that much above.
  void add_disc(const Destination& centre, double inner, double outer, double low, double high);

  Eigen::Vector2d home{0, 0};
  double home_ground = 0;  ///< where the world has no ground; set once, as home
  double wind_mps = 0;
  std::size_t before = 0;   ///< the command whose position was flown to last
  std::size_t repeats = 0;  ///< how often the present leg was flown before

 private:
  double grid_ground(const Eigen::Vector2d& at) const;
  /// How far any of the lines that autopilots take for straight is from the chart's.
  double bend(const Vec3& from, const Vec3& to) const;

  FlownMission& mission_;
  const World& world_;
  const Parameters& parameters_;
  // ArduPilot's own grid of the ground: its nodes by whole degrees, block and node, and what it is
  // shifted by to be right at home.
  mutable std::map<std::array<int, 6>, double> grid_;
  mutable double grid_spacing_ = 0;
  mutable std::optional<double> grid_shift_;
};

/// A vehicle that hovers, at a place.
class Hover {
 public:
  Hover(Flight& flight, const Eigen::Vector2d& at, double z);

  Eigen::Vector2d at{0, 0};
  double low = 0;  ///< heights above sea level at which it may be
  double high = 0;
  double speed_mps[2];  ///< the slowest and the fastest
  double climb_mps[2];  ///< on the way to a place
  double sink_mps[2];

  /// Straight up or down.
  void climb(std::size_t command, const char* what, double low_m, double high_m);
  /// The same from anywhere in a place, and straight to another one.
  void return_from(std::size_t command, const Whereabouts& place, double low_m, double high_m,
                   const Eigen::Vector2d& to);
  /// From anywhere in a place straight to an item of a mission, at which it is then.
  void join(std::size_t command, const Whereabouts& place, const Destination& to);
  void go(std::size_t command, const char* what, const Destination& to);
  /// In an arc of `angle` (radians, positive clockwise) about no given centre.
  void arc(std::size_t command, const Destination& to, double angle);
  /// Circles about the destination, as often as `turns`.
  void circle(std::size_t command, const Destination& centre, double radius, double turns,
              bool clockwise);
  void land(std::size_t command, const char* what);
  bool is_on_circle() const { return left_.has_value(); }
  /// While it waits after a circle, which it does not leave.
  void go_on_circling(double seconds);

 private:
  /// Adds the cut corner at the present place.
  void cut_corner(const Eigen::Vector2d& to, double z);
  /// Where the next way may begin: about the present place, if this is on a circle.
  std::vector<Eigen::Vector2d> leave_circle();
  /// The lowest and the highest at a place where it leaves its circle.
  std::array<double, 2> heights_at(const Eigen::Vector2d& place) const;
  void follow_ground(const Destination& to);
  /// How far below and above it is on a circle above the ground.
  std::array<double, 2> lags_on_circle(const Eigen::Vector2d& centre, double radius, double v,
                                       double turns, const std::array<double, 2>& begun) const;
  /// The slowest and the fastest, also of what the mission has ordered no rates for.
  std::array<double, 2> climb_rates() const;
  std::array<double, 2> sink_rates() const;
  double climb_acceleration() const;  ///< m/s², above the ground, of ArduPilot's
  /// Adds what lies within a distance of a leg, level with it.
  void add_beside(const Destination& to, double distance);
  double reach() const { return reach(acceptance_m); }  ///< of the present place
  double reach(double acceptance) const;                ///< radius within which a place is reached

  /// The circle that is flown, and how far (metres) beyond its beginning it may be left.
  struct Left {
    Destination centre;
    std::array<double, 2> lags_m;  ///< below and above its height above the ground
    double radius;
    double speed_mps;
    double begun;  ///< bearing from the centre
    double from_m;
    double to_m;
  };

  Flight& flight_;
  std::optional<Vec3> previous_;  ///< where the last leg came from, if it leads on without a stop
  bool is_off_track_ = false;     ///< the last leg was within the reach of its end
  std::optional<Left> left_;

 public:
  double acceptance_m = 0;       ///< of the present place
  double next_acceptance_m = 0;  ///< of the next one
  bool stops = true;             ///< there
  bool is_on_ground = false;
};

/// An aeroplane, at the places and headings at which it may be.
class Wing {
 public:
  explicit Wing(Flight& flight);

  /// Places the vehicle, flying toward a place; at an item, from which a track leads on.
  void start(const Eigen::Vector2d& at, double z, const Eigen::Vector2d& toward,
             bool is_item = false);
  /// Places it anywhere on a stretch of a line, within 10° of its heading.
  void start_on(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double z);

  struct Leg {
    Destination to;
    std::optional<Destination> next;  ///< the position after that, if it is known
    double acceptance_m = 0;          ///< 0: the autopilot's own
    double pass_by_m = 0;             ///< flown beyond the item
    double circle_m = 0;              ///< radius of the circle that it leads to
    bool at_once = false;             ///< its height is sought at once
    bool turns_at_90 = false;         ///< the autopilot assumes a right angle
  };
  void go(std::size_t command, const char* what, const Leg& leg);
  /// The maximum distance before an item at which it turns, where the item sets none.
  double farthest_turn(double z) const { return l1_s_ * true_speed(1, z); }
  /// The next leg is flown from where the vehicle is, not along the line from the item before.
  void leave_track() { has_track_ = false; }
  /// How long it stays on a circle.
  struct Stay {
    double turns = 0;
    double seconds = 0;
    bool until_high = true;  ///< and until its height is reached
  };
  /// Flies around a circle, and leaves it toward `next`.
  void circle(std::size_t command, const char* what, const Destination& centre, double radius,
              bool clockwise, const Stay& stay, const std::optional<Destination>& next,
              bool leaves_on_tangent);
  /// Is anywhere in a place, on any heading.
  void be_anywhere(const Whereabouts& place);
  /// Contains every place at which it may be.
  Whereabouts whereabouts() const;
  /// From there to another place, around which it circles, down to the least of heights; returns
  /// where. With `circle_m` it climbs on a circle of that radius first.
  Whereabouts return_from(std::size_t command, const Whereabouts& place, const Destination& to,
                          double circle_m, double circle_at_home_m, double least_there);
  /// Seconds on its circle until it is as high as that, at the most.
  double to_reach_s(const Whereabouts& from, const Destination& to, double circle_m) const;
  /// From anywhere in a place straight to an item of a mission: where it passes that.
  Whereabouts join(std::size_t command, const Whereabouts& place, const Leg& leg);
  /// Is somewhere about the item that it passes, on any heading.
  void pass(const Destination& item, const Whereabouts& somewhere);
  /// As FailsafeReturns has it.
  Glide glide_in(const Whereabouts& place, double ratio, double lowest_m) const;
  /// Down to the ground on a slope, and along the ground.
  void land(std::size_t command, const Destination& to);
  /// Along a line from the ground to a height.
  void take_off(std::size_t command, const Eigen::Vector2d& from, double heading, double z,
                double spread);

  Eigen::Vector2d mean_place() const;
  double low() const;
  double high() const;
  bool is_flying() const { return !members_.empty(); }
  void set_speed(double slowest, double fastest);
  double speed_mps[2];

 private:
  friend HeldRates held_rates(formats::Autopilot, const ParameterFile&, double);

  static constexpr double kGravity = 9.80665;
  static constexpr double kBesideTrack = 3;  ///< metres that are kept within
  static constexpr double kWeakTurn = 0.62;  ///< of the turn that is sought: it sinks instead
  static constexpr double kWeakest = 0.72;   ///< of the turn that the greatest bank would give
  static constexpr double kQuick = 1.15;     ///< rates of climb and sink, of those that are sought
  static constexpr double kSlow = 0.85;
  static constexpr double kSlowClimb = 0.75;  ///< of an aeroplane of ArduPilot's
  static double bearing_of(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

  /// One of the ways to fly within the parameters.
  struct Member {
    Eigen::Vector2d at;
    double heading;
    double low;  ///< its height if it seeks the item's slowly, or at once
    double high;
    int speed;            ///< index
    double fraction;      ///< of the maximum distance before an item at which it turns
    bool climbs = false;  ///< also when it is as low as may be
  };

  /// Adds the ways from anywhere in a place to another one; returns between which heights they end,
  /// and how long they take. To a circle there a greater height is sought at once, else along the
  /// way. With `circle_m` it climbs on a circle of that radius first.
  std::pair<Whereabouts, TimeSpan> add_ways(const Whereabouts& place, const Destination& to,
                                            double circle_m, double circle_there_m);
  /// On its first way on from where it has joined a mission: about there it may turn in any way.
  std::optional<Whereabouts> leave_joined(const Destination& to);
  /// Metres after which it is on its track, at the most.
  double to_settle(const Whereabouts& joined) const;
  /// Adds the triangle within which the corner at the item before is cut.
  void cut_corner(const Leg& leg);
  void make_members(const std::function<Member(int, double)>& make);
  double turn_distance(double v, const Leg& leg) const;
  /// Within which it turns toward any place from any heading.
  double room_to_turn(double v) const;
  /// The path until a place is at most so much longer than its way, with that room to turn.
  static double late_m(const Whereabouts& place, double beside, double fast);
  /// From anywhere between two heights, where it has turned after so many metres, and its path is
  /// at most `late_m` longer than its way. It climbs or sinks at once, or along so many metres.
  std::vector<Flight::Level> levels_of_return(double low, double high, const Destination& to,
                                              double turned_m, double late_m,
                                              double ramp_m = 0) const;
  /// Of ArduPilot's, from above.
  std::vector<Flight::Level> levels_on_line(double low, double top, const Destination& to,
                                            const Whereabouts& place, double beside,
                                            double circle_m) const;
  /// Where a member was after each step of time.
  struct Passed {
    Vec3 at;
    double high;
    bool is_settled;  ///< on the track, and along it
  };
  /// Seconds that the member takes.
  double fly(Member& member, const Leg& leg, std::vector<Passed>& passed);
  /// Adds what lies between neighbours, of which one turns later or is faster.
  void fill_between(const std::vector<std::vector<Passed>>& passed);
  /// The lowest and the highest, of a share of the leg.
  std::array<double, 2> sought_heights(const Leg& leg, const Destination& from,
                                       const Eigen::Vector2d& at, double share) const;
  double sought_height(const Leg& leg, const Destination& from, double start, double to,
                       double share) const;
  /// The lowest and the highest of a destination, above the ground of a place.
  std::array<double, 2> heights_at(const Destination& to, const Eigen::Vector2d& at) const;
  /// ArduPilot climbs at half its rate before the ground rises.
  double highest_ahead(const Leg& leg, const Destination& from, const Eigen::Vector2d& at,
                       const Eigen::Vector2d& track, double left, double v) const;
  /// Of a height that is sought slowly, and of the highest that may be.
  void seek_heights(Member& member, double sought, double highest, double seconds,
                    double slow_climb) const;
  /// The slowest climb, of the greatest rate.
  double slow_climb_of(bool turns) const;
  void circle_until_high(std::size_t command, const Leg& leg);
  /// The lowest slope of a landing: from the height at its beginning to a point so far before its
  /// end, and so high above it.
  struct Aim {
    double before_m = 0;
    double height_m = 0;
  };
  Aim lowest_aim(double sinks_m, double length, double z) const;
  void roll_out(std::size_t command, const Vec3& touch, const Eigen::Vector2d& course);
  /// How far it is below and above its height above the ground, on a circle.
  std::array<double, 2> lags_on_circle(const Destination& centre, double radius, double v) const;
  double max_turn_rate(double v) const;
  /// Of the circle that is flown where the radius is given, and how far about its centre it leads.
  double steady_radius(double radius, double z) const;
  double widest_radius(double radius, double z) const;
  /// In metres a second, of the slowest (0) and the fastest (1).
  double true_airspeed(int speed, double z) const;
  /// The same over the ground, in wind from ahead (0) and from behind (1).
  double true_speed(int speed, double z) const;

  Flight& flight_;
  std::vector<Member> members_;
  std::optional<Whereabouts> joined_;  ///< about the item at which it has joined the mission
  Destination from_;                   ///< the previous item, from which the track leads
  bool has_track_ = false;
  bool does_arrive_ = true;
  bool sinks_ = false;                 ///< it was above the present item when it set out for it
  std::optional<Destination> before_;  ///< the item before that, if its track leads there
  double cut_m_ = 0;                   ///< how far before the previous item it may have turned
  double changing_mps_[2];             ///< the speeds, and those before them
  double climb_mps_;
  double sink_mps_;
  double l1_s_;         ///< distance of guidance a speed
  double slope_min_m_;  ///< ALT_SLOPE_MIN
  double lag_s_;        ///< of heights that are sought
};
}  // namespace altiplan::host
