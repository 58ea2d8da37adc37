// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/route.hpp"

namespace altiplan::host {

/// Reads the columns x_m, y_m and z_m of a table whose first line names its columns; ignores
/// others. Throws Error with file and line.
Polyline read_route_csv(const std::string& file, const std::string& text);
}  // namespace altiplan::host
