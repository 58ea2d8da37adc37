// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "altiplan/plugin_abi.hpp"
#include "altiplan/shape.hpp"

namespace altiplan::host {

// The built-in shapes sphere, cylinder, box and prism: as layers they are plugins like any other,
// but without a library; as moving obstacles they also have a velocity.

/// The shapes as environments.
std::span<const PluginEntry> built_in_environments();

/// The shape and velocity of an entry of `moving`.
struct MovingShape {
  Shape shape;
  Vec3 velocity{0, 0, 0};
};

/// Names under `moving`: the four shapes.
std::vector<std::string> moving_shapes();
/// Reads an entry's parameters; null if no shape has that name.
using DescribeMoving = ParamReport (*)(const Value* parameters, const std::string& path);
DescribeMoving describe_moving(std::string_view name);
/// Throws Error as Site::resolve does.
MovingShape make_moving(std::string_view name, const Value& parameters, const Site& site);

/// `random: {count, seed, radius_m, speed_mps}` under `moving`: spheres anywhere in the volume,
/// flying straight in any horizontal direction.
struct RandomMoving {
  int count = 1;
  std::optional<std::int64_t> seed;
  double radius_m = 0;
  double speed_mps = 0;
  void describe(Fields& f);
};
}  // namespace altiplan::host
