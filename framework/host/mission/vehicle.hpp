// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/request.hpp"
#include "host/config/config.hpp"

namespace altiplan::host {

/// `where` locates the key `vehicle`; the registry's plugin `mesh` reads meshes of a body. Throws
/// ConfigError.
Vehicle vehicle_of(const VehicleEntry& entry, const Value* where, Registry& registry);
}  // namespace altiplan::host
