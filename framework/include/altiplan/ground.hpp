// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/geometry.hpp"

namespace altiplan {

class HeightField;

/// The ground of a layer, the reference of heights above ground: one height per horizontal
/// position, solid below. Immutable; lives as long as its layer. There is no ground at a position
/// that is not finite; the layer is not asked.
///
/// Contract of every ground, tested by the conformance suite:
///  1. Pure, like its layer; const functions are thread-safe.
///  2. height(x, y) is the height of the ground there, if there is any; the layer is blocked below
///     it.
///  3. gap is the minimum height of a leg above the ground, exact within 1e-6 m.
///  4. slope is never less than that of the ground.
///  5. distance, where it returns a value, agrees with what the layer blocks, if it blocks nothing
///     else.
///  6. height_field, where there is one, holds the same ground.
class ALTIPLAN_API Ground {
 public:
  virtual ~Ground();

  std::optional<double> height(double x, double y) const;
  /// Minimum height of the leg above the ground; -infinity where there is none below part of the
  /// leg; any value of at least `enough` once the leg is known to be that high.
  double gap(const Vec3& a, const Vec3& b, double enough = kInfinity) const;
  /// Maximum height of the leg above the ground; +infinity where there is none below part of the
  /// leg.
  double gap_max(const Vec3& a, const Vec3& b) const;
  /// Minimum distance of the ground from a leg that lies above it, within 1e-6 m; none if not
  /// implemented: the caller then finds it by bisection on `blocked`.
  std::optional<double> distance(const Vec3& a, const Vec3& b) const;
  /// Maximum slope (rise over run) within the horizontal box, an upper bound; infinite where it is
  /// unknown or the ground has holes there.
  double slope(const Box& box) const { return do_slope(box); }
  /// True if the layer blocks nothing but its ground: a leg whose gap is at least r sqrt(1 + s²), s
  /// the maximum slope within r of it (0 for r <= 0), is then not blocked.
  bool is_all() const { return do_is_all(); }
  /// The ground as posts, if it is an elevation model: concrete data for inner loops; null
  /// otherwise. Lives as long as the layer.
  const HeightField* height_field() const { return do_height_field(); }

 private:
  virtual std::optional<double> do_height(double x, double y) const = 0;
  virtual double do_gap(const Vec3& a, const Vec3& b, double enough) const = 0;
  /// Default: +infinity, which guarantees nothing; likewise the defaults below.
  virtual double do_gap_max(const Vec3& a, const Vec3& b) const;
  virtual std::optional<double> do_distance(const Vec3& a, const Vec3& b) const;
  virtual double do_slope(const Box& box) const;
  virtual bool do_is_all() const;
  virtual const HeightField* do_height_field() const;
};
}  // namespace altiplan
