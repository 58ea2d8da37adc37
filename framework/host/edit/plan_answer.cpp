// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "host/describe/describe.hpp"
#include "host/edit/movable.hpp"
#include "host/edit/page_request.hpp"
#include "host/edit/plan_task.hpp"
#include "host/flight/events.hpp"
#include "host/gate/route_returns.hpp"
#include "host/result/stored_result.hpp"
#include "host/run/pipeline.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

/// Samples of a profile: finer than a chart has pixels, and fewer where every millisecond counts.
constexpr std::size_t kSamples = 300;
constexpr std::size_t kQuickSamples = 60;

constexpr const char* kKinds[] = {"plan", "page", "plugins"};

std::string text_of(const Json& json) { return json_text(json); }

/// True of a planner that has a route at any time, which more time only improves.
bool is_anytime(const Config& config, const std::string& name) {
  for (const Description& one : describe_plugin(*config.registry, name)) {
    if (one.kind == "planner" && one.traits) {
      return one.traits->anytime;
    }
  }
  return false;
}

/// Limits plan steps that may take longer to a time in which one can wait for them, and leaves out
/// the judging of returns, and the flight unless it `flies`.
void make_quick(Config& config, bool flies) {
  if (!flies && config.steps.back().verb == Verb::fly) {
    config.steps.pop_back();
  }
  std::erase_if(config.steps, [](const StepEntry& step) { return step.verb == Verb::returns; });
  for (StepEntry& step : config.steps) {
    if (step.verb == Verb::plan) {
      const double max_seconds = is_anytime(config, step.plugin) ? kQuickSeconds : kLongestSeconds;
      step.within_s = std::min(step.within_s.value_or(kDefaultStepSeconds), max_seconds);
    }
  }
}

/// A pipeline run with these changes.
struct Planned {
  Config config;
  Mission mission;
  RunResult run;
  StoredResult result;
};

Planned planned(const EditedPipeline& pipeline, const std::vector<std::string>& set, bool quick,
                bool flies, const std::function<void(const std::string&)>& on_stuck) {
  Overrides overrides = pipeline.config.overrides;
  overrides.set = set;
  Config config = load_config(pipeline.config.pipeline_path, overrides, pipeline.config.registry);
  if (quick) {
    make_quick(config, flies);
  }
  RunOptions options;
  options.judge_returns = judge_route_returns;
  options.on_stuck = [&](const RunResult& result) { on_stuck(error_answer(result.message)); };
  Mission mission;
  options.on_mission = [&](const Mission& built) { mission = built; };
  RunResult result = run(config, options);
  StoredResult stored =
      stored_result(pipeline.name, result_json(config, result), pipeline.config.overrides);
  return {std::move(config), std::move(mission), std::move(result), std::move(stored)};
}

Json plan(const PlanTask& task, const EditedPipeline& pipeline,
          const std::function<void(const std::string&)>& on_stuck) {
  const Planned made =
      planned(pipeline, task.set.at(task.pipeline), task.quick, task.flies, on_stuck);
  const Mission& mission = made.mission;
  const std::vector<FlightEvent> events = build_events(made.config, mission);
  SceneNotes notes;
  Json scene{{"altiplan_scene", kSceneVersion}};
  scene.update(ends_scene(mission));
  if (task.obstacles) {
    scene.update(obstacles_scene(mission, events, scene_box(mission, {made.result}), notes));
  }
  // Judged anew where there is time, as whoever opens the result has it.
  const SceneDetail detail{task.quick ? kQuickSamples : kSamples, !task.quick,
                           task.quick ? &made.run : nullptr};
  Json result = result_scene(made.result, mission, events, detail, notes);
  result["trace"] = nullptr;
  scene["results"] = Json::array({std::move(result)});
  scene["notes"] = notes.lines();
  scene["movable"] = movable(made.config.scenario_tree, mission.truth);
  if (!task.quick) {
    scene["result"] = made.result.json;
  }
  return scene;
}

Json page(const PlanTask& task, const std::vector<EditedPipeline>& pipelines,
          const std::function<void(const std::string&)>& on_stuck) {
  std::vector<StoredResult> results;
  Json items;
  Json kept = Json::array();
  for (std::size_t n = 0; n < task.files.size(); ++n) {
    Planned made = planned(pipelines.at(task.files[n]), task.set.at(n), false, true, on_stuck);
    kept.push_back(made.result.json);
    results.push_back(std::move(made.result));
    items = movable(made.config.scenario_tree, made.mission.truth);
  }
  Json scene = build_scene(results).json;
  scene["result"] = std::move(kept);

  scene["movable"] = std::move(items);
  return scene;
}

Json plugins(const std::vector<EditedPipeline>& pipelines) {
  Registry& registry = *pipelines.front().config.registry;
  Json all = Json::array();
  std::set<std::string> seen;
  for (const ListedPlugin& listed : listed_plugins(examine_all(registry))) {
    if (!seen.insert(listed.name).second) {
      continue;  // described with the first of its kinds
    }
    for (const Description& description : describe_plugin(registry, listed.name)) {
      all.push_back(describe_json(description));
    }
  }
  return all;
}
}  // namespace

Json to_json(const PlanTask& task) {
  return {{"kind", kKinds[int(task.kind)]},
          {"number", task.number},
          {"pipeline", task.pipeline},
          {"files", task.files},
          {"set", task.set},
          {"quick", task.quick},
          {"obstacles", task.obstacles},
          {"flies", task.flies}};
}

PlanTask plan_task(const Json& json) {
  PlanTask task;
  const std::string kind = json.at("kind");
  while (kind != kKinds[int(task.kind)]) {
    task.kind = PlanTask::Kind(int(task.kind) + 1);
  }
  task.number = json.at("number");
  task.pipeline = json.at("pipeline");
  task.files = json.at("files").get<std::vector<std::size_t>>();
  task.set = json.at("set").get<std::vector<std::vector<std::string>>>();
  task.quick = json.at("quick");
  task.obstacles = json.at("obstacles");
  task.flies = json.at("flies");
  return task;
}

std::string plan_answer(const PlanTask& task, const std::vector<EditedPipeline>& pipelines,
                        const std::function<void(const std::string&)>& on_stuck) {
  switch (task.kind) {
    case PlanTask::Kind::plan:
      return text_of(plan(task, pipelines.at(task.files.at(task.pipeline)), on_stuck));
    case PlanTask::Kind::page:
      return text_of(page(task, pipelines, on_stuck));
    default:
      return text_of(plugins(pipelines));
  }
}
}  // namespace altiplan::host
