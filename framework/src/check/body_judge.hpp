// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/request.hpp"
#include "altiplan/swept_volume.hpp"

namespace altiplan {

/// A motion of the body over t in [0, 1], along a line or a turn, while it rotates about an axis.
/// At equal t, no point of the body is farther than bend * dt² from the straight line between its
/// places at the ends of a piece dt.
struct Sweep {
  Eigen::Matrix3d rotation;  ///< with which it begins
  Vec3 from{0, 0, 0};
  Vec3 way{0, 0, 0};
  std::optional<Leg> turn{};  ///< in place of the line
  double angle = 0;           ///< by which it rotates
  Vec3 axis{0, 0, 1};
  double bend = 0;
  int headings = 1;    ///< more: any is possible, and that many are looked at
  double between = 0;  ///< what lies between the headings is no farther than that from their hull

  /// Adds the placements of a moment, one for each heading.
  void place(double t, std::vector<Placement>& all) const;
};

/// The motions of the vehicle's body on a leg, in order.
std::vector<Sweep> body_sweeps(const std::optional<Approach>& before, const Leg& leg,
                               const Request& request);
}  // namespace altiplan
