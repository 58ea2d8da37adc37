// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// A scalar field that a layer offers to objectives, such as how probably a radar detects a
/// vehicle. It blocks nothing. Immutable; lives as long as its layer.
///
/// Contract of every field, tested by the conformance suite:
///  1. Pure, like its layer; const functions are thread-safe.
///  2. value is at least 0 and finite, or none where the field has none. A position that is not
///     finite has none; the layer is not asked.
class ALTIPLAN_API Field {
 public:
  virtual ~Field();
  /// Throws PluginError if it is negative or no finite number.
  std::optional<double> value(const Vec3& p) const;

 private:
  virtual std::optional<double> do_value(const Vec3& p) const = 0;
};
}  // namespace altiplan
