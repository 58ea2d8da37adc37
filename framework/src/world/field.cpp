// SPDX-License-Identifier: Apache-2.0
#include "altiplan/field.hpp"

#include <cmath>

#include "altiplan/attributed.hpp"

namespace altiplan {

Field::~Field() = default;

std::optional<double> Field::value(const Vec3& p) const {
  if (!is_finite(p)) {
    return std::nullopt;
  }
  const std::optional<double> value =
      attributed([] { return std::string("the field"); }, [&] { return do_value(p); });
  if (value && !(*value >= 0 && std::isfinite(*value))) {
    throw PluginError("the field violated the contract of its interface: a value is " +
                          std::to_string(*value) + ", expected a finite number of at least 0",
                      Reason::contract);
  }
  return value;
}
}  // namespace altiplan
