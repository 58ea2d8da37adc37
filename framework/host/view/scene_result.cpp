// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "host/base/run_status.hpp"
#include "host/judge/judge.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxViolations = 1000;

/// A route, and the judge's present verdict on it.
struct Judged {
  Route route;
  CheckResult check;
  Measures measures;
};

Judged judged(const Route& route, const Mission& mission) {
  return {route, judge(route, mission.request, mission.via, mission.runways),
          measure(route, mission.request)};
}

/// Of each waypoint, its index in the points that show the route's turns.
std::vector<std::size_t> points_of_waypoints(const Route& route) {
  std::vector<std::size_t> point_of{0};
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    point_of.push_back(point_of.back() + route.leg(i).chords(kChordTolerance).size() - 1);
  }
  return point_of;
}

/// The same, null where every point is a waypoint.
Json waypoints_json(const Route& route) {
  return route.is_straight() ? Json(nullptr) : Json(points_of_waypoints(route));
}

/// The verdict with indices into those points.
Json check_of_points(const Judged& judged) {
  const std::vector<std::size_t> point_of = points_of_waypoints(judged.route);
  Json check = to_json(judged.check);
  for (Json& violation : check.at("violations")) {
    violation["at"] =
        point_of[std::min(violation.at("at").get<std::size_t>(), point_of.size() - 1)];
  }
  return check;
}

/// The metrics of a run without a route.
Json no_metrics() {
  Json metrics = to_json(Measures{});
  for (auto& [key, value] : metrics.items()) {
    value = nullptr;
  }
  return metrics;
}

/// The verdict of the run on a step's route; nothing where it ended before one.
std::optional<Judged> judged(const Route& route, const StepResult& step) {
  return step.check && step.measures ? std::optional(Judged{route, *step.check, *step.measures})
                                     : std::nullopt;
}

/// `of_run`: null if the step is to be judged.
Json step_scene(const Json& step, const StoredResult& stored, const std::optional<Judged>& accepted,
                const StepResult* of_run, const Mission& mission, SceneNotes& notes) {
  const std::string whose = stored.file + ": " + step.at("id").get<std::string>();
  Json json;
  copy_texts(json, step, {"id", "verb", "plugin", "status", "message"});
  json["instead_of"] = step.at("instead_of");
  json["accepted"] = step.at("accepted").get<bool>();
  json["route"] = json["waypoints"] = nullptr;
  json["metrics"] = metrics_scene(step.at("metrics"));
  json["check"] = check_scene(step.at("check"), whose, notes);
  const Json& route = step.at("route");
  if (route.is_null() || route.empty()) {
    return json;
  }
  Route places = route_of(step, stored.file);
  const bool is_accepted = accepted && accepted->route == places;
  const std::optional<Judged> known = is_accepted         ? accepted
                                      : of_run != nullptr ? judged(places, *of_run)
                                                          : std::nullopt;
  const Judged now = known ? *known : judged(places, mission);
  json["route"] = to_json(places);
  json["waypoints"] = waypoints_json(places);
  json["metrics"] = metrics_now(step.at("metrics"), to_json(now.measures));
  if (!json.at("check").is_null()) {  // else the run ended before a verdict
    json["check"] = check_scene(check_of_points(now), whose, notes);
    set_status(json, stored.file, status_of(now.check), first_found(now.check));
  }
  return json;
}

/// The first step that judged returns and found them not to pass; null: there is none.
const Json* unsafe_step(const StoredResult& stored) {
  for (const Json& step : stored.json.at("steps")) {
    if (step.at("verb") == name(Verb::returns) && !step.at("accepted").get<bool>()) {
      return &step;
    }
  }
  return nullptr;
}

/// The status of the run: that of its route or, if the route is valid, of its flight and of its
/// returns, which are not judged again.
void conclude(Json& json, const StoredResult& stored, const std::optional<Judged>& accepted,
              SceneNotes& notes) {
  const Json& flight = json.at("flight");
  const Json* unsafe = accepted && accepted->check.ok() ? unsafe_step(stored) : nullptr;
  if (!accepted) {
    json["judged"] = nullptr;
    if (json.at("status") == name(RunStatus::solved)) {
      set_status(json, stored.file, name(RunStatus::no_route), "it contains no route");
    }
  } else if (unsafe != nullptr &&
             (flight.is_null() || flight.at("status") == name(RunStatus::solved))) {
    set_status(json, stored.file, unsafe->at("status").get<std::string>(),
               unsafe->at("message").get<std::string>());
  } else if (!accepted->check.ok() || flight.is_null()) {
    set_status(json, stored.file, status_of(accepted->check), first_found(accepted->check));
  } else {
    const bool differs = !flight.at("judged").is_null();
    set_status(json, stored.file, flight.at("status").get<std::string>(),
               differs ? "the flight: " + flight.at("message").get<std::string>() : "");
  }
  if (!json.at("judged").is_null()) {
    notes.warn(stored.file + ": " + json.at("message").get<std::string>());
  }
}
}  // namespace

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
  if (violations.size() > kMaxViolations) {
    notes.add(whose + ": the first " + std::to_string(kMaxViolations) + " of " +
              std::to_string(violations.size()) + " violations are listed");
    violations.resize(kMaxViolations);
  }
  for (const Json& violation : violations) {
    violation.at("at").get<std::size_t>();
    violation.at("constraint").get<std::string>();
    violation.at("message").get<std::string>();
  }
  return check;
}

Json result_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, const SceneDetail& detail,
                  SceneNotes& notes) {
  const RunResult* run = detail.judged;
  const Json& result = stored.json;
  std::optional<Judged> accepted;
  if (stored.route) {
    accepted = run != nullptr ? judged(*stored.route, run->steps.at(run->accepted.value()))
                              : judged(*stored.route, mission);
  }
  Json json{{"name", std::filesystem::path(stored.file).stem().string()}, {"file", stored.file}};
  copy_texts(json, result, {"status", "message"});
  json["judged"] = nullptr;
  json["seed"] = result.at("seed");
  json["metrics"] =
      metrics_now(result.at("metrics"), accepted ? to_json(accepted->measures) : no_metrics());
  result.at("check");  // throws if it is not a result
  json["check"] =
      check_scene(accepted ? check_of_points(*accepted) : Json(nullptr), stored.file, notes);
  json["steps"] = Json::array();
  for (const Json& step : result.at("steps")) {
    const StepResult* of_run = run != nullptr ? &run->steps.at(json["steps"].size()) : nullptr;
    json["steps"].push_back(step_scene(step, stored, accepted, of_run, mission, notes));
  }
  json["route"] = accepted ? to_json(accepted->route) : Json(nullptr);
  json["waypoints"] = accepted ? waypoints_json(accepted->route) : Json(nullptr);
  json["limits"] = limits_json(mission.request);
  json["profile"] =
      accepted ? route_profile(accepted->route, mission.request, detail) : Json(nullptr);
  if (accepted && mission.request.vehicle.body != nullptr) {
    json["body"] = body_places_json(accepted->route, mission.request, stored.file, notes);
  }
  json["flight"] = flight_scene(stored, mission, events, detail, notes);
  conclude(json, stored, accepted, notes);
  return json;
}
}  // namespace altiplan::host
