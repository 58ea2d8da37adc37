// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <utility>

#include "host/autopilot/flight.hpp"
#include "host/autopilot/sequence.hpp"
#include "host/autopilot/upload.hpp"

namespace altiplan::host {

/// Flies the commands of a mission one after the other.
class Walker {
 public:
  Walker(const formats::MissionFile& plan, formats::Autopilot autopilot, const World& world,
         const FlightOptions& options)
      : plan_(plan),
        autopilot_(autopilot),
        world_(world),
        options_(options),
        parameters_(autopilot, options.parameters),
        flight_(mission_, world, parameters_),
        commands_(stored(plan.commands, autopilot), autopilot) {
    mission_.autopilot = autopilot;
  }

  FlownMission fly();
  /// As FailsafeReturns has it, after the mission was flown.
  FlownMission return_from(std::size_t n, const Whereabouts& place);
  bool may_return_from(const FlownPart& part);
  Glide glide_in(const Whereabouts& place, double ratio, double lowest_m);
  FlownMission glide(std::size_t n, const Whereabouts& place, const Glide& glide, const Vec3& site);

 private:
  bool is_px4() const { return autopilot_.is_px4(); }
  double parameter(const char* name) const { return parameters_(name); }
  formats::Task task_of(std::size_t n) const { return commands_.task_of(n).task; }

  Eigen::Vector2d to_local(double lon, double lat) const;

  void place_home();

  /// Parameters of the file that change a flight in ways that are not modelled.
  void remark_parameters();
  /// Those that change returns alone.
  void remark_return_parameters(std::size_t n);
  /// The autopilot's own fence about home, where it is in force.
  void check_fences();

  /// Puts wings anywhere in a place.
  void be_anywhere(const Whereabouts& place);

  // Destinations.

  Eigen::Vector2d here() const;
  double low() const { return is_winged_ ? wing_->low() : hover_ ? hover_->low : home_z_; }
  double high() const { return is_winged_ ? wing_->high() : hover_ ? hover_->high : home_z_; }

  /// ArduPilot's copter keeps its height where a command has altitude 0.
  bool keeps_height(const formats::MissionCommand& command) const;

  Destination destination(std::size_t n) const;

  std::optional<Destination> next_destination(std::size_t n) const;

  // The walk.

  void walk(std::size_t n);

  /// Those of the commands after that one that lead to a position.
  std::vector<std::size_t> positions_after(std::size_t n) const;
  /// Says what after that command is not flown.
  void note_unflown(std::size_t n);
  /// ArduPilot starts one order between two items at once. The others run while it flies to the
  /// next item, and are lost where it is there already.
  void note_lost_orders(std::size_t n);
  /// What lasts for ever ends when the pilot or the ground station says so, and a failsafe may lead
  /// to a landing behind it: true if anything follows.
  bool goes_on_when_told(std::size_t n, const std::string& what);

  /// Reports that what follows is not judged; true: the flight ends here.
  bool give_up(std::size_t n, const std::string& why);

  /// Reports a place that is farther away than is judged.
  bool is_too_far(std::size_t n, const Eigen::Vector2d& at);

  /// True if the flight ends here.
  bool carry_out(std::size_t n);

  /// A mission without a take-off begins where the vehicle is flown by hand; PX4's copter climbs.
  void begin_in_the_air(std::size_t n);

  void turn_in(std::size_t n, const Destination& to);

  bool take_off(std::size_t n);

  /// ArduPilot's VTOL adds the number to its present height, whatever the frame says.
  double top_of_take_off(std::size_t n, const Destination& to);

  bool take_off_along_runway(std::size_t n);

  /// Changes to flight on wings: it speeds up ahead, toward a place. False if no place is known.
  bool begin_to_wing(std::size_t n, const std::optional<Eigen::Vector2d>& toward);
  /// The same toward the next position.
  bool begin_to_next(std::size_t n);

  bool transition(std::size_t n);

  bool delay(std::size_t n);

  /// True if what follows is not known.
  bool set_home(std::size_t n);

  // Speeds.

  void set_hover_speed();

  /// The cruise airspeed of the parameters; where none are given, the plan's own may be it.
  void set_wing_speed();
  double min_airspeed() const { return parameter(is_px4() ? "FW_AIRSPD_MIN" : "AIRSPEED_MIN"); }
  double max_airspeed() const { return parameter(is_px4() ? "FW_AIRSPD_MAX" : "AIRSPEED_MAX"); }

  void change_speed(std::size_t n);
  /// Of climb and descent, by ArduPilot's copter.
  void change_rate(std::size_t n);

  /// What a mission has said of speeds counts no more, or counts still.
  void forget_speeds();

  /// A speed behind a condition may be lost: then both count.
  void take_speed(bool counts, const double* speeds, double* present, double own) const;

  // Hovering vehicles.

  bool fly_hover(std::size_t n);
  /// True if the flight may go on after the landing `n`.
  bool takes_off_again(std::size_t n);

  /// Flies straight to a place, unless it is there.
  void arrive(std::size_t n, const Destination& to);

  // Wings.

  void fly_wing_to(std::size_t n, const char* what, const Destination& to, bool at_once);

  bool fly_wing(std::size_t n);

  bool circle_wing(std::size_t n, const Destination& to);

  // The end.

  void finish();

  void return_home(std::size_t n);

  /// Where a return may lead to.
  struct Refuge {
    Eigen::Vector2d at{0, 0};
    std::optional<double> height_m;  ///< of a rally point, above home
    double z = 0;                    ///< above sea level
  };
  /// PX4's RTL_TYPE; 0: another's.
  int type_of_return() const;
  /// The one command that lands, where that is all of the landing that PX4 finds in the mission.
  std::optional<std::size_t> only_landing() const;
  /// What of PX4's type of return is not judged; "" if all of it is.
  std::string unjudged_type() const;
  /// Home or the nearest rally point, all those whose distances hardly differ.
  std::vector<Refuge> refuges() const;
  /// The lowest and the highest, above sea level, at which a hovering vehicle returns that is so
  /// high and so far away.
  std::array<double, 2> return_heights(double z, double distance, const Refuge& refuge) const;
  void return_hover(std::size_t n, const Refuge& refuge);
  void return_wing(std::size_t n, const Refuge& refuge);

  // Returns that join the mission.

  enum class Failsafe { returns, joins_return_path, joins_landing, joins_item };
  /// What the parameters have failsafes do; remarks what is not modelled.
  std::vector<Failsafe> failsafes(std::size_t n);
  /// That of an aeroplane's return.
  std::optional<Failsafe> return_by_mission() const;
  /// A place of the mission, and the leg before it, by whose distance a return chooses it.
  struct Entry {
    std::size_t command;
    std::optional<std::size_t> before;
  };
  /// Behind the last command that belongs to a return path.
  std::size_t end_of_path(std::size_t start) const;
  /// Those of return paths (188), of landing sequences (189), or PX4's items up to its landing.
  std::vector<Entry> entries(Failsafe kind) const;
  /// Where it is as ArduPilot takes it: degrees and metres above sea level; none if not known here.
  std::optional<Vec3> place_of_entry(std::size_t command) const;
  using Joined = std::pair<std::size_t, Whereabouts>;
  /// The commands from which on a return may fly the mission, each from which heights of a place;
  /// none if it does not join it. What cannot be told of them is remarked.
  std::vector<Joined> joins(std::size_t n, Failsafe kind, const Whereabouts& place);
  /// True if a failsafe's return goes on with the mission, for that is on its way home there.
  bool is_on_way_home(std::size_t n) const;
  /// Flies so; false if there is nothing to join.
  bool join_mission(std::size_t n, Failsafe kind, const Whereabouts& place);
  /// Each of them, as ways of one return.
  void join_each(std::size_t n, const std::vector<Joined>& joined);
  void join_at(std::size_t n, std::size_t command, const Whereabouts& place);
  /// PX4's copter's return along the mission to its landing; false if it has none, or is of another
  /// type.
  bool fly_on(std::size_t n, const Whereabouts& place);
  /// What is flown from a command on, after its first item is reached at heights.
  const FlownMission& rest_from(std::size_t n, std::size_t command, std::size_t item,
                                const Whereabouts& arrival);
  /// Of which a failsafe takes any that the mission has.
  void take_any_speed();

  const formats::MissionFile& plan_;
  formats::Autopilot autopilot_;
  const World& world_;
  const FlightOptions& options_;
  Parameters parameters_;
  FlownMission mission_;
  Flight flight_;
  Sequence commands_;
  std::optional<Hover> hover_;
  std::optional<Wing> wing_;
  bool is_winged_ = false;
  bool has_flown_ = false;
  Eigen::Vector2d home_{0, 0};
  double home_z_ = 0;
  std::optional<double> former_home_z_;  ///< on which the next leg may still count
  bool has_new_home_ = false;
  bool is_pending_ = false;  ///< a condition delays what follows
  double hover_speed_[2] = {0, 0};
  double climb_rate_[2] = {0, 0};  ///< of a copter, as ordered
  double sink_rate_[2] = {0, 0};
  double wing_speed_[2] = {0, 0};
  double airspeed_[2] = {0, 0};  ///< of ArduPilot's, which a minimum ground speed raises
  double min_ground_mps_ = 0;
  double all_wing_speeds_[2] = {0, 0};  ///< from the slowest to the fastest of the mission
  /// A way between two commands: how often it was flown, how long it took at last, and where it
  /// ended.
  struct Flown {
    std::size_t times = 0;
    TimeSpan time;
    std::optional<Hover> hover;
    std::optional<Wing> wing;
  };
  /// Of which home and at which speeds a way is flown: each is flown anew.
  using Way = std::array<double, 13>;
  Way way_to(std::size_t n) const;
  std::map<Way, Flown> flown_;
  /// What a jump has the vehicle fly again: when the last round ended, of which home and at which
  /// speeds, how long it took, and how many before were alike.
  struct Round {
    TimeSpan end;
    Way way{};
    TimeSpan time;
    std::size_t alike = 0;
  };
  /// Flies the rounds of a jump that are left at once, where they are as those before.
  void fly_rounds(std::size_t n);
  std::map<std::size_t, Round> rounds_;
  std::vector<std::size_t> orders_;  ///< since the last item that is flown
  int homes_set_ = 0;
  std::optional<Whereabouts> failsafe_;  ///< where it returns from, in place of the mission
  bool has_joined_ = false;              ///< the mission, on its return
  std::map<std::array<double, 4>, FlownMission> rests_;  ///< by command, heights, and from where
  std::size_t known_parts_ = 0;
};
}  // namespace altiplan::host
