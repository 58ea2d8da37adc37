// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "link/flight_mode.hpp"
#include "link/status_text.hpp"

namespace altiplan::link {

/// What a vehicle reports while it flies, in local metres and in its own time. Its requests for
/// terrain are answered from the world's ground.
class VehicleFeed {
 public:
  using Clock = std::chrono::steady_clock;

  /// The link and the world outlive it.
  VehicleFeed(Link& link, const Vehicle& vehicle, const World& world)
      : link_(link), vehicle_(vehicle), world_(world) {}

  /// From now on asks for positions and the mission's item where they come late, until they come:
  /// what is asked gets lost, too. To command the vehicle, at once, and for positions more often.
  void expect_reports(bool to_command);
  /// Takes what arrives within the time; the new state if it is a position, later than the last.
  std::optional<State> next(Time wait);
  /// The present position becomes the one at that time.
  State begin_track(double time_s);

  const Vehicle& vehicle() const { return vehicle_; }
  /// By its last heartbeat: PX4's acknowledgement of a change says nothing.
  FlightMode mode() const { return mode_; }
  /// How many of them have arrived.
  int heartbeats() const { return heartbeats_; }
  std::string mode_name() const;
  bool is_armed() const;
  /// Number of the mission's item, by the last report.
  std::optional<int> current_item() const { return current_item_; }
  std::optional<int> reached_item() const { return reached_item_; }
  /// True once it reports another mission than at first, by number (PX4) or length.
  bool has_other_mission() const { return mission_ != first_mission_; }
  /// Arrival of the last position.
  Clock::time_point last_position() const { return last_position_; }
  bool has_position() const { return boot_ms_.has_value(); }
  /// True if its clock has gone back.
  bool has_restarted() const { return has_restarted_; }
  /// Its last status text, in words of its own: " (\"PreArm: …\")", "" if there is none.
  std::string quoted_text() const;

  /// Sends a command; acknowledged() is then about this one.
  void send(const CommandLong& command);
  /// MAV_RESULT of the command, once it is known.
  std::optional<int> acknowledged(std::uint16_t command) const;
  /// Sends MISSION_SET_CURRENT; current_item() is unknown until the vehicle reports it again.
  void set_item(int item);

 private:
  /// What the vehicle is to send by itself each `period`.
  struct Report {
    std::uint32_t message;
    Time period;
    Time late;  ///< more than a few lost packets explain
    Time due;
    Time asked{0};
  };
  void ask_for_late_reports();
  void has_come(std::uint32_t message);
  void take(const Message& message);
  std::optional<State> take(const GlobalPositionInt& position);

  Link& link_;
  Vehicle vehicle_;
  const World& world_;
  std::vector<Report> reports_;
  FlightMode mode_ = FlightMode::other;
  int heartbeats_ = 0;
  std::optional<int> current_item_;
  std::optional<int> reached_item_;
  using MissionKey = std::pair<std::uint32_t, std::uint16_t>;
  std::optional<MissionKey> first_mission_;
  std::optional<MissionKey> mission_;
  std::map<std::uint16_t, int> results_;  ///< by command
  StatusText texts_;
  std::string text_;
  Clock::time_point last_position_;
  std::optional<std::uint32_t> boot_ms_;  ///< of the last position
  double zero_s_ = 0;                     ///< vehicle's time at which the track has time 0
  bool has_restarted_ = false;
  State state_;
};
}  // namespace altiplan::link
