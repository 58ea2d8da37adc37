// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/result/stored_result.hpp"

namespace altiplan::host {

/// The scene that `altiplan view` shows, in the format of tools/viewer/README.md.
struct Scene {
  Json json;
  std::vector<std::string> warnings;  ///< for the user, before viewing
};

/// Called with what is being done, before it and while it goes on.
using SceneProgress = std::function<void(const std::string& what)>;

/// The world of the results, rebuilt from their files, with their routes and flights. Throws Error
/// if they are not of the same world, and as load_config and build_mission do.
Scene build_scene(const std::vector<StoredResult>& results, const SceneProgress& progress = {});
}  // namespace altiplan::host
