// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/output/result_json.hpp"

namespace altiplan::host {

/// tools/viewer/dist/viewer.html with the scene in it: one file that needs nothing else.
std::string viewer_page(const Json& scene);
}  // namespace altiplan::host
