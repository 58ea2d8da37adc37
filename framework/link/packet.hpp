// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "link/messages.hpp"
#include "link/signing.hpp"

/// \file MAVLink's packets as bytes (mavlink.io/en/guide/serialization.html).
namespace altiplan::link {

/// A component of a system: an autopilot, a ground station.
struct Address {
  std::uint8_t system = 0;
  std::uint8_t component = 0;

  bool operator==(const Address&) const = default;
};

/// A message that arrived undamaged.
struct Packet {
  Address sender;
  std::uint8_t sequence = 0;
  bool is_signed = false;
  Message message;
};

/// The bytes of a MAVLink 2 packet, signed if there is a signer.
std::string packet_bytes(const Message& message, const Address& sender, std::uint8_t sequence,
                         Signer* signer = nullptr);

/// Packets of a link, by what became of them.
struct PacketCounts {
  std::uint64_t accepted = 0;
  std::uint64_t damaged = 0;     ///< wrong checksum, or flags that nobody has defined
  std::uint64_t unknown = 0;     ///< messages that the link does not know
  std::uint64_t not_signed = 0;  ///< ignored for lack of a signature
  std::uint64_t forged = 0;      ///< ignored for a signature of another key
  std::uint64_t replayed = 0;    ///< ignored for an old signature
  std::uint64_t lost = 0;        ///< gaps in the sequence numbers of senders
};

/// Finds packets of MAVLink 1 and 2 in a stream of bytes. A damaged packet is searched for an
/// undamaged one from its second byte on.
class Parser {
 public:
  /// With a signer only packets signed with its key are accepted. The signer outlives the parser.
  explicit Parser(Signer* signer = nullptr) : signer_(signer) {}

  void feed(std::string_view bytes);
  /// What is incomplete is damaged: the end of a datagram, or silence on a line.
  void end() { has_ended_ = true; }
  /// The next undamaged packet of what was fed.
  std::optional<Packet> next();

  const PacketCounts& counts() const { return counts_; }

 private:
  struct Frame;
  /// The frame at the front of the buffer; none if there is none, or not yet all of its header.
  std::optional<Frame> front() const;
  std::optional<Packet> take(const Frame& frame);
  bool has_valid_signature(const Frame& frame);
  bool begins_packet(std::size_t at) const;
  std::string_view rest() const { return std::string_view(buffer_).substr(begin_); }
  void drop_byte();
  void count_gap(const Packet& packet);

  Signer* signer_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of what is not yet examined
  bool has_ended_ = false;
  bool is_in_step_ = true;  ///< what is next follows an undamaged packet
  PacketCounts counts_;
  std::map<std::pair<std::uint8_t, std::uint8_t>, std::uint8_t> sequences_;
};
}  // namespace altiplan::link
