// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "host/autopilot/parameters.hpp"

namespace altiplan::host {

/// A parameter of the autopilot, by the name and in the unit of the parameter file that is given.
struct ReturnCure {
  std::string parameter;
  double value = 0;
};

/// The minimum height at which the autopilot returns, in whole metres above the present one and up
/// to 600 m more, with which a flight passes; none where no height does.
std::optional<ReturnCure> min_return_height(
    formats::Autopilot autopilot, const ParameterFile& given,
    const std::function<bool(const ParameterFile&)>& passes);
}  // namespace altiplan::host
