// SPDX-License-Identifier: Apache-2.0
#include "link/signing.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>

#include "altiplan/error.hpp"
#include "host/base/sha256.hpp"

namespace altiplan::link {
namespace {

constexpr std::size_t kTimeBytes = 6;
constexpr std::size_t kHashBytes = 6;

std::string text_of_time(SigningTime time) {
  std::string bytes;
  for (std::size_t n = 0; n < kTimeBytes; ++n) {
    bytes += static_cast<char>(time >> (8 * n));
  }
  return bytes;
}

SigningTime time_of_text(std::string_view bytes) {
  SigningTime time = 0;
  for (std::size_t n = 0; n < kTimeBytes; ++n) {
    time |= SigningTime(static_cast<unsigned char>(bytes[n])) << (8 * n);
  }
  return time;
}
}  // namespace

SigningTime signing_time_now() {
  constexpr std::int64_t kYear2015 = 1'420'070'400;  // seconds since 1970
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  return static_cast<SigningTime>(std::max<std::int64_t>(0, us - kYear2015 * 1'000'000) / 10);
}

SigningKey read_signing_key(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  SigningKey key{};
  if (!stream) {
    throw Error("cannot read the signing key '" + file + "': give a file of 32 bytes");
  }
  stream.read(key.data(), key.size());
  if (stream.gcount() != std::streamsize(key.size()) ||
      stream.peek() != std::ifstream::traits_type::eof()) {
    throw Error("'" + file + "' is not a signing key: expected a file of exactly 32 bytes");
  }
  return key;
}

std::string Signer::signature_of(std::string_view frame) {
  time_ = std::max(time_ + 1, clock_());
  const std::string link_and_time = static_cast<char>(link_id_) + text_of_time(time_);
  return link_and_time + hash(frame, link_and_time);
}

Signer::Verdict Signer::examine(std::string_view frame, std::string_view signature,
                                std::uint8_t system, std::uint8_t component) {
  const std::string_view link_and_time = signature.substr(0, 1 + kTimeBytes);
  if (hash(frame, link_and_time) != signature.substr(1 + kTimeBytes)) {
    return Verdict::forged;
  }
  const SigningTime time = time_of_text(signature.substr(1));
  time_ = std::max(time_, clock_());
  SigningTime& last = streams_[{system, component, signature[0]}];
  if (time <= last || time + kSigningMinute < time_) {
    return Verdict::replayed;
  }
  last = time;
  time_ = std::max(time_, time);
  return Verdict::accepted;
}

std::string Signer::hash(std::string_view frame, std::string_view link_and_time) const {
  std::string all(key_.data(), key_.size());
  all.append(frame).append(link_and_time);
  const std::string digits = host::sha256_of(all);
  std::string bytes;
  for (std::size_t n = 0; n < kHashBytes; ++n) {
    unsigned value = 0;
    std::from_chars(digits.data() + 2 * n, digits.data() + 2 * n + 2, value, 16);
    bytes += static_cast<char>(value);
  }
  return bytes;
}
}  // namespace altiplan::link
