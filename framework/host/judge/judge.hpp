// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/request.hpp"
#include "host/judge/runways.hpp"

namespace altiplan::host {

/// The API's check, the via points in order, and a consistency check of each layer's `blocked`
/// against its `clearance` along the route: if they disagree, the violation's constraint is "layer"
/// and its message names the layer.
CheckResult judge(const Route& route, const Request& request, const std::vector<Goal>& via,
                  const Runways& runways = {});

/// What a route costs by the request's objective, and a lower bound of the cost of all routes that
/// pass the via points.
struct Cost {
  double cost = 0;
  double bound = 0;
  /// By how much the route may cost too much, as a share of the bound; infinite if that is 0.
  double gap() const { return cost > bound ? (cost - bound) / bound : 0; }
};
Cost price(const Route& route, const Request& request, const std::vector<Goal>& via);

/// Index of the waypoint at each via point, in order; shorter than `via` if one is not passed.
std::vector<std::size_t> via_indices(const Route& route, const std::vector<Goal>& via);

/// The verdict in a sentence: the number of violations, and `shown`.
std::string verdict_sentence(const CheckResult& result, const Violation& shown);

/// The violation of a layer that contradicts itself; null if there is none.
const Violation* violated_layer(const CheckResult& result);
}  // namespace altiplan::host
