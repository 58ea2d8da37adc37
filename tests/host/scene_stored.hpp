// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_files.hpp"

namespace altiplan::host::testing {

inline constexpr const char* kTold = "steps: [{plan: told}]\n";

/// Scenes of stored results that a test may change.
class SceneResult : public SceneFiles {
 protected:
  /// The stored result, changed.
  void edit(const std::string& name, const std::function<void(Json&)>& change) const {
    Json json = read_json((folder_ / name).string(), "");
    change(json);
    write(name, file_text(json));
  }
  Json shown(const std::string& name = "result.json") const {
    return scene_of({(folder_ / name).string()}).json.at("results").at(0);
  }
};

}  // namespace altiplan::host::testing
