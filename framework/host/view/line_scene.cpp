// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "host/result/result_json.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

/// The world with the line's ends and the box about it.
Mission mission_of(const JudgedLine& judged, const Mission& world) {
  Mission mission = world;
  Request& request = mission.request;
  request.world = std::make_shared<const World>(mission.truth);
  request.start.position = judged.line.front();
  request.goal = {judged.line.back()};
  request.volume = box_about(judged.line);
  return mission;
}

/// Adds `results` and `notes`.
void add_line(Json& scene, const JudgedLine& judged, const Request& request, SceneNotes& notes) {
  Json profile = route_profile(judged.line, request, {});
  for (Json& speed : profile.at("speed")) {
    speed = nullptr;  // nobody flies at a planner's speed here
  }
  scene["results"] =
      Json::array({{{"name", std::filesystem::path(judged.file).stem().string()},
                    {"file", judged.file},
                    {"status", name(judged.status)},
                    {"message", judged.verdict},
                    {"judged", nullptr},
                    {"seed", nullptr},
                    {"metrics", metrics_scene(to_json(judged.measures))},
                    {"check", check_scene(to_json(judged.check), judged.file, notes)},
                    {"steps", Json::array()},
                    {"route", to_json(judged.line)},
                    {"waypoints", nullptr},
                    {"limits", limits_json(request)},
                    {"profile", profile},
                    {"flight", nullptr},
                    {"trace", nullptr}}});
  for (const std::string& note : judged.notes) {
    notes.add(note);
  }
  scene["notes"] = notes.lines();
}
}  // namespace

Scene line_scene(const JudgedLine& judged, const Mission& world) {
  const Mission mission = mission_of(judged, world);
  const Box& box = mission.request.volume;
  SceneNotes notes;
  Scene scene{world_scene(judged.verdict, mission, {}, box, notes), {}, mission.truth.frame()};
  drop_what_is_beside(scene.json, box);
  add_line(scene.json, judged, mission.request, notes);
  scene.warnings = notes.warnings();
  return scene;
}

Json line_parts(const JudgedLine& judged, const Mission& world) {
  const Mission mission = mission_of(judged, world);
  SceneNotes notes;
  Json scene{{"altiplan_scene", kSceneVersion}};
  scene.update(ends_scene(mission));
  add_line(scene, judged, mission.request, notes);
  return scene;
}
}  // namespace altiplan::host
