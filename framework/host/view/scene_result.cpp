// SPDX-License-Identifier: Apache-2.0
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMostViolations = 1000;

/// The limit that routes are held to, null where there is none.
Json limits_json(const Request& request) {
  const Limits& limits = request.limits;
  const double clearance = std::max(limits.min_clearance, request.vehicle.radius_m);
  const auto below = [](double limit, double any) {
    return limit < any ? rounded(degrees(limit)) : Json(nullptr);
  };
  return {{"clearance_m", clearance > 0 ? rounded(clearance) : Json(nullptr)},
          {"ground_clearance_m", rounded(limits.min_ground_clearance)},
          {"turn_deg", below(limits.max_turn_horizontal, kPi)},
          {"climb_deg", below(limits.max_climb, kPi / 2)}};
}

Json step_scene(const Json& step, const std::string& file, SceneNotes& notes) {
  Json json;
  copy_texts(json, step, {"id", "verb", "plugin", "status", "message"});
  json["instead_of"] = step.at("instead_of");
  json["stands"] = step.at("stands").get<bool>();
  const Json& route = step.at("route");
  json["route"] = route.is_null() || route.empty() ? Json(nullptr) : to_json(route_of(route, file));
  json["metrics"] = metrics_scene(step.at("metrics"));
  json["check"] =
      check_scene(step.at("check"), file + ": " + step.at("id").get<std::string>(), notes);
  return json;
}
}  // namespace

void copy_texts(Json& to, const Json& from, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    to[key] = from.at(key).get<std::string>();
  }
}

Json metrics_scene(const Json& metrics) {
  if (!metrics.is_null()) {
    for (const auto& [key, value] : metrics.get_ref<const Json::object_t&>()) {
      if (!value.is_null()) {
        value.get<double>();
      }
    }
  }
  return metrics;
}

Json check_scene(Json check, const std::string& whose, SceneNotes& notes) {
  if (check.is_null()) {
    return check;
  }
  auto& violations = check.at("violations").get_ref<Json::array_t&>();
  if (violations.size() > kMostViolations) {
    notes.add(whose + ": the first " + std::to_string(kMostViolations) + " of " +
              std::to_string(violations.size()) + " violations are listed");
    violations.resize(kMostViolations);
  }
  for (const Json& violation : violations) {
    violation.at("at").get<std::size_t>();
    violation.at("constraint").get<std::string>();
    violation.at("message").get<std::string>();
  }
  return check;
}

Json result_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, std::size_t samples, SceneNotes& notes) {
  const Json& result = stored.json;
  Json json{{"name", std::filesystem::path(stored.file).stem().string()}, {"file", stored.file}};
  copy_texts(json, result, {"status", "message"});
  json["seed"] = result.at("seed");
  json["metrics"] = metrics_scene(result.at("metrics"));
  json["check"] = check_scene(result.at("check"), stored.file, notes);
  json["steps"] = Json::array();
  for (const Json& step : result.at("steps")) {
    json["steps"].push_back(step_scene(step, stored.file, notes));
  }
  json["route"] = stored.route ? to_json(*stored.route) : Json(nullptr);
  json["limits"] = limits_json(mission.request);
  json["profile"] =
      stored.route ? route_profile(*stored.route, mission.request, samples) : Json(nullptr);
  json["flight"] = flight_scene(stored, mission, events, samples, notes);
  json["trace"] = trace_scene(stored, notes);
  return json;
}
}  // namespace altiplan::host
