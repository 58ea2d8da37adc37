// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/geometry.hpp"

namespace altiplan::kit {

/// Second base of an objective whose cost of a straight leg is its length times a mean that is the
/// same at all heights: a search over many levels of cells asks once for all of them.
class MeanCost {
 public:
  virtual ~MeanCost() = default;
  /// Cost per metre of straight legs from a place above or below `from` to one above or below `to`,
  /// at least 0; infinite where a leg cannot be priced.
  virtual double per_metre(const Vec3& from, const Vec3& to) const = 0;
  /// False: the height matters after all, and per_metre must not be asked.
  virtual bool is_mean() const { return true; }
};
}  // namespace altiplan::kit
