// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/kit/dubins/dubins.hpp"

/// \file Paths with a turn radius between poses at different heights, climbing at one gradient.
/// H. Chitsaz, S. M. LaValle: Time-optimal Paths for a Dubins Airplane. CDC 2007,
/// doi:10.1109/CDC.2007.4434966; M. Owen, R. W. Beard, T. W. McLain: Implementing Dubins Airplane
/// Paths on Fixed-Wing UAVs. Handbook of Unmanned Aerial Vehicles, 2015,
/// doi:10.1007/978-90-481-9707-1_120; P. Váňa, A. Alves Neto, J. Faigl, D. G. Macharet: Minimal 3D
/// Dubins Path with Bounded Curvature and Pitch Angle. ICRA 2020,
/// doi:10.1109/ICRA40945.2020.9197084.
///
/// A path must be as long as its climb takes at the limit. If the shortest one is, it is taken.
/// Otherwise one is taken that has just that length, so that none is shorter: a word with a larger
/// radius, perhaps with whole circles added to its first or last turn, or a word after or before an
/// extra turn of the least radius. Between poses a few radii apart there may be none; then the
/// shortest of those that are longer is taken.
namespace altiplan::kit {

struct ALTIPLAN_API AirplaneLimits {
  double radius = 0;  ///< metres, positive; the least
  double climb = 0;   ///< greatest climb angle, radians, in [0, π/2)
  double sink = 0;    ///< greatest sink angle, radians, in [0, π/2)

  /// Least horizontal length of a path that changes the height by that much; infinite if the limit
  /// is 0.
  double min_length(double height_change) const;
};

struct ALTIPLAN_API AirplanePath {
  DubinsPath word;    ///< its first or last turn may have whole circles more than the word needs
  double before = 0;  ///< extra turn before the word, radians, positive to the left
  double after = 0;   ///< the same after it

  /// Horizontal, metres.
  double length() const { return word.length() + word.radius * std::abs(before + after); }
  /// The height changes linearly with the horizontal length. `wind` is in units of the airspeed.
  std::vector<Leg> legs(const Pose& from, const Vec3& to, const Vec3& wind = Vec3::Zero()) const;
};

/// The path; none if the height must change and that limit is 0.
ALTIPLAN_API std::optional<AirplanePath> airplane_path(const Pose& from, const Pose& to,
                                                       const AirplaneLimits& limits);
/// Its horizontal length, which takes less time; infinite if there is none, or if it is more than
/// `at_most`, which takes less still.
ALTIPLAN_API double airplane_length(const Pose& from, const Pose& to, const AirplaneLimits& limits,
                                    double at_most = kInfinity);

/// The shortest path of the above kinds that is at least that long, horizontally.
ALTIPLAN_API AirplanePath path_of_length(const PosePair& pair, double radius, double min_length);
}  // namespace altiplan::kit
