// SPDX-License-Identifier: Apache-2.0
#include "link/status.hpp"

#include <cstdarg>
#include <cstdio>

#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

constexpr Time kStatusPeriod{1000};
/// So long a stop may wait.
constexpr Time kStatusSlice{100};

/// MAV_CMD_REQUEST_MESSAGE
CommandLong request_for(std::uint32_t message, const Address& vehicle) {
  CommandLong command;
  command.target_system = vehicle.system;
  command.target_component = vehicle.component;
  command.command = 512;
  command.param1 = static_cast<float>(message);
  return command;
}

/// What is still missing.
Messages requests(const Status& status) {
  const Address& vehicle = status.vehicle.address;
  Messages messages;
  if (!status.position) {
    messages.emplace_back(request_for(GlobalPositionInt::kDeclared.id, vehicle));
  }
  if (!status.system) {
    messages.emplace_back(request_for(SysStatus::kDeclared.id, vehicle));
  }
  if (!status.current) {
    messages.emplace_back(request_for(MissionCurrent::kDeclared.id, vehicle));
  }
  if (!status.mission_items) {
    MissionRequestList list;
    list.target_system = vehicle.system;
    list.target_component = vehicle.component;
    messages.emplace_back(list);
  }
  return messages;
}

/// Ends the download that asking for the number of items began.
MissionAck cancelling(const Address& vehicle) {
  MissionAck ack;
  ack.target_system = vehicle.system;
  ack.target_component = vehicle.component;
  ack.type = static_cast<std::uint8_t>(MissionResult::cancelled);
  return ack;
}

void take(Link& link, const Message& message, Status& status) {
  if (const auto* heartbeat = std::get_if<Heartbeat>(&message)) {
    status.vehicle.heartbeat = *heartbeat;
  } else if (const auto* position = std::get_if<GlobalPositionInt>(&message)) {
    status.position = *position;
  } else if (const auto* system = std::get_if<SysStatus>(&message)) {
    status.system = *system;
  } else if (const auto* current = std::get_if<MissionCurrent>(&message)) {
    status.current = *current;
  } else if (const auto* count = std::get_if<MissionCount>(&message);
             count != nullptr && count->mission_type == 0 && !status.mission_items &&
             count->target_system == link.self().system) {
    status.mission_items = count->count;
    link.send(cancelling(status.vehicle.address));
  }
}

__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  char text[160];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

std::string position_in_words(const Status& status) {
  if (!status.position) {
    return "not reported";
  }
  const GlobalPositionInt& at = *status.position;
  return line("%.7f, %.7f, %.1f m above sea level, %.1f m above home", at.lat / 1e7, at.lon / 1e7,
              at.alt / 1e3, at.relative_alt / 1e3);
}

/// The protocol's words for "not known" are the largest voltage and -1 %.
std::string battery_in_words(const Status& status) {
  constexpr std::uint16_t kUnknownVoltage = 0xffff;
  std::string words;
  if (status.system && status.system->voltage_battery != kUnknownVoltage) {
    words = line("%.2f V", status.system->voltage_battery / 1e3);
  }
  if (status.system && status.system->battery_remaining >= 0) {
    words += (words.empty() ? "" : ", ") + line("%d %%", status.system->battery_remaining);
  }
  return words.empty() ? "not reported" : words;
}

std::string mission_in_words(const Status& status) {
  if (!status.mission_items) {
    return "not reported";
  }
  const std::string at = status.current && *status.mission_items > 0
                             ? line(", at item %d", int(status.current->seq))
                             : "";
  return line("%zu item%s", *status.mission_items, *status.mission_items == 1 ? "" : "s") + at +
         (status.vehicle.is_ardupilot() && *status.mission_items > 0 ? " (item 0 is home)" : "");
}
}  // namespace

Status read_status(Link& link, const Vehicle& vehicle, Time timeout, const std::stop_token& stop) {
  Status status;
  status.vehicle = vehicle;
  const Time end = time_now() + timeout;
  Time ask_at = time_now();
  while (time_now() < end && !requests(status).empty() && !stop.stop_requested()) {
    if (time_now() >= ask_at) {
      link.send(requests(status));
      ask_at += kStatusPeriod;
    }
    const std::optional<Packet> packet = link.receive(kStatusSlice);
    if (packet && packet->sender == vehicle.address) {
      take(link, packet->message, status);
    }
  }
  return status;
}

std::optional<formats::MissionPoint> read_home(Link& link, const Vehicle& vehicle, Time timeout,
                                               const std::stop_token& stop) {
  const Time end = time_now() + timeout;
  Time ask_at = time_now();
  while (time_now() < end && !stop.stop_requested()) {
    if (time_now() >= ask_at) {
      link.send(Message(request_for(HomePosition::kDeclared.id, vehicle.address)));
      ask_at += kStatusPeriod;
    }
    const std::optional<Packet> packet = link.receive(kStatusSlice);
    const bool is_ours = packet && packet->sender == vehicle.address;
    if (const auto* home = is_ours ? std::get_if<HomePosition>(&packet->message) : nullptr) {
      return formats::MissionPoint{home->longitude / 1e7, home->latitude / 1e7,
                                   home->altitude / 1e3};
    }
  }
  return std::nullopt;
}

std::string in_words(const Status& status) {
  const auto& [address, heartbeat] = status.vehicle;
  const bool is_armed = (heartbeat.base_mode & kArmedFlag) != 0;
  return line("vehicle   system %d, component %d: ", address.system, address.component) +
         type_in_words(heartbeat) + ", " + autopilot_in_words(heartbeat) + "\nmode      " +
         mode_in_words(heartbeat) + (is_armed ? ", armed" : ", disarmed") + "\nposition  " +
         position_in_words(status) + "\nbattery   " + battery_in_words(status) + "\nmission   " +
         mission_in_words(status) + "\n";
}
}  // namespace altiplan::link
