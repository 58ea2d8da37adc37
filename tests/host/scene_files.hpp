// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "files.hpp"
#include "host/base/base64.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host::testing {

/// Runs of the test's files, stored and shown.
class SceneFiles : public Files {
 protected:
  /// Runs the pipeline and stores its result under that name.
  std::string result(const std::string& text, const std::string& name = "result.json",
                     const RunOptions& options = {}) const {
    const Config config = load_config(pipeline(text), overrides_);
    return write(name, file_text(result_json(config, host::run(config, options)))).string();
  }
  Scene scene_of(const std::vector<std::string>& files) const {
    Overrides only_plugins;
    only_plugins.plugin_path = overrides_.plugin_path;
    std::vector<StoredResult> stored;
    for (const std::string& file : files) {
      stored.push_back(read_result(file, only_plugins));
    }
    return build_scene(stored);
  }
  Json scene(const std::string& text) const { return scene_of({result(text)}).json; }
  /// What the user would read of the exception; "" without one.
  std::string scene_refusal(const std::vector<std::string>& files) const {
    try {
      scene_of(files);
    } catch (const Error& error) {
      return without_folder(error.what());
    }
    return "";
  }
  /// The mission of the files that were written last.
  Mission mission() const { return build_mission(load_config(folder_ / "p.yaml", overrides_), 1); }
};

template <class Value>
std::vector<Value> numbers(const Json& text) {
  const std::vector<std::byte> bytes = from_base64(text.get<std::string>());
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}
}  // namespace altiplan::host::testing
