// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/leg.hpp"

/// \file Shortest horizontal paths of bounded curvature between two poses. L. E. Dubins: On Curves
/// of Minimal Length with a Constraint on Average Curvature, and with Prescribed Initial and
/// Terminal Positions and Tangents. American Journal of Mathematics 79(3), 1957,
/// doi:10.2307/2372560.
namespace altiplan::kit {

/// The sequences of turns to the left and right and straight parts that a shortest path can have.
/// Of three turns, the middle one is at least a half circle: others are never shortest.
enum class DubinsWord : std::uint8_t { lsl, rsr, rsl, lsr, lrl, rlr };

inline constexpr std::array kDubinsWords{DubinsWord::lsl, DubinsWord::rsr, DubinsWord::rsl,
                                         DubinsWord::lsr, DubinsWord::lrl, DubinsWord::rlr};

/// Sense of part 0, 1 or 2 of a word: 1 left, -1 right, 0 straight.
ALTIPLAN_API int turn_sense(DubinsWord word, int part);

struct ALTIPLAN_API DubinsPath {
  DubinsWord word = DubinsWord::lsl;
  double radius = 1;              ///< metres, positive
  std::array<double, 3> parts{};  ///< lengths, at least 0, in units of the radius: turns in radians

  double length() const { return radius * (parts[0] + parts[1] + parts[2]); }
  /// One leg for each part that has a length, from the pose to the position that the path leads to.
  /// The height changes linearly along them.
  std::vector<Leg> legs(const Pose& from, const Vec3& to) const;
};

/// Two poses, the second as seen from the first: what the words and radii have in common. Heights
/// do not matter. Offsets below 1e-11 radii and angles below 1e-12 rad are rounding errors: no
/// circle is flown to correct them. A length takes about 0.1 µs.
struct ALTIPLAN_API PosePair {
  PosePair(const Pose& from, const Pose& to);
  /// The same with the second pose displaced.
  PosePair displaced(const Vec3& by) const;
  /// The same for the paths in the opposite direction: headings turned by π.
  PosePair reversed() const;
  /// The same from the end of a turn (radians, positive to the left) that the first pose begins.
  PosePair after_turn(double angle, double radius) const;

  /// Horizontal, metres.
  double distance() const { return std::sqrt(ahead * ahead + left * left); }

  /// Length of the shortest path, metres. The radius must be positive, here and below.
  double length(double radius) const;
  /// Of the shortest path of a word; infinite if there is none.
  double length(double radius, DubinsWord word) const;
  /// Lengths of the shortest paths of each word in the order of kDubinsWords; infinite if none.
  std::array<double, 6> lengths(double radius) const;
  DubinsPath path(double radius) const;
  std::optional<DubinsPath> path(double radius, DubinsWord word) const;

  double ahead;     ///< metres from the first pose in the direction of its heading
  double left;      ///< metres to its left
  double turn;      ///< from its heading to the other one, in [0, 2π)
  double sin;       ///< of `turn`
  double cos;       ///< of `turn`
  double versed;    ///< 1 - cos, without cancellation
  double from_sin;  ///< of the first heading
  double from_cos;  ///< of the first heading

 private:
  void set_turn(double s, double c);
};

inline double dubins_length(const Pose& from, const Pose& to, double radius) {
  return PosePair(from, to).length(radius);
}
inline DubinsPath dubins_path(const Pose& from, const Pose& to, double radius) {
  return PosePair(from, to).path(radius);
}
inline std::optional<DubinsPath> dubins_path(const Pose& from, const Pose& to, double radius,
                                             DubinsWord word) {
  return PosePair(from, to).path(radius, word);
}
}  // namespace altiplan::kit
