// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include "altiplan/error.hpp"
#include "host/autopilot/walker.hpp"

namespace altiplan::host {

using formats::Airframe;
using formats::Autopilot;
using formats::Task;
using Weight = Remark::Weight;

namespace {

bool is_of_ardupilot(Autopilot a) { return !a.is_px4(); }
bool is_ardupilots_wing(Autopilot a) { return !a.is_px4() && !a.is_copter(); }
bool is_ardupilots_copter(Autopilot a) { return !a.is_px4() && a.is_copter(); }
bool is_quadplane(Autopilot a) { return !a.is_px4() && a.airframe == Airframe::vtol; }
bool is_ardupilots_plane(Autopilot a) { return !a.is_px4() && a.airframe == Airframe::plane; }
bool is_of_px4(Autopilot a) { return a.is_px4(); }
bool is_px4s_copter(Autopilot a) { return a.is_px4() && a.is_copter(); }
bool is_px4s_wing(Autopilot a) { return a.is_px4() && !a.is_copter(); }

/// A parameter that changes how a mission is flown in a way that is not modelled.
struct Unmodelled {
  const char* name;
  double neutral;  ///< with this value it does not
  int bits;        ///< nor without one of these, where it is a mask; 0: it is none
  bool (*is_of)(Autopilot);
  const char* what;
};

constexpr Unmodelled kUnmodelled[] = {
    {"TERRAIN_FOLLOW", 0, 0, is_ardupilots_wing, "heights follow the ground, whatever their frame"},
    {"ALT_OFFSET", 0, 0, is_ardupilots_wing, "all heights are shifted"},
    {"WP_MAX_RADIUS", 0, 0, is_ardupilots_wing, "it flies back to items that it has passed beside"},
    {"FLIGHT_OPTIONS", 0, 1 << 4 | 1 << 14, is_ardupilots_wing, "it climbs before it flies on"},
    {"RTL_CLIMB_MIN", 0, 0, is_ardupilots_wing, "it climbs before it returns"},
    {"CLIMB_SLOPE_HGT", 25, 0, is_ardupilots_wing, "it climbs steeply up to another height"},
    {"ALT_SLOPE_MAXHGT", 5, 0, is_ardupilots_wing, "climbs begin anew at another height"},
    {"GLIDE_SLOPE_THR", 5, 0, is_ardupilots_wing, "climbs begin anew at another height"},
    {"MIN_GROUNDSPEED", 0, 0, is_ardupilots_wing, "it flies as fast as it takes over the ground"},
    {"MIN_GNDSPD_CM", 0, 0, is_ardupilots_wing, "it flies as fast as it takes over the ground"},
    {"TECS_APPR_SMAX", 0, 0, is_ardupilots_wing, "it sinks at another rate before it lands"},
    {"Q_ENABLE", 0, 0, is_ardupilots_plane, "it is a QuadPlane (--vehicle vtol)"},
    {"WP_ACC", 2.5, 0, is_ardupilots_copter, "it takes other times to speed up"},
    {"WPNAV_ACCEL", 250, 0, is_ardupilots_copter, "it takes other times to speed up"},
    {"LAND_ALT_LOW_M", 10, 0, is_ardupilots_copter, "it lands slowly from another height"},
    {"LAND_ALT_LOW", 1000, 0, is_ardupilots_copter, "it lands slowly from another height"},
    {"CIRCLE_RATE", 20, 0, is_ardupilots_copter, "it circles at another rate"},
    {"MPC_ACC_HOR", 3, 0, is_of_px4, "it takes other times to speed up"},
    {"MPC_JERK_AUTO", 4, 0, is_of_px4, "it takes other times to speed up"},
    {"MPC_XY_VEL_ALL", -10, 0, is_of_px4, "it flies at another speed"},
    {"MPC_Z_VEL_ALL", -3, 0, is_of_px4, "it climbs and sinks at another rate"},
    {"MPC_Z_VEL_MAX_UP", 3, 0, is_of_px4, "it climbs at another rate"},
    {"MPC_Z_VEL_MAX_DN", 1.5, 0, is_of_px4, "it sinks at another rate"},
    {"MIS_TKO_LAND_REQ", 0, 0, is_px4s_copter, "it refuses other missions"},
    {"MIS_TKO_LAND_REQ", 2, 1 | 4, is_px4s_wing, "it refuses other missions"},
    {"MIS_DIST_1WP", 900, 0, is_of_px4, "it refuses other missions"},
    {"FW_LND_ANG", 5, 0, is_px4s_wing, "it refuses other landings"},
    {"SOAR_ENABLE", 0, 0, is_ardupilots_wing, "it circles in thermals"},
    {"LAND_TYPE", 0, 0, is_ardupilots_wing, "it lands in a deep stall"},
    {"Q_GUIDED_MODE", 0, 0, is_quadplane, "it hovers where it else circles"},
    {"Q_OPTIONS", 0, 1 << 1 | 1 << 2 | 1 << 4 | 1 << 17, is_quadplane,
     "it takes off or lands as an aeroplane"},
    {"OA_TYPE", 0, 0, is_of_ardupilot, "it flies around obstacles that it sees"},
    {"NAV_FORCE_VT", 1, 0, is_px4s_wing, "it lands as an aeroplane"},
    {"NAV_FW_ALT_RAD", 10, 0, is_px4s_wing, "items are reached at other heights"},
    {"NPFG_PERIOD", 10, 0, is_px4s_wing, "it guides itself in another way"},
    {"NPFG_DAMPING", 0.7, 0, is_px4s_wing, "it guides itself in another way"},
    {"NPFG_SW_DST_MLT", 0.32, 0, is_px4s_wing, "it turns elsewhere"},
    {"VT_TRANS_TIMEOUT", 15, 0, is_px4s_wing, "its transition may take longer"},
    {"COM_HOME_IN_AIR", 0, 0, is_of_px4, "home is set in the air"},
};

/// The same where it matters to a return alone.
constexpr Unmodelled kOfReturns[] = {
    {"RTL_ALT_TYPE", 0, 0, is_ardupilots_copter, "a return at a height above the ground"},
    {"RTL_SPEED_MS", 0, 0, is_ardupilots_copter, "a return at another speed"},
    {"RTL_SPEED", 0, 0, is_ardupilots_copter, "a return at another speed"},
    {"RTL_LOIT_TIME", 5000, 0, is_ardupilots_copter, "another wait above home"},
    {"RTL_LAND_DELAY", 0, 0, is_px4s_copter, "a wait above home"},
    {"RTL_LAND_DELAY", -1, 0, is_px4s_wing, "a landing at home"},
    {"RTL_LOITER_RAD", 80, 0, is_px4s_wing, "another circle above home"},
    {"NAV_LOITER_RAD", 80, 0, is_px4s_wing, "circles of more than one radius"},
};

bool has_effect(const Unmodelled& one, Autopilot autopilot, const ParameterFile& file) {
  const auto given = file.find(one.name);
  if (!one.is_of(autopilot) || given == file.end()) {
    return false;
  }
  return one.bits != 0 ? (std::llround(given->second.value) & one.bits) != 0
                       : std::abs(given->second.value - one.neutral) > 1e-3;
}

void remark(const Unmodelled& one, std::size_t n, Flight& flight, const FlightOptions& options) {
  if (has_effect(one, flight.autopilot(), options.parameters)) {
    flight.remark(Weight::not_judged, one.name, n,
                  std::string(one.name) + ": " + one.what + ", which is not judged");
  }
}
}  // namespace

void Walker::remark_parameters() {
  for (const Unmodelled& one : kUnmodelled) {
    remark(one, 0, flight_, options_);
  }
  // It keeps its speed over the ground as long as it can lean into the wind, which most can in
  // this.
  constexpr double kHeldByMost = 10;  // m/s
  if (autopilot_.is_copter() && options_.wind_mps >= std::max(kHeldByMost, flight_.cruise_mps())) {
    flight_.remark(Weight::not_judged, "wind", 0,
                   "how a copter flies in a wind as fast as itself is not judged (--wind)");
  }
  for (std::size_t n = 0; n < commands_.size(); ++n) {
    const Task task = task_of(n);
    if (task == Task::return_home) {
      remark_return_parameters(n);
    }
    const bool hovers = task == Task::take_off || task == Task::vtol_take_off ||
                        task == Task::vtol_land || task == Task::land || task == Task::transition;
    if (hovers && is_quadplane(autopilot_) && options_.wind_mps > 0) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "how far wind carries a QuadPlane that hovers is not judged (--wind)");
    }
    if (formats::is_above_ground(commands_[n].frame) && formats::flies_to_position(task) &&
        is_of_ardupilot(autopilot_) && options_.parameters.contains("TERRAIN_ENABLE") &&
        options_.parameters.at("TERRAIN_ENABLE").value == 0) {
      flight_.remark(Weight::fails, "terrain", n,
                     autopilot_.name() +
                         " knows no ground (TERRAIN_ENABLE 0): it returns home, or "
                         "takes the height as one above home");
    }
  }
}

void Walker::remark_return_parameters(std::size_t n) {
  for (const Unmodelled& one : kOfReturns) {
    remark(one, n, flight_, options_);
  }
}

// AC_Fence: heights and distances of home. PX4: Geofence.
void Walker::check_fences() {
  constexpr int kAltMax = 1;
  constexpr int kCircle = 2;
  constexpr int kAltMin = 8;
  double highest = kInfinity;
  double farthest = kInfinity;
  double lowest = -kInfinity;
  if (is_px4()) {
    const auto limit = [&](const char* name) {
      const double metres = parameter(name);
      return metres > 0 ? metres : kInfinity;
    };
    highest = limit("GF_MAX_VER_DIST");
    farthest = limit("GF_MAX_HOR_DIST");
  } else {
    bool is_on = parameter("FENCE_ENABLE") != 0 || parameter("FENCE_AUTOENABLE") != 0;
    for (std::size_t n = 0; n < commands_.size(); ++n) {
      is_on = is_on || (task_of(n) == Task::fence && commands_[n].params[0] == 1);
    }
    if (!is_on) {
      return;
    }
    const int type = int(parameter("FENCE_TYPE"));
    highest = type & kAltMax ? parameter("FENCE_ALT_MAX") : kInfinity;
    farthest = type & kCircle ? parameter("FENCE_RADIUS") : kInfinity;
    lowest = type & kAltMin ? parameter("FENCE_ALT_MIN") : -kInfinity;
  }
  if (has_new_home_ && std::min({highest, farthest, -lowest}) < kInfinity) {
    give_up(0, "the autopilot's own fence about a home that has been set anew is not judged");
  }
  for (const FlownPart& part : mission_.parts) {
    const auto breach = [&](const char* what, double value, double limit) {
      flight_.remark(Weight::fails, what, part.command,
                     "flies beyond the autopilot's own fence (" + std::string(what) +
                         "): " + std::to_string(std::llround(value)) + " m of home, where " +
                         std::to_string(std::llround(limit)) + " m are the limit",
                     value, limit);
    };
    for (const Strip& strip : part.strips) {
      const double top = std::max(strip.from_high_m, strip.to_high_m) - flight_.home_ground;
      const double bottom = std::min(strip.from.z(), strip.to.z()) - flight_.home_ground;
      const double off = std::max((strip.from.head<2>() - flight_.home).norm(),
                                  (strip.to.head<2>() - flight_.home).norm());
      if (top >= highest) {
        breach(is_px4() ? "GF_MAX_VER_DIST" : "FENCE_ALT_MAX", top, highest);
      }
      if (off >= farthest) {
        breach(is_px4() ? "GF_MAX_HOR_DIST" : "FENCE_RADIUS", off, farthest);
      }
      if (bottom <= lowest && part.ground == FlownPart::Ground::kept_off) {
        breach("FENCE_ALT_MIN", bottom, lowest);
      }
    }
  }
}
}  // namespace altiplan::host
