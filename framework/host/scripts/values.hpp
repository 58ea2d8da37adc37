// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "altiplan/environment.hpp"
#include "altiplan/request.hpp"

namespace altiplan::host {

// What crosses to a plugin in Python as values: everything but the world, which it asks.
nlohmann::ordered_json script_values(const Request& request);
nlohmann::ordered_json script_values(const Site& site);
}  // namespace altiplan::host
