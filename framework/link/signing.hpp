// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

namespace altiplan::link {

/// Time stamps of signatures: units of 10 µs since 2015-01-01, GMT.
using SigningTime = std::uint64_t;
inline constexpr SigningTime kSigningMinute = 6'000'000;
SigningTime signing_time_now();

using SigningKey = std::array<char, 32>;
/// Reads a key file, which holds the 32 bytes and nothing else; throws Error.
SigningKey read_signing_key(const std::string& file);

/// Bytes of a signature: link id, time stamp, and the first 48 bits of the hash.
inline constexpr std::size_t kSignatureBytes = 13;

/// Signs what is sent over a link and examines what arrives
/// (mavlink.io/en/guide/message_signing.html).
class Signer {
 public:
  explicit Signer(const SigningKey& key, std::uint8_t link_id = 0,
                  std::function<SigningTime()> clock = signing_time_now)
      : key_(key), link_id_(link_id), clock_(std::move(clock)) {}

  /// The signature of a frame from its first byte through its checksum.
  std::string signature_of(std::string_view frame);

  enum class Verdict { accepted, forged, replayed };
  /// `replayed`: not newer than the last one of its stream, or older than a minute.
  Verdict examine(std::string_view frame, std::string_view signature, std::uint8_t system,
                  std::uint8_t component);

 private:
  std::string hash(std::string_view frame, std::string_view link_and_time) const;

  SigningKey key_;
  std::uint8_t link_id_;
  std::function<SigningTime()> clock_;
  SigningTime time_ = 0;  ///< newest of those sent and accepted
  /// Last time stamp by system, component and link id of the sender.
  std::map<std::tuple<std::uint8_t, std::uint8_t, char>, SigningTime> streams_;
};
}  // namespace altiplan::link
