// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "altiplan/geometry.hpp"
#include "altiplan/kit/layers/ground_within.hpp"

namespace hills {

/// A bell: height exp(-((x - x0) / sx)² / 2 - ((y - y0) / sy)² / 2), metres.
struct Peak {
  double x, y;
  double height;
  double sx, sy;
};

double bells(const std::vector<Peak>& peaks, double x, double y);

/// The ground min(cap, base + Σ bells), and certified bounds of it.
class Surface {
 public:
  Surface(double base, double cap, std::vector<Peak> peaks);

  double height(double x, double y) const { return std::min(cap_, base_ + bells(peaks_, x, y)); }
  /// Upper bound of the ground.
  double top() const { return top_; }
  /// Upper bound of the slope; within 1 % of the steepest.
  double max_slope() const { return max_slope_; }
  /// Upper bound of the slope within r of (x, y).
  double max_slope(double x, double y, double r) const;
  /// Upper bound of the ground in the closed box; one evaluation, loose in a large box.
  double height_bound(double x0, double y0, double x1, double y1) const;
  /// The ground over the closed box.
  altiplan::kit::GroundPiece piece(double x0, double y0, double x1, double y1) const;
  /// Intervals along an axis: their middles `step` apart starting at `first`, each extending `half`
  /// to both sides.
  struct Intervals {
    double first, step, half;
    int count;
  };
  /// Upper bound of the ground in each closed box of an interval east and one north (rows from the
  /// south, each from the west); within about `within` metres of the highest ground if the hills
  /// are wide compared with the boxes.
  std::vector<double> highest(const Intervals& east, const Intervals& north, double within) const;

  /// Minimum height of the leg above the ground, within 1e-7 m; may return any value of at least
  /// `enough` once it is known to be that high, and any below `too_low` once it is known to be that
  /// low.
  double gap(const altiplan::Vec3& a, const altiplan::Vec3& b, double enough,
             double too_low = -altiplan::kInfinity) const;
  /// Maximum height of the leg above the ground, likewise.
  double gap_max(const altiplan::Vec3& a, const altiplan::Vec3& b) const;

 private:
  struct Local {
    double sum, dx, dy;
  };
  Local local(double x, double y) const;
  double bend(double x, double y, double r) const;
  double steepest() const;

  double base_;
  double cap_;
  std::vector<Peak> peaks_;
  double top_;
  double max_slope_ = altiplan::kInfinity;
};
}  // namespace hills
