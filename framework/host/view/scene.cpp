// SPDX-License-Identifier: Apache-2.0
#include "host/view/scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "host/config/overrides.hpp"
#include "host/flight/events.hpp"
#include "host/view/reach.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

/// Samples of all profiles of a scene together, to bound the time for many results.
constexpr std::size_t kProfileSamples = 12'000;

namespace fs = std::filesystem;

/// Prefix of layers' notes that attribute their data.
constexpr std::string_view kAttribution = "attribution: ";

Json goal_json(const Goal& goal) {
  return {{"at", rounded(goal.position)}, {"tolerance", rounded(goal.tolerance_m)}};
}

/// The loiter circles at the ends of routes.
Json loiters_json(const Mission& mission) {
  Json all = Json::array();
  const auto add = [&](const auto& end) {
    if (end.loiter) {
      all.push_back({{"at", rounded(end.position)}, {"radius", rounded(end.loiter->radius)}});
    }
  };
  add(mission.request.start);
  std::for_each(mission.via.begin(), mission.via.end(), add);
  add(mission.request.goal);
  return all;
}

Json corners_json(const Frame& frame, const Box& box) {
  if (!frame.has_position()) {
    return nullptr;
  }
  Json corners = Json::array();
  for (const auto& [x, y] : {std::pair(box.min.x(), box.min.y()),
                             {box.max.x(), box.min.y()},
                             {box.max.x(), box.max.y()},
                             {box.min.x(), box.max.y()}}) {
    const auto at = frame.to_lonlat(x, y);
    corners.push_back({at[0], at[1]});
  }
  return corners;
}

Json attribution_json(const World& truth, const std::vector<FlightEvent>& events) {
  std::set<std::string> lines;
  const auto read = [&](const Layer& layer) {
    for (const std::string& note : layer.environment->info().notes) {
      if (note.starts_with(kAttribution)) {
        lines.insert(note.substr(kAttribution.size()));
      }
    }
  };
  for (const Layer& layer : truth.layers()) {
    read(layer);
  }
  for (const FlightEvent& event : events) {
    if (event.layer) {
      read(*event.layer);
    }
  }
  return lines;
}

std::string title_of(const Config& config) {
  return config.scenario.name.empty() ? config.scenario_path.stem().string() : config.scenario.name;
}

/// The part of a run's overrides that changes its world.
std::string scenario_overrides(const StoredResult& stored) {
  std::string text;
  for (const std::string& assignment : set_texts(stored.json.at("overrides"))) {
    if (parse_set(assignment).file == FileOfKey::scenario) {
      text += " --set " + assignment;
    }
  }
  return text;
}

std::string world_text(const StoredResult& stored) {
  return stored.json.at("scenario").get<std::string>() + scenario_overrides(stored);
}

[[noreturn]] void refuse(const StoredResult& a, const std::string& of_a, const StoredResult& b,
                         const std::string& of_b) {
  throw Error("'" + a.file + "' and '" + b.file + "' are of different worlds: " + of_a + ", and " +
              of_b);
}

/// Distinct names of the results: the files' stems, or the whole files if stems coincide.
void name_apart(Json& results) {
  std::map<std::string, int> uses;
  for (const Json& result : results) {
    ++uses[result.at("name").get<std::string>()];
  }
  for (Json& result : results) {
    if (uses[result.at("name").get<std::string>()] > 1) {
      result["name"] = result.at("file");
    }
  }
}

/// Identifies the mission of a result, apart from the plugin folders: those of the call.
std::string mission_text(const StoredResult& stored) {
  std::string text = stored.pipeline.string() + '\n' + exact_json_text(stored.json.at("scenario")) +
                     '\n' + std::to_string(stored.overrides.seed.value_or(0));
  for (const std::string& set : stored.overrides.set) {
    text += '\n' + set;
  }
  return text;
}

class SceneBuilder {
 public:
  SceneBuilder(const std::vector<StoredResult>& results, const SceneProgress& progress, bool reach)
      : results_(results), progress_(progress), reach_(reach) {}

  Scene operator()() {
    // Groups results by mission, so that each is built once.
    std::map<std::string, std::size_t> groups;
    std::vector<std::vector<std::size_t>> indices;
    for (std::size_t n = 0; n < results_.size(); ++n) {
      by_json(results_[n], [&] {
        note_changed(results_[n]);
        const auto [found, is_new] = groups.emplace(mission_text(results_[n]), indices.size());
        if (is_new) {
          indices.emplace_back();
        }
        indices[found->second].push_back(n);
      });
    }
    std::vector<Json> results(results_.size());
    for (const std::vector<std::size_t>& group : indices) {
      add(group, results);
    }
    Json all = std::move(results);
    name_apart(all);
    scene_.update(reached_);
    scene_["notes"] = notes_.lines();
    scene_["results"] = std::move(all);
    return {std::move(scene_), notes_.warnings(), std::move(frame_)};
  }

 private:
  template <class Work>
  static void by_json(const StoredResult& stored, const Work& work) {
    try {
      work();
    } catch (const Json::exception& error) {
      const std::string why = error.what();  // "[json.exception.type_error.302] type must be …"
      throw Error(stored.file +
                  ": expected a result of altiplan run: " + why.substr(why.find("] ") + 2));
    }
  }

  void note_changed(const StoredResult& stored) {
    for (const std::string& changed : stored.changed) {
      notes_.warn(changed + " has changed since " + stored.file + " was written");
    }
    const StoredResult& first = results_.front();
    if (world_text(stored) != world_text(first)) {
      refuse(first, world_text(first), stored, world_text(stored));
    }
  }

  void add(const std::vector<std::size_t>& group, std::vector<Json>& results) {
    const StoredResult& of = results_[group.front()];
    say("building the world of " + of.file);
    const Config config = load_config(of.pipeline, of.overrides, registry_);
    registry_ = config.registry;
    Mission mission = build_mission(config, 1);
    if (of.route) {
      take_open_ends(mission, *of.route, mission.request);
    }
    say("drawing the world of " + of.file);
    if (scene_.is_null()) {
      box_ = scene_box(mission, results_);
      seed_ = config.seed;
      frame_ = mission.truth.frame();
      scene_ = world_scene(title_of(config), mission, build_events(config, mission), box_, notes_);
      if (reach_) {
        say("searching ways home");
        add_reach(reached_, mission, of.route.value_or(Route{}));
      }
    } else if (config.seed != seed_) {
      // Only the built worlds show whether a layer depends on the run's seed.
      SceneNotes unused;
      if (world_scene(title_of(config), mission, build_events(config, mission), box_, unused) !=
          scene_) {
        refuse(results_.front(), "with the seed " + std::to_string(seed_), of,
               "with the seed " + std::to_string(config.seed) +
                   ", which the scenario's layers or moving obstacles follow");
      }
    }
    const std::vector<FlightEvent> events = build_events(config, mission);
    const auto samples = std::clamp<std::size_t>(kProfileSamples / results_.size(), 60, 300);
    for (const std::size_t n : group) {
      by_json(results_[n], [&] {
        say("judging " + results_[n].file + number_of(n));
        if (results_[n].route) {
          take_open_ends(mission, *results_[n].route, mission.request);
        }
        results[n] = result_scene(results_[n], mission, events, {samples}, notes_);
        results[n]["trace"] = trace_scene(results_[n], notes_, [&](double share) {
          say("reading the trace of " + results_[n].file + ": " + std::to_string(int(100 * share)) +
              " %");
        });
      });
    }
  }
  std::string number_of(std::size_t n) const {
    return results_.size() > 1
               ? " (" + std::to_string(n + 1) + " of " + std::to_string(results_.size()) + ")"
               : "";
  }
  void say(const std::string& what) const {
    if (progress_) {
      progress_(what);
    }
  }

  const std::vector<StoredResult>& results_;
  const SceneProgress& progress_;
  const bool reach_;
  std::shared_ptr<Registry> registry_;
  Json scene_;
  Json reached_ = Json::object();
  Box box_;
  Frame frame_;
  std::int64_t seed_ = 0;
  SceneNotes notes_;
};
}  // namespace

Json world_scene(const std::string& title, const Mission& mission,
                 const std::vector<FlightEvent>& events, const Box& box, SceneNotes& notes) {
  Json scene;
  scene["altiplan_scene"] = kSceneVersion;
  scene["title"] = title;
  scene["attribution"] = attribution_json(mission.truth, events);
  scene["box"] = Json::array();
  scene["corners_lonlat"] = corners_json(mission.truth.frame(), box);
  scene.update(ends_scene(mission));
  scene["ground"] = ground_json(mission.truth, box, notes);
  scene.update(obstacles_scene(mission, events, box, notes));
  if (const auto& body = mission.request.vehicle.body) {
    scene["body"] = body_json(*body);
  }
  scene["box"] = {rounded(box.min), rounded(box.max)};
  return scene;
}

Json ends_scene(const Mission& mission) {
  Json scene{{"start", rounded(mission.request.start.position)},
             {"goal", goal_json(mission.request.goal)},
             {"via", Json::array()},
             {"loiters", loiters_json(mission)}};
  for (const Goal& via : mission.via) {
    scene["via"].push_back(goal_json(via));
  }
  return scene;
}

Json obstacles_scene(const Mission& mission, const std::vector<FlightEvent>& events, const Box& box,
                     SceneNotes& notes) {
  Json scene;
  for (const char* key : {"solids", "boxes", "meshes", "moving", "events"}) {
    scene[key] = Json::array();
  }
  add_solids(scene, mission, events, box, notes);
  return scene;
}

void SceneNotes::add(const std::string& line) {
  if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) {
    lines_.push_back(line);
  }
}

void SceneNotes::warn(const std::string& line) {
  if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) {
    warnings_.push_back(line);
  }
  add(line);
}

Json rounded(double value) {
  constexpr double kPerMetre = 1000;
  // + 0.0: turns negative zero into zero.
  return std::isfinite(value) ? Json(std::round(value * kPerMetre) / kPerMetre + 0.0)
                              : Json(nullptr);
}

Json rounded(const std::optional<double>& value) { return value ? rounded(*value) : Json(nullptr); }

Json rounded(const Vec3& p) { return {rounded(p.x()), rounded(p.y()), rounded(p.z())}; }

Box scene_box(const Mission& mission, const std::vector<StoredResult>& results) {
  constexpr double kMinShare = 0.01;  // of the longest edge; a level flight has no height
  constexpr double kMinEdge = 1;
  Box box = mission.request.volume;
  box = box.with(mission.request.start.position).with(mission.request.goal.position);
  for (const Goal& via : mission.via) {
    box = box.with(via.position);
  }
  for (const StoredResult& stored : results) {
    for (const Vec3& p : stored.route.value_or(Route{})) {
      box = box.with(p);
    }
    for (const auto& [t, p] : stored.track.value_or(Track{})) {
      box = box.with(p);
    }
  }
  const double min_side = std::max(kMinEdge, kMinShare * (box.max - box.min).maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    const double missing = std::max(0.0, min_side - (box.max[axis] - box.min[axis]));
    box.min[axis] -= missing / 2;
    box.max[axis] += missing / 2;
  }
  return box;
}

Scene build_scene(const std::vector<StoredResult>& results, const SceneProgress& progress,
                  bool reach) {
  return SceneBuilder(results, progress, reach)();
}
}  // namespace altiplan::host
