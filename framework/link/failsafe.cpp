// SPDX-License-Identifier: Apache-2.0
#include "link/failsafe.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "host/import_export/mission_text.hpp"
#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

using Parameters = std::map<std::string, double>;

/// A stale set-point that is flown for longer (s) is no hold.
constexpr double kLongestStale = 5;

struct Action {
  const char* words;
  bool is_safe;
};
using Actions = std::map<int, Action>;

/// COM_OBL_RC_ACT: when set-points stop for COM_OF_LOSS_T. NAV_RCL_ACT does nothing to a vehicle
/// that was armed without a radio.
const Actions kPx4SetPointLoss{
    {0, {"is in POSCTL: without a radio a copter sinks, an aeroplane flies straight on", false}},
    {1, {"is in ALTCTL, which needs a pilot with a radio", false}},
    {2, {"is in STABILIZED, which needs a pilot with a radio", false}},
    {3, {"returns", true}},
    {4, {"lands where it is", false}},
    {5, {"holds", true}},
    {6, {"terminates its flight", false}},
    {7, {"disarms", false}}};
/// NAV_DLL_ACT: when heartbeats of ground stations stop.
const Actions kPx4StationLoss{{0, {"", true}},
                              {1, {", then holds", true}},
                              {2, {", then returns", true}},
                              {3, {", then lands where it is", false}},
                              {5, {", then terminates its flight", false}},
                              {6, {", then disarms", false}}};
/// FS_GCS_ENABLE of copters, after they have stopped for GUID_TIMEOUT.
const Actions kCopterStationLoss{{0, {"", true}},
                                 {1, {", then returns", true}},
                                 {2, {", then returns", true}},
                                 {3, {", then returns", true}},
                                 {4, {", then returns, or lands where it is", false}},
                                 {5, {", then lands where it is", false}},
                                 {6, {", then flies to its mission's landing, or returns", false}},
                                 {7, {", then brakes, or lands where it is", false}}};
/// FS_LONG_ACTN of planes, where FS_GCS_ENABL counts in GUIDED.
const Actions kPlaneStationLoss{{0, {"", true}},
                                {1, {", then returns", true}},
                                {2, {", then glides down", false}},
                                {3, {", then opens its parachute", false}},
                                {4, {", then flies its mission on", false}},
                                {5, {", then lands by itself", false}}};

Action action_of(const Actions& actions, double value) {
  const auto found = actions.find(static_cast<int>(value));
  return found == actions.end() ? Action{", then does what is not known here", false}
                                : found->second;
}

/// PX4 sends the bytes of an integer, ArduPilot its value.
double value_of(const ParamValue& parameter, const Vehicle& vehicle) {
  constexpr std::uint8_t kReal32 = 9;  // MAV_PARAM_TYPE
  return vehicle.is_px4() && parameter.param_type != kReal32
             ? double(std::bit_cast<std::int32_t>(parameter.param_value))
             : double(parameter.param_value);
}

ParamRequestRead request_for(const std::string& name, const Vehicle& vehicle) {
  ParamRequestRead request;
  request.target_system = vehicle.address.system;
  request.target_component = vehicle.address.component;
  std::copy(name.begin(), name.end(), request.param_id.begin());
  request.param_index = -1;  // by name
  return request;
}

/// Those that are told in time.
Parameters read_parameters(Link& link, const Vehicle& vehicle,
                           const std::vector<std::string>& names, const std::stop_token& stop) {
  constexpr Time kTimeout{6000};
  constexpr Time kAskAgain{500};
  Parameters known;
  const Time end = time_now() + kTimeout;
  for (Time ask_at = time_now();
       known.size() < names.size() && time_now() < end && !stop.stop_requested();) {
    if (time_now() >= ask_at) {
      for (const std::string& name : names) {
        if (!known.contains(name)) {
          link.send(Message(request_for(name, vehicle)));
        }
      }
      ask_at = time_now() + kAskAgain;
    }
    const std::optional<Packet> packet = link.receive(kReceiveSlice);
    const bool is_ours = packet && packet->sender == vehicle.address;
    if (const auto* told = is_ours ? std::get_if<ParamValue>(&packet->message) : nullptr) {
      const std::string name = text_of(told->param_id);
      const double value = value_of(*told, vehicle);
      if (std::isfinite(value) && std::find(names.begin(), names.end(), name) != names.end()) {
        known[name] = value;
      }
    }
  }
  return known;
}

Failsafe px4_failsafe(const Parameters& value) {
  const double stale_s = value.at("COM_OF_LOSS_T");
  const Action first = action_of(kPx4SetPointLoss, value.at("COM_OBL_RC_ACT"));
  const Action then = action_of(kPx4StationLoss, value.at("NAV_DLL_ACT"));
  return {
      "it flies on for " + host::rounded_text(stale_s, 1) + " s and " + first.words + then.words,
      first.is_safe && then.is_safe && stale_s <= kLongestStale};
}

Failsafe copter_failsafe(const Parameters& value) {
  const double stale_s = value.at("GUID_TIMEOUT");
  const Action then = action_of(kCopterStationLoss, value.at("FS_GCS_ENABLE"));
  return {"it flies on for " + host::rounded_text(stale_s, 1) + " s and hovers" + then.words,
          then.is_safe && stale_s <= kLongestStale};
}

Failsafe plane_failsafe(const Parameters& value) {
  const double when = value.at("FS_GCS_ENABL");
  const bool counts = when != 0 && when != 3;  // 3: in AUTO
  const Action then = action_of(kPlaneStationLoss, counts ? value.at("FS_LONG_ACTN") : 0);
  return {std::string("it circles ahead of where it is") + then.words, then.is_safe};
}

/// "FS_GCS_ENABLE 0, GUID_TIMEOUT 3"
std::string in_words(const Parameters& parameters) {
  std::string words;
  for (const auto& [name, value] : parameters) {
    words += (words.empty() ? "" : ", ") + name + " " + host::rounded_text(value, 1);
  }
  return words;
}
}  // namespace

Failsafe read_failsafe(Link& link, const Vehicle& vehicle, const std::stop_token& stop) {
  const bool is_plane = is_fixed_wing(vehicle.heartbeat);
  std::vector<std::string> names;
  if (vehicle.is_px4()) {
    names = {"COM_OF_LOSS_T", "COM_OBL_RC_ACT", "NAV_DLL_ACT"};
  } else if (vehicle.is_ardupilot()) {
    names = is_plane ? std::vector<std::string>{"FS_GCS_ENABL", "FS_LONG_ACTN"}
                     : std::vector<std::string>{"GUID_TIMEOUT", "FS_GCS_ENABLE"};
  } else {
    return {"what it does is not known: its autopilot is neither ArduPilot nor PX4", false};
  }
  const Parameters value = read_parameters(link, vehicle, names, stop);
  for (const std::string& name : names) {
    if (!value.contains(name)) {
      return {"what it does is not known: it does not tell its parameter " + name, false};
    }
  }
  Failsafe failsafe = vehicle.is_px4() ? px4_failsafe(value)
                      : is_plane       ? plane_failsafe(value)
                                       : copter_failsafe(value);
  failsafe.words += " (" + in_words(value) + ")";
  return failsafe;
}
}  // namespace altiplan::link
