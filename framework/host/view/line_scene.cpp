// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "host/result/result_json.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {

Scene line_scene(const JudgedLine& judged, const Mission& world) {
  Mission mission = world;
  Request& request = mission.request;
  request.world = std::make_shared<const World>(mission.truth);
  request.start.position = judged.line.front();
  request.goal = {judged.line.back()};
  const Box box = box_about(judged.line);
  request.volume = box;
  SceneNotes notes;
  Scene scene{world_scene(judged.verdict, mission, {}, box, notes), {}};
  drop_what_is_beside(scene.json, box);
  Json profile = route_profile(judged.line, request, {});
  for (Json& speed : profile.at("speed")) {
    speed = nullptr;  // nobody flies at a planner's speed here
  }
  scene.json["results"] =
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
  scene.json["notes"] = notes.lines();
  scene.warnings = notes.warnings();
  return scene;
}
}  // namespace altiplan::host
