// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Says which zone of the layer is violated: the only place that does.
void name_zone(Finding& finding, const World& world);
/// Tells a void of the elevation model from ground.
void name_void(Finding& finding, const World& world);
bool is_ground_layer(const std::string& id, const World& world);
}  // namespace altiplan::host
