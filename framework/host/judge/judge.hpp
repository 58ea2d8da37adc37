// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/request.hpp"

namespace altiplan::host {

/// The API's check, the via points in order, and a look at whether each layer's `blocked` agrees
/// with its `clearance` along the route: where it does not, the violation's constraint is "layer"
/// and its message names the layer.
CheckResult judge(const Route& route, const Request& request, const std::vector<Goal>& via);

/// Index of the waypoint at each via point, in order; shorter than `via` where one is not passed.
std::vector<std::size_t> via_indices(const Route& route, const std::vector<Goal>& via);

/// What the judge found, in a sentence: how many violations there are, and one of them.
std::string verdict_sentence(const CheckResult& result, const Violation& shown);

/// The violation that says that a layer contradicts itself; null where there is none.
const Violation* violated_layer(const CheckResult& result);
}  // namespace altiplan::host
