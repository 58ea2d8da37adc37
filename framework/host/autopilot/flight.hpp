// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/autopilot/flown_mission.hpp"

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

/// A flight as far as it is known.
class Flight {
 public:
  Flight(FlownMission& mission, const World& world, const Parameters& parameters)
      : mission_(mission), world_(world), parameters_(parameters) {}

  double parameter(std::string_view name) const { return parameters_(name); }
  formats::Autopilot autopilot() const { return parameters_.autopilot(); }
  const World& world() const { return world_; }

  /// Begins a part, to which strips are added.
  FlownPart& begin(std::size_t command, std::string what);
  /// Ends the current part, which takes so long.
  void take(const TimeSpan& time);
  void remark(Remark::Weight weight, const char* rule, std::size_t command, std::string message,
              double value = 0, double limit = 0);

  /// Ground there, else the height of home.
  double ground(const Eigen::Vector2d& at) const;
  /// Adds a strip from one place to another; where `follows`, its heights are above the ground.
  void add_strip(const Vec3& from, double from_high, const Vec3& to, double to_high, double reach);
  /// Adds a whole leg, on any of the lines that autopilots take for straight: these are up to
  /// L² tan(latitude) / (8 R) apart.
  void add_leg(const Vec3& from, double from_high, const Vec3& to, double to_high, double reach);
  /// Adds a vertical motion.
  void add_column(const Eigen::Vector2d& at, double low, double high, double reach);
  /// Adds a whole disc at heights from `low` to `high`, as circles that lie close.
  /// or, where a height above the ground is given, at that.
  void add_disc(const Destination& centre, double inner, double outer, double low, double high);

  double home_ground = 0;   ///< where the world has no ground
  std::size_t before = 0;   ///< the command whose position was flown to last
  std::size_t repeats = 0;  ///< how often the present leg was flown before

 private:
  FlownMission& mission_;
  const World& world_;
  const Parameters& parameters_;
};

/// A vehicle that hovers, at a place.
class Hover {
 public:
  Hover(Flight& flight, const Eigen::Vector2d& at, double z);

  Eigen::Vector2d at{0, 0};
  double low = 0;  ///< heights above sea level at which it may be
  double high = 0;
  double speed_mps[2];  ///< the slowest and the fastest

  /// Straight up or down.
  void climb(std::size_t command, const char* what, double low_m, double high_m);
  void go(std::size_t command, const char* what, const Destination& to);
  /// In an arc of `angle` (radians, positive clockwise) about no given centre.
  void arc(std::size_t command, const Destination& to, double angle);
  /// Circles about the destination, as often as `turns`.
  void circle(std::size_t command, const Destination& centre, double radius, double turns,
              bool clockwise);
  void land(std::size_t command, const char* what);

 private:
  /// Adds the cut corner at the present place.
  void cut_corner(const Eigen::Vector2d& to, double z);
  void follow_ground(const Destination& to);
  double climb_rate() const;
  double sink_rate() const;
  double reach() const;  ///< acceptance radius of the present place

  Flight& flight_;
  std::optional<Vec3> previous_;  ///< where the last leg came from, if it leads on without a stop
 public:
  double acceptance_m = 0;  ///< of the present place
  bool stops = true;        ///< there
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
    bool at_once = false;             ///< its height is sought at once
    bool turns_at_90 = false;         ///< the autopilot assumes a right angle
  };
  void go(std::size_t command, const char* what, const Leg& leg);
  /// The next leg is flown from where the vehicle is, not along the line from the item before.
  void leave_track() { has_track_ = false; }
  /// Flies to a circle and around it, and leaves it toward `next`.
  void circle(std::size_t command, const char* what, const Destination& centre, double radius,
              bool clockwise, double turns, double seconds, const std::optional<Destination>& next,
              bool leaves_on_tangent);
  /// Down to the ground on a line.
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
  /// One of the ways to fly within the parameters.
  struct Member {
    Eigen::Vector2d at;
    double heading;
    double low;  ///< its height if it seeks the item's slowly, or at once
    double high;
    int speed;        ///< index
    double fraction;  ///< of the maximum distance before an item at which it turns
  };

  /// Adds the triangle within which the corner at the item before is cut.
  void cut_corner(const Leg& leg);
  void make_members(const std::function<Member(int, double)>& make);
  double turn_distance(double v, const Leg& leg) const;
  /// Seconds that the member takes.
  double fly(Member& member, const Leg& leg);
  double sought_height(const Leg& leg, const Eigen::Vector2d& at, double share) const;
  /// ArduPilot climbs at half its rate before the ground rises.
  double highest_ahead(const Leg& leg, const Eigen::Vector2d& at, const Eigen::Vector2d& track,
                       double left, double v) const;
  /// Of a height that is sought slowly, and of the highest that may be.
  void seek_heights(Member& member, double sought, double highest, double seconds) const;
  void circle_until_high(std::size_t command, const Leg& leg);
  double max_turn_rate(double v) const;

  Flight& flight_;
  std::vector<Member> members_;
  Destination from_;  ///< the previous item, from which the track leads
  bool has_track_ = false;
  bool does_arrive_ = true;
  std::optional<Destination> before_;  ///< the item before that, if its track leads there
  double cut_m_ = 0;                   ///< how far before the previous item it may have turned
  double climb_mps_;
  double sink_mps_;
  double l1_s_;  ///< distance of guidance a speed
};
}  // namespace altiplan::host
