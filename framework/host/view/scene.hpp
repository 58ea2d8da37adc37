// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "host/base/run_status.hpp"
#include "host/mission/mission.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::host {

/// The scene that `altiplan view` shows, in the format of tools/viewer/README.md.
struct Scene {
  Json json;
  std::vector<std::string> warnings;  ///< for the user, before viewing
  Frame frame;                        ///< of its world
};

/// Called with what is being done, before it and while it goes on.
using SceneProgress = std::function<void(const std::string& what)>;

/// The world of the results, rebuilt from their files, with their routes and flights. Throws Error
/// if they are not of the same world, and as load_config and build_mission do.
/// `reach`: also that of reach.hpp, of the first result.
Scene build_scene(const std::vector<StoredResult>& results, const SceneProgress& progress = {},
                  bool reach = false);

/// A line with a verdict that is not the judge's of routes.
struct JudgedLine {
  std::string file;
  std::string verdict;  ///< one line, the scene's title
  RunStatus status = RunStatus::solved;
  Route line;
  CheckResult check;  ///< its violations are at points of the line
  Measures measures;
  std::vector<std::string> notes;
};

/// The world around the line, and the line.
Scene line_scene(const JudgedLine& judged, const Mission& world);
/// The line alone, to be shown in a page that has its world: `start`, `goal`, `results`, `notes`.
Json line_parts(const JudgedLine& judged, const Mission& world);
}  // namespace altiplan::host
