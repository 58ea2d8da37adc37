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

/// The result.json of a run, "" where there is none.
using ResultSource = std::function<std::string(const RunRow&)>;

struct SceneOptions {
  std::vector<std::filesystem::path> plugin_path;
  bool times = true;
  std::size_t most = 48;               ///< scenes
  std::size_t max_bytes = 2'200'000;  ///< of all of them, packed
  std::size_t max_bytes_each = 400'000;
};

/// The runs of one pair in their world, packed.
struct PackedScene {
  std::vector<std::size_t> rows;  ///< of its results, in their order
  std::string data;
};

struct Scenes {
  std::vector<PackedScene> scenes;
  std::string what;                ///< a sentence: which runs have a scene
  std::vector<std::string> notes;  ///< on scenes that could not be made
  /// Sentences on files and plugins that are not those of the runs, which so are in no scene.
  std::vector<std::string> changed;
  /// Why a row is in no scene though its pair was to have one.
  std::map<std::size_t, std::string> why_not;
};

/// Scenes of runs that failed, of outliers, and of a sample that follows the study's seed, each
/// with the other pipelines' runs of the same pair. Each is made in a process of its own: what a
/// plugin does there costs its scene, which a note tells. What the machine does not give is asked
/// for once more; then it is thrown as a MachineFault.
Scenes build_scenes(const StudyData& data, const Analysis& analysis, const ResultSource& results,
                    const SceneOptions& options);

/// The pairs that are to have a scene, each by its rows, the one that it is for first.
std::vector<std::vector<std::size_t>> choose_scenes(const StudyData& data, const Analysis& analysis,
                                                    std::size_t most);

/// What of a result's world is not as it was when the run was made: "hills.yaml has changed since",
/// and builds of the plugins that make the world. Throws as load_config.
std::vector<std::string> what_changed(const host::StoredResult& stored);

/// What a page of many scenes can carry: ground and profiles of fewer samples.
void thin_scene(host::Json& scene);
/// Without keys that end in time_s, at any depth.
void drop_times(host::Json& json);

class SceneLate : public Error {
 public:
  using Error::Error;
};

/// What `make` returns, made in a child process within a time, or throws SceneLate; throws Error
/// with what it throws, or with how the child ended, and MachineFault where the machine gave no
/// file, memory or process.
std::string made_in_child(const std::function<std::string()>& make, unsigned seconds);
}  // namespace altiplan::study::report
