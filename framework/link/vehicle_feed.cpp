// SPDX-License-Identifier: Apache-2.0
#include "link/vehicle_feed.hpp"

#include <algorithm>

#include "link/terrain_answer.hpp"
#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

/// Without commands, reports may be this late.
constexpr Time kLateReport{1500};
/// What is asked for is lost as often as what is reported.
constexpr Time kAskReportAgain{500};
}  // namespace

void VehicleFeed::expect_reports(bool to_command) {
  const Time first = time_now() + (to_command ? Time{0} : kLateReport);
  reports_ = {
      {GlobalPositionInt::kDeclared.id, Time{100}, to_command ? Time{500} : kLateReport, first},
      {MissionCurrent::kDeclared.id, Time{500}, kLateReport, first}};
}

void VehicleFeed::ask_for_late_reports() {
  const Time now = time_now();
  for (Report& report : reports_) {
    if (now >= report.due) {
      const float period_us = 1e3F * float(report.period.count());
      send(command_to(vehicle_, VehicleCommand::kSetMessageInterval, float(report.message),
                      period_us));
      report.asked = now;
      report.due = now + kAskReportAgain;
    }
  }
}

void VehicleFeed::has_come(std::uint32_t message) {
  for (Report& report : reports_) {
    if (report.message == message) {
      report.due = std::max(time_now() + report.late, report.asked + kAskReportAgain);
    }
  }
}

std::optional<State> VehicleFeed::next(Time wait) {
  ask_for_late_reports();
  const std::optional<Packet> packet = link_.receive(wait);
  if (!packet || !(packet->sender == vehicle_.address)) {
    return std::nullopt;
  }
  if (const auto* position = std::get_if<GlobalPositionInt>(&packet->message)) {
    has_come(GlobalPositionInt::kDeclared.id);
    return take(*position);
  }
  take(packet->message);
  return std::nullopt;
}

void VehicleFeed::take(const Message& message) {
  if (const auto* heartbeat = std::get_if<Heartbeat>(&message)) {
    vehicle_.heartbeat = *heartbeat;
    mode_ = mode_of(*heartbeat);
    ++heartbeats_;
  } else if (const auto* current = std::get_if<MissionCurrent>(&message)) {
    has_come(MissionCurrent::kDeclared.id);
    current_item_ = current->seq;
    mission_ = {current->mission_id, current->total};
    first_mission_ = first_mission_.value_or(*mission_);
  } else if (const auto* reached = std::get_if<MissionItemReached>(&message)) {
    reached_item_ = reached->seq;
  } else if (const auto* ack = std::get_if<CommandAck>(&message)) {
    constexpr int kInProgress = 5;
    if (ack->result != kInProgress) {
      results_[ack->command] = ack->result;
    }
  } else if (const auto* text = std::get_if<Statustext>(&message)) {
    text_ = texts_.joined(*text);
  } else if (const auto* request = std::get_if<TerrainRequest>(&message)) {
    link_.send(terrain_answer(*request, world_));
  }
}

std::optional<State> VehicleFeed::take(const GlobalPositionInt& position) {
  constexpr std::uint32_t kJitter = 1000;  // ms: packets may come in another order
  if (boot_ms_ && position.time_boot_ms <= *boot_ms_) {
    has_restarted_ = has_restarted_ || position.time_boot_ms + kJitter < *boot_ms_;
    return std::nullopt;
  }
  boot_ms_ = position.time_boot_ms;
  last_position_ = Clock::now();
  const auto [x, y] = world_.frame().to_local(position.lon / 1e7, position.lat / 1e7);
  state_.time_s = position.time_boot_ms / 1e3 - zero_s_;
  state_.position = {x, y, position.alt / 1e3};
  state_.velocity = Vec3(position.vy, position.vx, -position.vz) / 1e2;
  return state_;
}

State VehicleFeed::begin_track(double time_s) {
  zero_s_ = boot_ms_.value_or(0) / 1e3 - time_s;
  state_.time_s = time_s;
  return state_;
}

std::string VehicleFeed::mode_name() const { return mode_in_words(vehicle_.heartbeat); }

bool VehicleFeed::is_armed() const { return (vehicle_.heartbeat.base_mode & kArmedFlag) != 0; }

std::string VehicleFeed::quoted_text() const { return text_.empty() ? "" : " (\"" + text_ + "\")"; }

void VehicleFeed::send(const CommandLong& command) {
  results_.erase(command.command);
  link_.send(Message(command));
}

std::optional<int> VehicleFeed::acknowledged(std::uint16_t command) const {
  const auto result = results_.find(command);
  return result == results_.end() ? std::nullopt : std::optional(result->second);
}

void VehicleFeed::set_item(int item) {
  current_item_.reset();
  link_.send(Message(set_current(vehicle_, item)));
}
}  // namespace altiplan::link
