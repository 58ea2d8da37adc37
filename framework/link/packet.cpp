// SPDX-License-Identifier: Apache-2.0
#include "link/packet.hpp"

#include "link/checksum.hpp"

namespace altiplan::link {
namespace {

constexpr char kMagic1 = '\xfe';
constexpr char kMagic2 = '\xfd';
constexpr std::size_t kHeader1 = 6;
constexpr std::size_t kHeader2 = 10;
constexpr std::size_t kChecksumBytes = 2;
constexpr std::uint8_t kSignedFlag = 1;

bool is_magic(char byte) { return byte == kMagic1 || byte == kMagic2; }

std::string two_bytes(std::uint16_t value) {
  return {static_cast<char>(value), static_cast<char>(value >> 8)};
}

std::uint16_t checksum_of(std::string_view frame_after_magic, std::uint8_t extra) {
  const char byte = static_cast<char>(extra);
  return checksum({&byte, 1}, checksum(frame_after_magic));
}

/// Without the zeros at its end, but for the first byte.
std::string truncated(std::string payload) {
  const std::size_t last = payload.find_last_not_of('\0');
  payload.resize(last == std::string::npos ? 1 : last + 1);
  return payload;
}
}  // namespace

std::string packet_bytes(const Message& message, const Address& sender, std::uint8_t sequence,
                         Signer* signer) {
  const Layout& layout = layout_of(message);
  const std::string payload = truncated(payload_of(message));
  std::string bytes{kMagic2,
                    static_cast<char>(payload.size()),
                    static_cast<char>(signer != nullptr ? kSignedFlag : 0),
                    0,
                    static_cast<char>(sequence),
                    static_cast<char>(sender.system),
                    static_cast<char>(sender.component),
                    static_cast<char>(layout.id),
                    static_cast<char>(layout.id >> 8),
                    static_cast<char>(layout.id >> 16)};
  bytes += payload;
  bytes += two_bytes(checksum_of(std::string_view(bytes).substr(1), layout.crc_extra));
  return signer != nullptr ? bytes + signer->signature_of(bytes) : bytes;
}

/// A packet's parts, before its checksum is known to be right.
struct Parser::Frame {
  std::string_view bytes;  ///< through the checksum
  std::string_view payload;
  std::string_view signature;  ///< "" without
  bool is_complete = false;    ///< false: only its header has arrived
  bool has_unknown_flags = false;
  std::size_t size = 0;  ///< with its signature
  std::uint32_t id = 0;
  std::uint8_t sequence = 0;
  Address sender;
};

std::optional<Parser::Frame> Parser::front() const {
  const std::string_view all = rest();
  const auto byte = [&](std::size_t n) { return static_cast<std::uint8_t>(all[n]); };
  const bool is_v2 = all.front() == kMagic2;
  const std::size_t header = is_v2 ? kHeader2 : kHeader1;
  if (all.size() < header) {
    return std::nullopt;
  }
  Frame frame;
  const std::size_t unsigned_size = header + byte(1) + kChecksumBytes;
  const bool is_signed = is_v2 && (byte(2) & kSignedFlag) != 0;
  frame.has_unknown_flags = is_v2 && (byte(2) & ~kSignedFlag) != 0;
  frame.size = unsigned_size + (is_signed ? kSignatureBytes : 0);
  const std::size_t at = is_v2 ? 4 : 2;  // sequence, system, component, then the message's number
  frame.sequence = byte(at);
  frame.sender = {byte(at + 1), byte(at + 2)};
  frame.id = byte(at + 3);
  if (is_v2) {
    frame.id |= std::uint32_t(byte(at + 4)) << 8 | std::uint32_t(byte(at + 5)) << 16;
  }
  frame.is_complete = all.size() >= frame.size;
  if (frame.is_complete) {
    frame.bytes = all.substr(0, unsigned_size);
    frame.payload = all.substr(header, byte(1));
    frame.signature = all.substr(unsigned_size, frame.size - unsigned_size);
  }
  return frame;
}

void Parser::feed(std::string_view bytes) {
  buffer_.erase(0, begin_);
  begin_ = 0;
  buffer_ += bytes;
  has_ended_ = false;
}

std::optional<Packet> Parser::next() {
  while (!rest().empty()) {
    if (!is_magic(rest().front())) {
      begin_ = std::min(buffer_.size(), buffer_.find_first_of("\xfe\xfd", begin_));
      is_in_step_ = false;
      continue;
    }
    const std::optional<Frame> frame = front();
    if (!frame || !frame->is_complete) {
      if (!has_ended_) {
        return std::nullopt;
      }
      drop_byte();
      continue;
    }
    if (std::optional<Packet> packet = take(*frame)) {
      return packet;
    }
  }
  return std::nullopt;
}

/// Removes the frame, or its first byte if it is damaged. Without a definition its checksum is not
/// known: whether it is damaged shows in what is before and after it.
std::optional<Packet> Parser::take(const Frame& frame) {
  const Layout* layout = find_layout(frame.id);
  if (layout == nullptr || frame.has_unknown_flags) {
    if (is_in_step_ && begins_packet(frame.size)) {
      ++(layout == nullptr ? counts_.unknown : counts_.damaged);
      begin_ += frame.size;
    } else {
      drop_byte();
    }
    return std::nullopt;
  }
  const std::size_t end = frame.bytes.size() - kChecksumBytes;
  if (frame.bytes.substr(end) !=
      two_bytes(checksum_of(frame.bytes.substr(1, end - 1), layout->crc_extra))) {
    drop_byte();
    return std::nullopt;
  }
  std::optional<Packet> packet;
  if (has_valid_signature(frame)) {
    packet = Packet{frame.sender, frame.sequence, !frame.signature.empty(),
                    *decode(frame.id, frame.payload)};
    count_gap(*packet);
    ++counts_.accepted;
  }
  begin_ += frame.size;
  is_in_step_ = true;
  return packet;
}

/// The first byte begins no packet.
void Parser::drop_byte() {
  ++begin_;
  counts_.damaged += is_in_step_ ? 1 : 0;  // once for all that follows it
  is_in_step_ = false;
}

bool Parser::has_valid_signature(const Frame& frame) {
  if (signer_ == nullptr) {
    return true;
  }
  if (frame.signature.empty()) {
    ++counts_.not_signed;
    return false;
  }
  const Signer::Verdict verdict =
      signer_->examine(frame.bytes, frame.signature, frame.sender.system, frame.sender.component);
  if (verdict != Signer::Verdict::accepted) {
    ++(verdict == Signer::Verdict::forged ? counts_.forged : counts_.replayed);
  }
  return verdict == Signer::Verdict::accepted;
}

bool Parser::begins_packet(std::size_t at) const {
  return at >= rest().size() || is_magic(rest()[at]);
}

void Parser::count_gap(const Packet& packet) {
  const std::pair sender(packet.sender.system, packet.sender.component);
  const auto [last, is_first] = sequences_.try_emplace(sender, packet.sequence);
  if (!is_first) {
    constexpr std::uint8_t kLate = 128;  // half of the numbers back: doubled or overtaken
    const auto gap = static_cast<std::uint8_t>(packet.sequence - last->second - 1);
    if (gap >= kLate) {
      return;
    }
    counts_.lost += gap;
    last->second = packet.sequence;
  }
}
}  // namespace altiplan::link
