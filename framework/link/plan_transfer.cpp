// SPDX-License-Identifier: Apache-2.0
#include "link/plan_transfer.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "link/flight_mode.hpp"
#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

using host::PlanItem;

constexpr double kDegreeUnits = 1e7;
constexpr std::uint8_t kMissionFrame = 2;  ///< of an item without a position

/// The frame without its suffix _INT, which has no meaning in MISSION_ITEM_INT.
int plain_frame(int frame) {
  switch (frame) {
    case 5:
      return 0;
    case 6:
      return 3;
    case 11:
      return 10;
    default:
      return frame;
  }
}

std::int32_t units_of(double value, bool is_degrees) {
  return static_cast<std::int32_t>(std::lround(is_degrees ? value * kDegreeUnits : value));
}

MissionItemInt wire_item(const PlanItem& item) {
  MissionItemInt wire;
  const bool is_place = item.frame != kMissionFrame;
  wire.frame = static_cast<std::uint8_t>(item.frame);
  wire.command = static_cast<std::uint16_t>(item.command);
  wire.autocontinue = item.continues ? 1 : 0;
  wire.param1 = static_cast<float>(item.params[0]);
  wire.param2 = static_cast<float>(item.params[1]);
  wire.param3 = static_cast<float>(item.params[2]);
  wire.param4 = static_cast<float>(item.params[3]);
  wire.x = units_of(item.params[4], is_place);
  wire.y = units_of(item.params[5], is_place);
  wire.z = static_cast<float>(item.params[6]);
  return wire;
}

/// The number with the fewest digits that is sent as this float.
double shortest(float value) {
  std::array<char, 32> text;
  const auto [end, failed] = std::to_chars(text.data(), text.data() + text.size(), value);
  double number = value;
  std::from_chars(text.data(), end, number);
  return number;
}

PlanItem plan_item(const MissionItemInt& wire) {
  PlanItem item{wire.command, plain_frame(wire.frame)};
  const double units = wire.frame != kMissionFrame ? kDegreeUnits : 1;
  item.params = {shortest(wire.param1), shortest(wire.param2), shortest(wire.param3),
                 shortest(wire.param4), wire.x / units,        wire.y / units,
                 shortest(wire.z)};
  item.continues = wire.autocontinue != 0;
  return item;
}

/// The floats of altitudes are as coarse as 1 mm.
constexpr double kFloatTolerance = 0.001;

/// What was left to the autopilot is its own choice.
bool same_value(double sent, double held) {
  const double value = std::isnan(held) ? 0 : held;
  return std::isnan(sent) || std::abs(sent - value) <= kValueTolerance + kFloatTolerance;
}

std::string in_words(double value, int decimals) {
  return std::isnan(value) ? "unset" : host::rounded_text(value, decimals);
}

/// "latitude 46.1 became 46.2, …"; "" where nothing differs.
std::string difference(const MissionItemInt& sent, const MissionItemInt& held) {
  constexpr const char* kNames[] = {"parameter 1", "parameter 2", "parameter 3", "parameter 4",
                                    "latitude",    "longitude",   "altitude"};
  const PlanItem a = plan_item(sent);
  const PlanItem b = plan_item(held);
  std::string words;
  const auto add = [&](const std::string& what, const std::string& was, const std::string& is) {
    words += (words.empty() ? "" : ", ") + what + " " + was + " became " + is;
  };
  if (a.command != b.command) {
    add("command", std::to_string(a.command), std::to_string(b.command));
  }
  if (a.frame != b.frame) {
    add("frame", std::to_string(a.frame), std::to_string(b.frame));
  }
  for (std::size_t n = 0; n < a.params.size(); ++n) {
    const bool is_degrees = n == 4 || n == 5;
    const bool is_same = is_degrees ? std::abs(a.params[n] - b.params[n]) < 1.5 * kDegreesTolerance
                                    : same_value(a.params[n], b.params[n]);
    if (!is_same) {
      const int decimals = is_degrees ? 7 : 3;
      add(kNames[n], in_words(a.params[n], decimals), in_words(b.params[n], decimals));
    }
  }
  return words;
}

const std::vector<PlanItem>& items_of(const host::Plan& plan, PlanType type) {
  return type == PlanType::mission ? plan.items : type == PlanType::fence ? plan.fence : plan.rally;
}

MissionItemInt home_item(const host::Plan& plan) {
  PlanItem home;
  if (plan.home) {
    home.params[4] = plan.home->lat;
    home.params[5] = plan.home->lon;
    home.params[6] = plan.home->altitude_m;
  }
  return wire_item(home);
}

std::vector<MissionItemInt> downloaded(Link& link, const Vehicle& vehicle, PlanType type,
                                       const std::stop_token& stop) {
  MissionDownload transfer(type, link.self(), vehicle.address);
  run(link, transfer, stop);
  return transfer.items();
}

bool begins_with_home(const Vehicle& vehicle, PlanType type) {
  return vehicle.is_ardupilot() && type == PlanType::mission;
}

/// What the autopilot does not store: ArduPilot leaves every circle when heading for the next item,
/// and PX4's take-off has no pitch.
void forget_unstored(std::vector<MissionItemInt>& items, const Vehicle& vehicle) {
  for (MissionItemInt& item : items) {
    if (vehicle.is_ardupilot() && item.command == host::Command::kLoiterTurns) {
      item.param2 = 0;
    } else if (vehicle.is_ardupilot() && item.command == host::Command::kLoiterToAltitude) {
      item.param1 = 0;
    } else if (vehicle.is_px4() && item.command == host::Command::kTakeoff) {
      item.param1 = 0;
    }
  }
}
}  // namespace

std::vector<MissionItemInt> wire_items(const std::vector<PlanItem>& items) {
  std::vector<MissionItemInt> wire;
  for (const PlanItem& item : items) {
    wire.push_back(wire_item(item));
  }
  return wire;
}

std::vector<PlanItem> plan_items(const std::vector<MissionItemInt>& items) {
  std::vector<PlanItem> result;
  for (const MissionItemInt& item : items) {
    result.push_back(plan_item(item));
  }
  return result;
}

std::vector<std::string> differences(const std::vector<MissionItemInt>& sent,
                                     const std::vector<MissionItemInt>& held) {
  std::vector<std::string> found;
  if (sent.size() != held.size()) {
    found.push_back("the vehicle holds " + std::to_string(held.size()) + " items instead of " +
                    std::to_string(sent.size()));
  }
  for (std::size_t n = 0; n < std::min(sent.size(), held.size()); ++n) {
    if (const std::string words = difference(sent[n], held[n]); !words.empty()) {
      found.push_back("item " + std::to_string(n) + ": " + words);
    }
  }
  return found;
}

std::vector<std::string> upload(Link& link, const Vehicle& vehicle, const host::Plan& plan,
                                PlanType type, const std::stop_token& stop) {
  std::vector<MissionItemInt> sent = wire_items(items_of(plan, type));
  const bool has_home = begins_with_home(vehicle, type) && !sent.empty();
  if (has_home) {
    sent.insert(sent.begin(), home_item(plan));
  }
  if (type == PlanType::mission && !sent.empty()) {
    sent.front().current = 1;  // else PX4 begins at the number at which the old mission was
  }
  if (sent.size() > 0xffff) {
    throw LinkError("MAVLink numbers at most 65535 items: drop waypoints with --max-items");
  }
  link.forget_warning();
  MissionUpload transfer(type, link.self(), vehicle.address, sent);
  run(link, transfer, stop);
  const std::vector<MissionItemInt> held = downloaded(link, vehicle, type, stop);
  if (has_home && !held.empty()) {
    sent.front() = held.front();
  }
  forget_unstored(sent, vehicle);
  return differences(sent, held);
}

StoredMission stored_mission(Link& link, const Vehicle& vehicle, const std::stop_token& stop) {
  // PX4 checks a mission after it has acknowledged it.
  const Time checked(vehicle.is_px4() ? 1500 : 0);
  constexpr Time kTimeout{6000};
  constexpr Time kAskAgain{500};
  constexpr std::uint8_t kNoMission = 1;  // MISSION_STATE
  StoredMission stored;
  const Time began = time_now();
  Time ask_at = began;
  bool is_armed = (vehicle.heartbeat.base_mode & kArmedFlag) != 0;
  const auto is_first = [&] { return is_armed || stored.current == first_item(vehicle); };
  while (time_now() < began + kTimeout && !stop.stop_requested() &&
         !(is_first() && time_now() >= began + checked)) {
    if (!is_first() && time_now() >= ask_at) {
      link.send(Message(set_current(vehicle, first_item(vehicle))));
      ask_at = time_now() + kAskAgain;
    }
    const std::optional<Packet> packet = link.receive(kReceiveSlice);
    if (!packet || !(packet->sender == vehicle.address)) {
      continue;
    }
    if (const auto* current = std::get_if<MissionCurrent>(&packet->message)) {
      stored.current = current->seq;
      stored.is_refused = current->mission_state == kNoMission;
    } else if (const auto* heartbeat = std::get_if<Heartbeat>(&packet->message)) {
      is_armed = (heartbeat->base_mode & kArmedFlag) != 0;
    }
  }
  stored.begins_elsewhere = !is_first();
  stored.words = link.warning();
  return stored;
}

void download(Link& link, const Vehicle& vehicle, PlanType type, host::Plan& plan,
              const std::stop_token& stop) {
  std::vector<PlanItem> items = plan_items(downloaded(link, vehicle, type, stop));
  if (begins_with_home(vehicle, type) && !items.empty()) {
    const std::array<double, 7>& home = items.front().params;
    plan.home = formats::MissionPoint{home[5], home[4], home[6]};
    items.erase(items.begin());
  }
  (type == PlanType::mission ? plan.items
   : type == PlanType::fence ? plan.fence
                             : plan.rally) = std::move(items);
}
}  // namespace altiplan::link
