// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "threats.hpp"

namespace velocity_field {

/// Virtual targets of paper 001, section 2.2: behind each threat that overlaps another there is a
/// point that leads out of the trap between the two.
class VirtualTargets {
 public:
  /// `balance` is L2 - r.
  VirtualTargets(double balance, double release) : balance_(balance), release_(release) {}

  /// Drops the active one, and adopts new threats or a new target.
  void reset(const Threats& threats);

  /// The point to fly to: the target, or the active virtual target. `inside` are the threats whose
  /// rings contain the vehicle; `heading` is the current one.
  Vec2 aim(const Threats& threats, const Vec2& target, const Vec2& here, const Vec2& heading,
           const std::vector<std::uint32_t>& inside);

  /// Index of the threat whose virtual target is active.
  std::optional<std::uint32_t> active() const { return active_; }
  /// True if the active one lies inside another threat.
  bool is_inside_another() const { return inside_another_; }
  std::int64_t potential() const { return potential_; }
  std::int64_t entries() const { return entries_; }
  std::int64_t used() const { return used_; }
  std::int64_t inside_threats() const { return inside_threats_; }

  /// T + (1 + L2 / L1) (c - T), eq. (8): behind the threat as seen from the target.
  Vec2 place(const Disc& threat, const Vec2& target) const;

 private:
  struct Pair {
    std::uint32_t threat = 0;  ///< the one with the virtual target
    std::uint32_t other = 0;
  };
  /// A threat of some pair whose ring contains the vehicle.
  struct Near {
    std::uint32_t threat = 0;
    double side = 0;          ///< of the vehicle relative to the ray from the target to its centre
    std::uint32_t other = 0;  ///< the first that traps the vehicle together with it
    bool traps = false;
  };
  void find_traps(const Threats& threats, const Vec2& target, const Vec2& here,
                  const std::vector<std::uint32_t>& inside);
  /// The virtual target, of all trapped pairs, that turns the heading least.
  std::optional<Pair> choose(const Threats& threats, const Vec2& target, const Vec2& here,
                             const Vec2& heading, const std::vector<std::uint32_t>& inside);
  void activate(const Threats& threats, const Pair& pair, const Vec2& place);

  double balance_;
  double release_;
  std::optional<std::uint32_t> active_;
  std::uint32_t other_ = 0;  ///< the threat that forms a pair with the active one
  bool inside_another_ = false;
  std::vector<Near> near_;
  std::vector<char> in_pair_;   ///< one entry per threat: true if another overlaps it
  std::vector<char> was_used_;  ///< one entry per threat
  std::int64_t potential_ = 0;
  std::int64_t entries_ = 0;
  std::int64_t used_ = 0;
  std::int64_t inside_threats_ = 0;
};

/// True if p lies between the rays from the target to the two centres.
bool is_in_wedge(const Vec2& p, const Vec2& target, const Vec2& a, const Vec2& b);
/// True if the line through the two centres lies between p and the target.
bool is_beyond_chord(const Vec2& p, const Vec2& target, const Vec2& a, const Vec2& b);
}  // namespace velocity_field
