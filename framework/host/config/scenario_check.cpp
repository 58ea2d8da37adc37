// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>

#include "altiplan/formats/iso_time.hpp"
#include "host/base/shapes.hpp"
#include "host/config/config_check.hpp"

namespace altiplan::host {
namespace {

std::vector<std::string> list(const Ids& ids) { return {ids.begin(), ids.end()}; }

void check_layers(Checker& checker, ScenarioFile& scenario, const Value& tree, Ids& ids) {
  for (std::size_t i = 0; i < scenario.environment.size(); ++i) {
    LayerEntry& layer = scenario.environment[i];
    const Value& map = tree.find("environment")->items[i];
    const std::string path = item("environment", i);
    checker.check_plugin("environment", layer.plugin, layer.parameters, place_of(map, layer.plugin),
                         path + "." + layer.plugin, path);
    if (layer.id.empty()) {
      layer.id = ids.free_id(layer.plugin);
    } else if (ids.contains(layer.id)) {
      checker.problem(place_of(map, "id"), path + ".id",
                      "the id '" + layer.id + "' is already used by another layer");
    }
    ids.insert(layer.id);
  }
}

void check_moving(Checker& checker, ScenarioFile& scenario, const Value& tree, Ids& ids) {
  for (std::size_t i = 0; i < scenario.moving.size(); ++i) {
    MovingEntry& moving = scenario.moving[i];
    const Value& map = tree.find("moving")->items[i];
    const std::string path = item("moving", i);
    if (moving.id.empty()) {
      moving.id = moving.shape + "_" + std::to_string(i + 1);
    }
    if (!ids.insert(moving.id).second) {
      checker.problem(place_of(map, "id"), path + ".id",
                      "the id '" + moving.id + "' is already used by another moving obstacle");
    }
    if (moving.shape.empty()) {
      continue;
    }
    if (const DescribeMoving describe = describe_moving(moving.shape)) {
      const std::string key = path + "." + moving.shape;
      checker.check_report(describe(&moving.parameters, key), key);
    } else {
      std::vector<std::string> names = moving_shapes();
      names.emplace_back("random");
      checker.problem(place_of(map, moving.shape), path,
                      "unknown shape '" + moving.shape +
                          "': expected sphere, cylinder, box, prism or random" +
                          did_you_mean(moving.shape, names));
    }
  }
}

void check_added(Checker& checker, ScenarioFile& scenario, const Value& tree, Ids& ids) {
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    EventEntry& event = scenario.events[i];
    if (!event.add) {
      continue;
    }
    const Value& map = tree.find("events")->items[i];
    const std::string key = item("events", i) + ".add";
    checker.check_plugin("environment", event.add->plugin, event.add->parameters,
                         place_of(map, "add"), key + "." + event.add->plugin, key);
    if (event.id.empty()) {
      event.id = ids.free_id(event.add->plugin);
    } else if (ids.contains(event.id)) {
      checker.problem(place_of(map, "id"), item("events", i) + ".id",
                      "the id '" + event.id + "' is already used by another layer");
    }
    ids.insert(event.id);
  }
}

/// Checks that the layers an event names exist at some time; moving obstacles may be removed and
/// moved too.
void check_references(Checker& checker, const ScenarioFile& scenario, const Value& tree,
                      const Ids& layers, const Ids& moving) {
  Ids all = layers;
  all.insert(moving.begin(), moving.end());
  const auto expect = [&](std::size_t i, const char* key, const std::string& id, const Ids& among,
                          const char* what) {
    if (!id.empty() && !among.contains(id)) {
      checker.problem(
          place_of(tree.find("events")->items[i], key), item("events", i) + "." + key,
          std::string("there is no ") + what + " '" + id + "'" + did_you_mean(id, list(among)));
    }
  };
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    const EventEntry& event = scenario.events[i];
    expect(i, "remove", event.remove.value_or(""), all, "layer or moving obstacle");
    expect(i, "move", event.move ? event.move->layer : "", all, "layer or moving obstacle");
    expect(i, "set_cells", event.set_cells ? event.set_cells->layer : "", layers, "layer");
  }
}

/// Refuses a second removal of the same id: ids are used once.
void check_removed(Checker& checker, const ScenarioFile& scenario, const Value& tree) {
  std::map<std::string, std::size_t> removed;  // the event, by id
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    const std::optional<std::string>& id = scenario.events[i].remove;
    if (!id) {
      continue;
    }
    const auto [first, is_new] = removed.emplace(*id, i);
    if (!is_new) {
      checker.problem(place_of(tree.find("events")->items[i], "remove"),
                      item("events", i) + ".remove",
                      "'" + *id + "' is already removed by " + item("events", first->second));
    }
  }
}

void check_points(Checker& checker, const ScenarioFile& scenario, const Value& tree) {
  const auto check = [&](const Point& point, const Location& where, const std::string& key) {
    if (checker.has_problem_within(key)) {
      return;  // a height is given, but invalid
    }
    const bool plane = point.form == Point::Form::metres || point.form == Point::Form::lonlat;
    if (plane && !point.has_height && !point.above_ground_m && !scenario.level_flight_at_m) {
      checker.problem(where, key,
                      "the point has no height: give a third coordinate (metres above sea level), "
                      "above_ground_m, or level_flight_at_m for all points");
    }
  };
  if (!scenario.task || tree.find("start") != nullptr) {
    check(scenario.start.point, place_of(tree, "start"), "start");
  }
  if (!scenario.task || tree.find("goal") != nullptr) {
    check(scenario.goal.point, place_of(tree, "goal"), "goal");
  }
  for (std::size_t i = 0; i < scenario.via.size(); ++i) {
    check(scenario.via[i].point, tree.find("via")->items[i].where, item("via", i));
  }
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    const EventEntry& event = scenario.events[i];
    const Value& map = tree.find("events")->items[i];
    if (event.when_near) {
      check(event.when_near->point, place_of(map, "when_near"), item("events", i) + ".when_near");
    }
    if (event.visit) {
      check(event.visit->point, place_of(map, "visit"), item("events", i) + ".visit");
    }
    if (event.move_goal) {
      check(event.move_goal->point, place_of(map, "move_goal"), item("events", i) + ".move_goal");
    }
  }
}

/// The files of the body: present, and among those that a result depends on.
void check_body(Checker& checker, const ScenarioFile& scenario, const Value& tree) {
  if (!scenario.vehicle.body) {
    return;
  }
  const Value* vehicle = tree.find("vehicle");
  const Value* body = vehicle != nullptr ? vehicle->find("body") : nullptr;
  if (body == nullptr || body->kind != Value::Kind::map) {
    return;
  }
  const auto check = [&](const BodyPartEntry& part, const Value& map, const std::string& key) {
    if (part.mesh && !part.mesh->text.empty()) {
      checker.check_file(part.mesh->text, place_of(map, "mesh"), key + ".mesh");
    }
  };
  check(scenario.vehicle.body->part, *body, "vehicle.body");
  const Value* parts = body->find("parts");
  for (std::size_t i = 0; i < scenario.vehicle.body->parts.size(); ++i) {
    check(scenario.vehicle.body->parts[i], parts->items[i], item("vehicle.body.parts", i));
  }
}

void check_time(Checker& checker, const std::string& text, const Location& where,
                const std::string& key) {
  if (!formats::parse_iso_time(text)) {
    checker.problem(where, key,
                    "expected a time such as 2026-05-01T10:00:00Z, found '" + text + "'");
  }
}

/// One after another, from the start on.
void check_wind_hours(Checker& checker, const ScenarioFile& scenario, const Value& tree) {
  // NaN, which nothing is before or after, where the time is refused.
  const auto time_of = [](const std::string& text) {
    return formats::parse_iso_time(text).value_or(std::nan(""));
  };
  const std::vector<WindHourEntry>& hours = scenario.wind.hours;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const std::string key = item("wind.hours", i) + ".from_time";
    const Location where = place_of(tree, key);
    check_time(checker, hours[i].from_time, where, key);
    const double from = time_of(hours[i].from_time);
    if (i > 0 && from <= time_of(hours[i - 1].from_time)) {
      checker.problem(where, key, "expected hours in ascending order of from_time");
    }
    if (i == 0 && !scenario.start_time) {
      checker.problem(where, key, "winds by the hour need the scenario's start_time");
    }
    if (i == 0 && scenario.start_time && from > time_of(*scenario.start_time)) {
      checker.problem(where, key,
                      "no wind is given from start_time to here: the first wind begins at "
                      "start_time or before");
    }
  }
}
}  // namespace

void check_scenario(Checker& checker, ScenarioFile& scenario, const Value& tree) {
  Ids layers;
  Ids moving;
  check_layers(checker, scenario, tree, layers);
  check_moving(checker, scenario, tree, moving);
  check_added(checker, scenario, tree, layers);
  check_references(checker, scenario, tree, layers, moving);
  check_removed(checker, scenario, tree);
  check_points(checker, scenario, tree);
  check_constraints(checker, scenario.constraints, tree);
  if (scenario.objective) {
    check_objective(checker, *scenario.objective, *tree.find("objective"), "objective");
  }
  if (scenario.task) {
    const TaskEntry& task = *scenario.task;
    checker.check_plugin("task", task.plugin, task.parameters,
                         place_of(*tree.find("task"), task.plugin), "task." + task.plugin, "task");
  }
  check_body(checker, scenario, tree);
  if (scenario.start_time) {
    check_time(checker, *scenario.start_time, place_of(tree, "start_time"), "start_time");
  }
  check_wind_hours(checker, scenario, tree);
}
}  // namespace altiplan::host
