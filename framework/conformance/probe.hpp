// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "altiplan/field.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "report.hpp"

namespace altiplan::conformance {

// The contract of environment.hpp.
inline constexpr const char* kEnvironmentPure =
    "Environment contract 1: pure, built from (parameters, Site) alone; const functions may run on "
    "many "
    "threads";
inline constexpr const char* kEnvironmentClearance =
    "Environment contract 2: clearance is signed, 1-Lipschitz, never more than the true distance";
inline constexpr const char* kEnvironmentBlocked =
    "Environment contract 3: blocked where the minimum distance is below r - 1e-6 m, free above r "
    "+ "
    "slack; "
    "touching is free";
inline constexpr const char* kEnvironmentSymmetric =
    "Environment contract 4: blocked is symmetric in a and b, and monotone in r";
inline constexpr const char* kEnvironmentGround =
    "Environment contract 5: height, gap and related functions agree on one ground; beyond it "
    "nothing is blocked";
inline constexpr const char* kEnvironmentRaster =
    "Environment contract 6: rasterize never leaves a cell free that the grid's rule blocks";
inline constexpr const char* kEnvironmentBody =
    "Environment contract 7: meets where layer and body overlap, free beyond the tolerance";
inline constexpr const char* kEnvironmentField =
    "Field contract 2: values are at least 0 and finite, or none";
inline constexpr const char* kEnvironmentNear =
    "Environment::near: each obstacle in reach, once, in agreement with clearance";
inline constexpr const char* kEnvironmentBounds =
    "Environment::bounds: obstacles and ground lie inside";
inline constexpr const char* kEnvironmentKin =
    "Environment: over-approximation, threats, native grid, cells and frame are consistent";

/// Minimum depth that counts as inside a layer: deeper than the rounding error of its surface.
inline constexpr double kDeep = 1e-5;

struct EnvironmentBench {
  EnvironmentFactory make;
  Options options;
  std::shared_ptr<const World> before;

  Site site() const;
};

/// Points at which to query one environment: many of them near its surface and its ground.
class Probe {
 public:
  Probe(const EnvironmentBench& bench, const std::string& use);

  const Environment& layer() const { return *layer_; }
  const Box& volume() const { return volume_; }
  /// Longest edge of the volume.
  double size() const { return (volume_.max - volume_.min).maxCoeff(); }
  /// True if any surface was found in the volume.
  bool has_surface() const { return !surface_.empty(); }
  Vec3 point();
  struct AskedLeg {
    Vec3 a, b;
    double r;
  };
  AskedLeg leg();
  RandomStream& random() { return random_; }
  bool inside(const Vec3& p) const { return layer_->clearance(p) < -kDeep; }
  /// A random point up to `reach` from p.
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
Cases environment_body_cases(const EnvironmentBench& bench);
}  // namespace altiplan::conformance
