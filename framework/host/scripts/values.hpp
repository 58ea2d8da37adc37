// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/environment.hpp"
#include "altiplan/request.hpp"
#include "host/base/json.hpp"

namespace altiplan::host {

// What crosses to a plugin in Python as values: everything but the world, which it asks.
Json script_values(const Request& request);
Json script_values(const Site& site);
}  // namespace altiplan::host
