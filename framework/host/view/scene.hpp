// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/result/stored_result.hpp"

namespace altiplan::host {

/// What `altiplan view` shows, of the form that tools/viewer/README.md gives.
struct Scene {
  Json json;
  std::vector<std::string> warnings;  ///< what the user should know before looking
};

/// The world of the results, built again from their files, and what was planned and flown in it.
/// Throws Error where they are not of one world, and as load_config and build_mission do.
Scene build_scene(const std::vector<StoredResult>& results);
}  // namespace altiplan::host
