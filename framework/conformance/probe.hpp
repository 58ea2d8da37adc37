// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "report.hpp"

namespace altiplan::conformance {

// The laws of environment.hpp.
inline constexpr const char* kEnvironmentPure =
    "Environment contract 1: pure, built from (parameters, Site) alone; const functions may run on many "
    "threads";
inline constexpr const char* kEnvironmentClearance =
    "Environment contract 2: clearance is signed, 1-Lipschitz, never more than the true distance";
inline constexpr const char* kEnvironmentBlocked =
    "Environment contract 3: blocked where the least distance is below r - 1e-6 m, free above r + "
    "slack; "
    "touching is free";
inline constexpr const char* kEnvironmentSymmetric =
    "Environment contract 4: blocked is symmetric in a and b, and monotone in r";
inline constexpr const char* kEnvironmentGround =
    "Environment contract 5: height, gap and their kin tell one ground; beyond it nothing is blocked";
inline constexpr const char* kEnvironmentRaster =
    "Environment contract 6: rasterize never leaves a cell free that the grid's rule blocks";
inline constexpr const char* kEnvironmentNear =
    "Environment::near: each obstacle in reach, once, in agreement with clearance";
inline constexpr const char* kEnvironmentBounds =
    "Environment::bounds: obstacles and ground lie inside";
inline constexpr const char* kEnvironmentKin =
    "Environment: slack, threats, native grid, cells and frame make sense";

/// What counts as inside a layer: deeper than what rounding makes of its surface.
inline constexpr double kDeep = 1e-5;

struct EnvironmentBench {
  EnvironmentFactory make;
  Options options;
  std::shared_ptr<const World> before;

  Site site() const;
};

/// Places at which to ask one environment: many of them near its surface and its ground.
class Probe {
 public:
  Probe(const EnvironmentBench& bench, const std::string& use);

  const Environment& layer() const { return *layer_; }
  const Box& volume() const { return volume_; }
  /// Greatest edge of the volume.
  double size() const { return (volume_.max - volume_.min).maxCoeff(); }
  /// Whether any surface was found in the volume.
  bool has_surface() const { return !surface_.empty(); }
  Vec3 point();
  struct AskedLeg {
    Vec3 a, b;
    double r;
  };
  AskedLeg leg();
  RandomStream& random() { return random_; }
  bool inside(const Vec3& p) const { return layer_->clearance(p) < -kDeep; }
  /// A point up to `reach` from p.
  Vec3 around(const Vec3& p, double reach);

 private:
  void find_surface();
  std::unique_ptr<Environment> layer_;
  RandomStream random_;
  Box volume_;
  std::vector<Vec3> surface_;
};

std::string text(const Probe::AskedLeg& leg);
using conformance::text;

Cases environment_ground_cases(const EnvironmentBench& bench);
Cases environment_grid_cases(const EnvironmentBench& bench);
}  // namespace altiplan::conformance
