// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/geometry.hpp"

namespace altiplan {

class HeightField;

/// The ground of a layer, on which heights are counted: one height at a place, solid from there
/// down. Immutable; lives as long as its layer. Where a place is not finite there is no ground; the
/// layer is not asked.
///
/// Laws, held by every ground and tested by the conformance suite:
///  1. Pure, as its layer is; const functions may run on many threads.
///  2. height(x, y) is the height of the ground there, if there is any; the layer is blocked below
///     it.
///  3. gap is the least height of a leg above the ground, exact within 1e-6 m.
///  4. slope is never less than that of the ground.
///  5. distance, where it tells, agrees with what the layer blocks, if it blocks nothing else.
///  6. height_field, where there is one, holds the same ground.
class ALTIPLAN_API Ground {
 public:
  virtual ~Ground();

  std::optional<double> height(double x, double y) const;
  /// Least height of the leg above the ground; -infinity where there is none below part of the leg;
  /// any value of at least `enough` once the leg is known to be that high.
  double gap(const Vec3& a, const Vec3& b, double enough = kInfinity) const;
  /// Greatest height of the leg above the ground; +infinity where there is none below part of the
  /// leg.
  double gap_max(const Vec3& a, const Vec3& b) const;
  /// Least distance of the ground from a leg that lies above it, within 1e-6 m; none where the
  /// ground does not tell: then it is sought by asking whether the layer blocks.
  std::optional<double> distance(const Vec3& a, const Vec3& b) const;
  /// Steepest slope (rise over run) within the horizontal box, an upper bound; infinite where it is
  /// not known or the ground has holes there.
  double slope(const Box& box) const { return do_slope(box); }
  /// Whether it is all that the layer blocks: a leg whose gap is at least r sqrt(1 + s²), s the
  /// steepest slope within r of it (0 for r <= 0), is then not blocked.
  bool is_all() const { return do_is_all(); }
  /// The ground as posts, where it is that (an elevation model): concrete data for inner loops;
  /// null otherwise. Lives as long as the layer.
  const HeightField* height_field() const { return do_height_field(); }

 private:
  virtual std::optional<double> do_height(double x, double y) const = 0;
  virtual double do_gap(const Vec3& a, const Vec3& b, double enough) const = 0;
  /// Default: +infinity, which claims nothing; so do the defaults of the rest.
  virtual double do_gap_max(const Vec3& a, const Vec3& b) const;
  virtual std::optional<double> do_distance(const Vec3& a, const Vec3& b) const;
  virtual double do_slope(const Box& box) const;
  virtual bool do_is_all() const;
  virtual const HeightField* do_height_field() const;
};
}  // namespace altiplan
