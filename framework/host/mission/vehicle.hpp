// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/request.hpp"
#include "host/config/scenario_file.hpp"

namespace altiplan::host {

Vehicle vehicle_of(const VehicleEntry& entry);
Wind wind_of(const WindEntry& entry);
}  // namespace altiplan::host
