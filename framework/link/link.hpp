// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "link/mission_transfer.hpp"
#include "link/status_text.hpp"
#include "link/transport.hpp"

namespace altiplan::link {

/// So long a stop may wait.
inline constexpr Time kReceiveSlice{100};

/// Monotonic, for mission transfers and timeouts.
Time time_now();

/// Packets over a transport, as a component of a ground station that sends its heartbeat each
/// second.
class Link {
 public:
  /// With a signer, packets are signed and only signed ones accepted.
  Link(std::unique_ptr<Transport> transport, Address self, std::optional<Signer> signer)
      : transport_(std::move(transport)),
        self_(self),
        signer_(std::move(signer)),
        parser_(signer_ ? &*signer_ : nullptr) {}
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  void send(const Message& message);
  void send(const Messages& messages);
  /// The next packet that arrives within the time; sends a heartbeat where it is due.
  std::optional<Packet> receive(Time wait);

  /// The last status text of severity warning or worse, of any vehicle; "" for none since.
  const std::string& warning() const { return warning_; }
  void forget_warning() { warning_.clear(); }

  const Address& self() const { return self_; }
  const PacketCounts& counts() const { return parser_.counts(); }

 private:
  std::unique_ptr<Transport> transport_;
  Address self_;
  std::optional<Signer> signer_;
  Parser parser_;
  StatusText texts_;
  std::string warning_;
  std::uint8_t sequence_ = 0;
  std::optional<Time> last_heartbeat_;
  Time last_arrival_{0};
};

/// An autopilot that sends heartbeats.
struct Vehicle {
  Address address;
  Heartbeat heartbeat;

  bool is_ardupilot() const;
  bool is_px4() const;
};

/// The first vehicle that sends a heartbeat, or the one with this system id; throws LinkError if
/// none does in time.
Vehicle await_vehicle(Link& link, std::optional<std::uint8_t> system, Time timeout,
                      const std::stop_token& stop);

/// Runs a transfer to its end; throws LinkError with its problem if it fails. A stop cancels it.
void run(Link& link, MissionTransfer& transfer, const std::stop_token& stop);
}  // namespace altiplan::link
