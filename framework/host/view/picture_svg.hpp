// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// The scene seen from above, with its routes' height profiles below: one self-contained SVG.
std::string picture_svg(const Json& scene);
}  // namespace altiplan::host
