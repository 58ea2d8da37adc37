// SPDX-License-Identifier: Apache-2.0
#include "altiplan/environment.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/swept_volume.hpp"
#include "altiplan/what_blocks.hpp"
#include "altiplan/world.hpp"

namespace altiplan {

Vec3 Site::resolve(const Point& point) const {
  Vec3 p(point.at[0], point.at[1], point.at[2]);
  switch (point.form) {
    case Point::Form::none:
      throw Error("a point is missing: give at_m, at_lonlat or at_cell");
    case Point::Form::metres:
      break;
    case Point::Form::lonlat: {
      const auto local = frame.to_local(point.at[0], point.at[1]);
      p.x() = local[0];
      p.y() = local[1];
      break;
    }
    case Point::Form::cell: {
      std::optional<Vec3> centre;
      for (const Layer& layer : before->layers()) {
        if (!centre) {
          centre = layer.environment->cell_centre(point.at);
        }
      }
      if (!centre) {
        throw Error("at_cell needs a layer with its own cells (a grid or voxel map) before it");
      }
      p = *centre;
      break;
    }
  }
  if (point.above_ground_m) {
    const auto ground = before->ground(p.x(), p.y());
    if (!ground) {
      throw Error(before->has_ground() ? "above_ground_m: there is no ground below this point"
                                       : "above_ground_m needs a layer with ground (terrain)");
    }
    p.z() = *ground + *point.above_ground_m;
  }
  return p;
}

Environment::~Environment() = default;
WhatBlocks::~WhatBlocks() = default;

// Layers are queried at finite positions only; any other position counts as blocked.
double Environment::clearance(const Vec3& p) const {
  return is_finite(p) ? do_clearance(p) : -kInfinity;
}

bool Environment::blocked(const Vec3& a, const Vec3& b, double r) const {
  if (!std::isfinite((b - a).squaredNorm()) || !std::isfinite(r)) {
    return r != -kInfinity;
  }
  // Fixed order of the ends, so that the answer is symmetric to the last bit.
  const bool swap = std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3);
  return swap ? do_blocked(b, a, r) : do_blocked(a, b, r);
}

void Environment::near(const Vec3& p, double reach, const NearSink& sink) const {
  if (is_finite(p) && !std::isnan(reach)) {
    do_near(p, reach, sink);
  }
}

bool Environment::do_blocked(const Vec3& a, const Vec3& b, double r) const {
  // Clearance is 1-Lipschitz: the ball of radius (clearance - r) around a point is free. With the
  // over-approximation added to the threshold no step is shorter than it.
  const double slack = std::max(do_over_approximation(), kLengthTolerance);
  const double total = (b - a).norm();
  double along = 0;
  while (true) {
    const Vec3 p = total > 0 ? Vec3(a + (b - a) * std::min(along / total, 1.0)) : a;
    const double spare = do_clearance(p) - (r - kLengthTolerance);
    if (!(spare >= slack)) {
      return true;
    }
    if (along >= total) {
      return false;
    }
    along += spare;
  }
}

void Environment::do_near(const Vec3& p, double reach, const NearSink& sink) const {
  const double distance = do_clearance(p);
  if (!(distance <= reach)) {
    return;
  }
  constexpr double kStep = 1e-3;
  Vec3 normal;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 step = Vec3::Zero();
    step[axis] = kStep;
    normal[axis] = do_clearance(p + step) - do_clearance(p - step);
  }
  normal = normal.squaredNorm() > 0 ? Vec3(normal.normalized()) : Vec3(0, 0, 1);
  sink({p - normal * distance, distance, normal, 0});
}

void Environment::do_rasterize(VoxelGrid& grid) const {
  const GridSpec& spec = grid.spec();
  const double half_diagonal = spec.cell.norm() / 2;
  const bool centre_rule = spec.rule == GridSpec::Rule::centre;
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      grid.ask_watch();
      for (int i = 0; i < spec.counts[0]; ++i) {
        const double clearance = do_clearance(spec.centre({i, j, k}));
        if (centre_rule ? clearance <= spec.inflation
                        : clearance < half_diagonal + spec.inflation) {
          grid.set({i, j, k}, true);
        }
      }
    }
  }
}

double Environment::do_over_approximation() const { return 0.05; }
const Ground* Environment::do_ground() const { return nullptr; }
const Field* Environment::do_field() const { return nullptr; }
const LayerInfo& Environment::do_info() const {
  static const LayerInfo kNothing;
  return kNothing;
}
std::optional<Vec3> Environment::do_cell_centre(const std::array<double, 3>&) const {
  return std::nullopt;
}
std::optional<Drawing> Environment::do_drawing() const { return std::nullopt; }

bool Environment::do_meets(const SweptVolume& volume) const {
  return meets_by_clearance(
      volume, [this](const Vec3& p) { return do_clearance(p); }, do_over_approximation());
}
}  // namespace altiplan
