// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/frame.hpp"
#include "altiplan/random.hpp"
#include "altiplan/vehicle.hpp"
#include "altiplan/wind.hpp"

namespace altiplan {

class World;

/// Inputs besides their parameters of environments, constraints, objectives and tasks.
struct ALTIPLAN_API Site {
  Frame frame;                ///< without a position until a layer provides one
  std::string frame_crs;      ///< from the scenario's `frame: {crs: …}`, or ""
  std::vector<LonLat> about;  ///< positions of a judged mission: lengths are true about them
  Box volume;                 ///< infinite where the scenario leaves it to the layers
  Vehicle vehicle;
  Wind wind;
  const World* before = nullptr;  ///< the layers before it, of other kinds all; not null
  std::optional<Vec3> start;      ///< if already known
  std::optional<Vec3> goal;
  double start_time_s = 0;  ///< of the scenario, seconds since 1970-01-01 UTC; 0 where not given
  bool has_start_time = false;
  RandomStream random;

  /// A user's point in local metres; throws Error naming what is missing (a frame with a position,
  /// ground below it, a layer with cells).
  Vec3 resolve(const Point& point) const;
};
}  // namespace altiplan
