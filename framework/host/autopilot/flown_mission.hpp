// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/world.hpp"
#include "host/autopilot/parameters.hpp"

/// \file The paths on which an autopilot may fly a mission.
namespace altiplan::host {

/// Places that the vehicle may pass: above a straight line in plan, between two heights that are
/// linear along it, and up to `reach_m` from these.
struct Strip {
  Vec3 from{0, 0, 0};  ///< the lower edge, local metres
  Vec3 to{0, 0, 0};
  double from_high_m = 0;  ///< the upper edge
  double to_high_m = 0;
  double reach_m = 0;
};

/// A time in seconds, from the fastest to the slowest that the parameters allow; infinite where
/// nothing ends it.
struct TimeSpan {
  double min_s = 0;
  double max_s = 0;

  TimeSpan& operator+=(const TimeSpan& more) {
    min_s += more.min_s;
    max_s += more.max_s;
    return *this;
  }
};

/// A part of a flight. Its strips contain every path that the parameters allow.
struct FlownPart {
  enum class Ground { kept_off, touched_from_above, touched_along };  ///< a vertical, a slanted end

  std::size_t command = 0;  ///< index of the command that is carried out
  std::size_t before = 0;   ///< and of the one whose position it is flown from
  std::string what;         ///< "the climb after take-off"; "" for the way between two items
  Ground ground = Ground::kept_off;
  double foot_m = kInfinity;  ///< height above sea level where a slanted end is on the ground
  std::vector<Strip> strips;
  double begin_s = 0;      ///< earliest, from the beginning of the flight
  TimeSpan time;           ///< from the beginning of the flight to the end of the part
  double until_s = 0;      ///< latest end of the last time that it is flown
  double held_s = 0;       ///< of its time, that it waits at its end
  double speed_mps = 0;    ///< the greatest that is sought along it; 0: none
  bool is_return = false;  ///< to home or a rally point, or back along the mission
  std::size_t known = 0;   ///< of returns: parts of the same number are the same; 0: of none
};

/// What is to be said of a command, besides where it flies.
struct Remark {
  enum class Weight { note, not_judged, fails };
  Weight weight = Weight::note;
  std::string rule;  ///< "refused", "dropped", "not_judged", …
  std::size_t command = 0;
  std::string message;
  double value = 0;
  double limit = 0;
};

/// How an autopilot flies a mission.
struct FlownMission {
  formats::Autopilot autopilot;
  std::vector<FlownPart> parts;
  std::vector<Remark> remarks;
  TimeSpan time;
  std::vector<Parameters::Used> parameters;
  std::size_t strips = 0;  ///< that were made, those of rounds that are not kept too
};

/// What a flight depends on, besides the mission.
struct FlightOptions {
  ParameterFile parameters;
  /// Of an aeroplane's take-off, and where ArduPilot's VTOL points then; clockwise from north.
  std::optional<double> runway_deg;
  double wind_mps = 0;  ///< the strongest, from anywhere
};

/// Flies the mission's commands as that autopilot does (facts: ArduPilot 4.7, PX4 1.16). Heights
/// above the ground need a world with ground; where it has none the command is not judged.
FlownMission fly_mission(const formats::MissionFile& plan, formats::Autopilot autopilot,
                         const World& world, const FlightOptions& options);

/// The autopilots that the file, or else the user, leaves open: those alone whose parameters may be
/// the given ones, unless these are of none of them.
std::vector<formats::Autopilot> possible_autopilots(
    const formats::MissionFile& plan, const std::optional<formats::Firmware>& firmware,
    const std::optional<formats::Airframe>& airframe, const ParameterFile& parameters);

/// What aeroplanes may be planned with so that they keep up: rates of climb and sink in m/s that
/// they hold in turns and straight on, at that height, for the seconds that their airspeed makes of
/// a way.
struct HeldRates {
  double climb_mps = 0;
  double sink_mps = 0;
};
HeldRates held_rates(formats::Autopilot autopilot, const ParameterFile& parameters, double z);

/// "item 3 (waypoint)" as ground stations number it, "line 5" where the file numbers nothing.
std::string name_of_command(const formats::MissionCommand& command);
}  // namespace altiplan::host
