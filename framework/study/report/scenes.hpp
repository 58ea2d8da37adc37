// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/result/result_json.hpp"
#include "host/result/stored_result.hpp"
#include "study/report/analysis.hpp"

namespace altiplan::study::report {

/// The result.json of a run, "" if there is none.
using ResultSource = std::function<std::string(const RunRow&)>;

struct SceneOptions {
  std::vector<std::filesystem::path> plugin_path;
  bool times = true;
  std::size_t most = 48;              ///< scenes
  std::size_t max_bytes = 2'200'000;  ///< of all of them, packed
  std::size_t max_bytes_each = 400'000;
  std::function<void(const std::string&)> begins = [](const std::string&) {};  ///< of Options
};

/// The runs of one pair in their world, packed.
struct PackedScene {
  std::vector<std::size_t> rows;  ///< of its results, in their order
  std::string data;
};

struct Scenes {
  std::vector<PackedScene> scenes;
  std::string what;                ///< a sentence on the runs with a scene
  std::vector<std::string> notes;  ///< on scenes that could not be built
  /// Sentences on files and plugins that have changed since the runs, which are therefore in no
  /// scene.
  std::vector<std::string> changed;
  /// Why a row is in no scene although its pair was selected for one.
  std::map<std::size_t, std::string> why_not;
};

/// Scenes of failed runs, of outliers, and of a random sample by the study's seed, each with the
/// other pipelines' runs of the same pair. Each is built in its own process: a misbehaving plugin
/// only loses its scene, with a note. Faults of the machine are retried once, then thrown as
/// MachineFault.
Scenes build_scenes(const StudyData& data, const Analysis& analysis, const ResultSource& results,
                    const SceneOptions& options);

/// The pairs selected for a scene, each with its rows, the row that it was selected for first.
std::vector<std::vector<std::size_t>> choose_scenes(const StudyData& data, const Analysis& analysis,
                                                    std::size_t most);

/// The changes of a result's world since the run was made: "hills.yaml has changed since", and
/// builds of the plugins that make the world. Throws like load_config.
std::vector<std::string> what_changed(const host::StoredResult& stored);

/// Thins ground and profiles to fewer samples, for a page of many scenes.
void thin_scene(host::Json& scene);
/// Without keys that end in time_s, at any depth.
void drop_times(host::Json& json);

class SceneLate : public Error {
 public:
  using Error::Error;
};

/// The return value of `make`, computed in a child process within a time limit, or throws
/// SceneLate; throws Error with the message of its exception or the end of the child, and
/// MachineFault if the machine refuses a file, memory or process.
std::string made_in_child(const std::function<std::string()>& make, unsigned seconds);
}  // namespace altiplan::study::report
