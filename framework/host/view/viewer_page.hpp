// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// tools/viewer/dist/viewer.html with the scene embedded: one self-contained file.
std::string viewer_page(const Json& scene);
/// That file, with kScenePlace once in place of the scene.
std::string_view viewer_template();
inline constexpr std::string_view kScenePlace = "/*SCENE*/";
}  // namespace altiplan::host
