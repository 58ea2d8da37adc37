// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// A pipeline that is edited, with the settings that it was opened with.
struct EditedPipeline {
  std::string name;      ///< of its results
  Config config;         ///< as opened
  std::size_t file = 0;  ///< which of the opened pipelines it is, or was copied from
};

/// What the planning process is asked for.
struct PlanTask {
  enum class Kind { plan, page, plugins };
  Kind kind = Kind::plan;
  std::uint64_t number = 0;                     ///< of the task, rising
  std::size_t pipeline = 0;                     ///< of `plan`
  std::vector<std::size_t> files{};             ///< of each pipeline, EditedPipeline::file
  std::vector<std::vector<std::string>> set{};  ///< `--set` of each pipeline
  bool quick = false;                           ///< of `plan`: something is being dragged
  bool obstacles = false;                       ///< of `plan`: the page has those of another world
  bool flies = true;                            ///< of `plan`: with the flight
};

/// Seconds that a plan step may take while something is dragged: an anytime planner, and another,
/// which has no route before it ends.
inline constexpr double kQuickSeconds = 0.1;
inline constexpr double kLongestSeconds = 2;

Json to_json(const PlanTask& task);
PlanTask plan_task(const Json& json);

/// The answer, a JSON text:
///  plan: {"results": [one], "start", "goal", "via", "loiters", "notes", "movable", "result"} as in
///  a scene, with all that a scene has of obstacles if they are asked for; "result" is result.json,
///  and left out if quick.
///  page: a whole scene with the results of all pipelines, "movable", and a list "result".
///  plugins: the kinds, names and parameters of all plugins.
/// Throws as load_config, build_mission and run do. `on_stuck` gets the answer if a plugin never
/// returns, and must not.
std::string plan_answer(const PlanTask& task, const std::vector<EditedPipeline>& pipelines,
                        const std::function<void(const std::string&)>& on_stuck);
}  // namespace altiplan::host
