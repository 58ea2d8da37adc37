// SPDX-License-Identifier: Apache-2.0
#include "link/link.hpp"

#include "host/import_export/mission_text.hpp"
#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

constexpr std::uint8_t kWarning = 4;  ///< MAV_SEVERITY
constexpr Time kHeartbeatPeriod{1000};
/// Longer than any packet takes on a line of 57,600 baud.
constexpr Time kSilence{60};

Heartbeat own_heartbeat() {
  Heartbeat heartbeat;
  heartbeat.type = kGroundStation;
  heartbeat.autopilot = kNoAutopilot;
  heartbeat.system_status = 4;  // MAV_STATE_ACTIVE
  heartbeat.mavlink_version = 3;
  return heartbeat;
}

/// "; 3 packets without a signature were ignored", "" where all is well.
std::string refused_in_words(const PacketCounts& counts) {
  std::string words;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) {
      words += "; packets " + std::string(what) + ": " + std::to_string(count);
    }
  };
  add(counts.not_signed, "without a signature");
  add(counts.forged, "signed with another key");
  add(counts.replayed, "with an old signature");
  add(counts.damaged, "that were damaged");
  return words;
}
}  // namespace

Time time_now() {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

void Link::send(const Message& message) {
  transport_->send(packet_bytes(message, self_, sequence_++, signer_ ? &*signer_ : nullptr));
}

void Link::send(const Messages& messages) {
  for (const Message& message : messages) {
    send(message);
  }
}

std::optional<Packet> Link::receive(Time wait) {
  const Time end = time_now() + wait;
  for (Time now = time_now();; now = time_now()) {
    if (!last_heartbeat_ || now >= *last_heartbeat_ + kHeartbeatPeriod) {
      last_heartbeat_ = now;
      send(own_heartbeat());
    }
    if (std::optional<Packet> packet = parser_.next()) {
      const auto* text = std::get_if<Statustext>(&packet->message);
      if (text != nullptr && text->severity <= kWarning) {
        warning_ = texts_.joined(*text);
      }
      return packet;
    }
    if (now > end) {
      return std::nullopt;
    }
    const std::string bytes = transport_->receive(
        std::min({end - now, kSilence, *last_heartbeat_ + kHeartbeatPeriod - now}));
    parser_.feed(bytes);
    if (!bytes.empty()) {
      last_arrival_ = time_now();
    }
    if (transport_->has_datagrams() || time_now() >= last_arrival_ + kSilence) {
      parser_.end();
    }
    if (bytes.empty() && now == end) {
      return std::nullopt;
    }
  }
}

bool Vehicle::is_ardupilot() const { return heartbeat.autopilot == kArduPilot; }
bool Vehicle::is_px4() const { return heartbeat.autopilot == kPx4; }

Vehicle await_vehicle(Link& link, std::optional<std::uint8_t> system, Time timeout,
                      const std::stop_token& stop) {
  const Time end = time_now() + timeout;
  while (time_now() < end) {
    if (stop.stop_requested()) {
      throw LinkError("interrupted before a vehicle was heard");
    }
    const std::optional<Packet> packet = link.receive(std::min(kReceiveSlice, timeout));
    const auto* heartbeat = packet ? std::get_if<Heartbeat>(&packet->message) : nullptr;
    if (heartbeat != nullptr && heartbeat->type != kGroundStation &&
        heartbeat->autopilot != kNoAutopilot &&
        packet->sender.system == system.value_or(packet->sender.system)) {
      return {packet->sender, *heartbeat};
    }
  }
  throw LinkError("no heartbeat of " +
                  (system ? "system " + std::to_string(*system) : std::string("a vehicle")) +
                  " within " + host::rounded_text(double(timeout.count()) / 1000, 1) +
                  " s: check the address, and that the vehicle sends there" +
                  refused_in_words(link.counts()));
}

void run(Link& link, MissionTransfer& transfer, const std::stop_token& stop) {
  link.send(transfer.start(time_now()));
  while (transfer.state() == MissionTransfer::State::running) {
    if (stop.stop_requested()) {
      link.send(transfer.cancel());
      break;
    }
    const Time wait = std::clamp(transfer.due() - time_now(), Time(0), kReceiveSlice);
    if (const std::optional<Packet> packet = link.receive(wait)) {
      link.send(transfer.take(time_now(), *packet));
    }
    link.send(transfer.tick(time_now()));
  }
  if (transfer.state() == MissionTransfer::State::failed) {
    throw LinkError(transfer.problem() + refused_in_words(link.counts()));
  }
}
}  // namespace altiplan::link
