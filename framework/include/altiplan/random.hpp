// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// A counter-based stream of random numbers: number n of a stream is a hash of (key, n), so streams
/// are named, not shared, and results do not depend on threads. Satisfies
/// UniformRandomBitGenerator; the distributions below are our own, identical on every platform.
class RandomStream {
 public:
  using result_type = std::uint64_t;

  RandomStream() = default;
  explicit RandomStream(std::uint64_t seed) : key_(mix(seed + kGolden)) {}

  /// An independent stream, identified by its use and an index ("sample", 3).
  RandomStream sub(std::string_view use, std::uint64_t index = 0) const {
    std::uint64_t hash = key_;
    for (const char c : use) {
      hash = mix(hash ^ (std::uint64_t(static_cast<unsigned char>(c)) + kGolden));
    }
    RandomStream stream;
    stream.key_ = mix(hash ^ mix(index + kGolden));
    return stream;
  }

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }
  result_type operator()() { return mix(key_ + kGolden * ++counter_); }

  /// Uniform in [0, 1).
  double uniform() { return double((*this)() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [low, high].
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    const auto span = static_cast<std::uint64_t>(high - low) + 1;
    if (span == 0) {
      return static_cast<std::int64_t>((*this)());
    }
    __extension__ using Wide = unsigned __int128;
    const Wide wide = static_cast<Wide>((*this)()) * span;
    return low + static_cast<std::int64_t>(wide >> 64);
  }
  /// Standard normal (Box–Muller, one of the pair).
  double normal() {
    const double u = 1.0 - uniform();
    const double v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi * v);
  }
  /// Uniform in a bounded box.
  Vec3 in(const Box& box) {
    const double x = uniform(box.min.x(), box.max.x());
    const double y = uniform(box.min.y(), box.max.y());
    const double z = uniform(box.min.z(), box.max.z());
    return {x, y, z};
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  /// The finaliser of splitmix64.
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::uint64_t key_ = 0;
  std::uint64_t counter_ = 0;
};

/// The sequential generator of the published worlds (splitmix64, the seed is the state).
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return double(next() >> 11) * 0x1p-53; }
  /// a + floor(u (b - a + 1)).
  int integer(int a, int b) { return a + int(std::floor(uniform() * (b - a + 1))); }

 private:
  std::uint64_t state_;
};
}  // namespace altiplan
