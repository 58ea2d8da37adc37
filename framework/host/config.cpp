// SPDX-License-Identifier: Apache-2.0
#include "host/config.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include "host/shapes.hpp"
#include "host/yaml.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

/// The value at a dotted path, made of empty maps where the file does not go that far.
Value& reach(Value& root, const std::string& path, const std::string& text) {
  const auto fail = [&](const std::string& message) -> void {
    throw ConfigError(Location{root.where.file, 0, 0, text}, path, message);
  };
  Value* at = &root;
  std::size_t begin = 0;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (key.empty()) {
      fail("expected keys separated by single dots");
    }
    if (at->kind == Value::Kind::list) {
      std::size_t index = 0;
      const auto [stop, error] = std::from_chars(key.data(), key.data() + key.size(), index);
      if (error != std::errc() || stop != key.data() + key.size() || index >= at->items.size()) {
        fail("expected an index from 0 to " + std::to_string(at->items.size()) +
             " (excluded) at '" + key + "'");
      }
      at = &at->items[index];
    } else {
      if (at->kind == Value::Kind::scalar) {
        at->kind = Value::Kind::map;  // the value that was here gives way
        at->text.clear();
      }
      if (at->find(key) == nullptr) {
        Value fresh;
        fresh.kind = Value::Kind::map;
        fresh.where = {root.where.file, 0, 0, text};
        at->entries.push_back({key, fresh.where, fresh});
      }
      at = at->find(key);
    }
    begin = end + 1;
  }
  return *at;
}

/// Gives every location of an override's value the file that its paths are relative to.
void settle(Value& value, const std::string& file) {
  value.where.file = file;
  for (Value& item : value.items) {
    settle(item, file);
  }
  for (Value::Entry& entry : value.entries) {
    entry.where.file = file;
    settle(entry.value, file);
  }
}

/// Applies the assignments whose keys begin with `prefix` (or, without one, all the others).
void apply_overrides(Value& tree, const std::vector<std::string>& set, bool of_scenario) {
  static constexpr std::string_view kPrefix = "scenario.";
  for (const std::string& assignment : set) {
    const std::string text = "--set " + assignment;
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(Location{"", 0, 0, text}, "", "expected KEY=VALUE");
    }
    std::string path = assignment.substr(0, equals);
    const bool scenario_key = path.starts_with(kPrefix);
    if (scenario_key != of_scenario) {
      continue;
    }
    if (scenario_key) {
      path = path.substr(kPrefix.size());
    }
    Value value = parse_override(assignment.substr(equals + 1), text);
    settle(value, tree.where.file);
    reach(tree, path, text) = std::move(value);
  }
}

class Checker {
 public:
  explicit Checker(Config& config) : config_(config) {}

  template <class T>
  void bind_file(T& file, const Value& tree) {
    add(bind(file, &tree).problems);
  }

  /// Parameters of a plugin, and the files that they name.
  void check_plugin(std::string_view kind, const std::string& name, const Value& parameters,
                    const Location& where, const std::string& path, const std::string& key) {
    if (name.empty()) {
      return;  // said already
    }
    const PluginEntry* entry = nullptr;
    try {
      entry = &plugin(*config_.registry, kind, name);
    } catch (const PluginError&) {
      throw;  // a library that offers the name is refused: exit code 4
    } catch (const Error& error) {
      problems_.push_back({where, key, error.what()});
      return;
    }
    check_report(entry->describe(&parameters, path), path);
  }

  void check_report(const ParamReport& report, const std::string& path) {
    add(report.problems);
    for (const BoundField& field : report.fields) {
      if (field.spec.type == FieldType::path && field.where && field.value_json.size() > 2) {
        const Value text = parse_yaml(field.value_json, "");
        check_file(text.text, *field.where, path + "." + field.spec.name);
      }
    }
  }

  void check_file(const std::string& file, const Location& where, const std::string& key) {
    std::error_code error;
    if (!fs::exists(file, error)) {
      problems_.push_back({where, key, "there is no file '" + file + "'"});
    } else if (!fs::is_regular_file(file, error)) {
      problems_.push_back({where, key, "'" + file + "' is not a file"});
    } else if (std::find(config_.files.begin(), config_.files.end(), file) == config_.files.end()) {
      config_.files.emplace_back(file);
    }
  }

  void problem(Location where, std::string key, std::string message) {
    problems_.push_back({std::move(where), std::move(key), std::move(message)});
  }
  void add(const std::vector<Problem>& problems) {
    problems_.insert(problems_.end(), problems.begin(), problems.end());
  }
  void finish() {
    if (!problems_.empty()) {
      std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& a, const Problem& b) {
        return std::tie(a.where.file, a.where.line, a.where.column) <
               std::tie(b.where.file, b.where.line, b.where.column);
      });
      throw ConfigError(std::move(problems_));
    }
  }

 private:
  Config& config_;
  std::vector<Problem> problems_;
};

std::string item(const std::string& list, std::size_t index) {
  return list + "." + std::to_string(index);
}

/// Where a key of a map stands; the map itself where it does not.
Location place_of(const Value& map, std::string_view key) {
  for (const Value::Entry& entry : map.entries) {
    if (entry.key == key) {
      return entry.where;
    }
  }
  return map.where;
}

void check_constraints(Checker& checker, const std::vector<ConstraintEntry>& entries,
                       const Value& tree) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string path = item("constraints", i);
    const ConstraintEntry& entry = entries[i];
    checker.check_plugin("constraint", entry.plugin, entry.parameters,
                         place_of(tree.find("constraints")->items[i], entry.plugin),
                         path + "." + entry.plugin, path);
  }
}

void check_scenario(Checker& checker, ScenarioFile& scenario, const Value& tree) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i < scenario.environment.size(); ++i) {
    LayerEntry& layer = scenario.environment[i];
    const Value& map = tree.find("environment")->items[i];
    const std::string path = item("environment", i);
    checker.check_plugin("environment", layer.plugin, layer.parameters, place_of(map, layer.plugin),
                         path + "." + layer.plugin, path);
    if (layer.id.empty()) {  // terrain, terrain_2, …
      layer.id = layer.plugin;
      for (int n = 2; ids.contains(layer.id); ++n) {
        layer.id = layer.plugin + "_" + std::to_string(n);
      }
    } else if (ids.contains(layer.id)) {
      checker.problem(place_of(map, "id"), path + ".id",
                      "the id '" + layer.id + "' names another layer already");
    }
    ids.insert(layer.id);
  }
  std::set<std::string> moving_ids;
  for (std::size_t i = 0; i < scenario.moving.size(); ++i) {
    MovingEntry& moving = scenario.moving[i];
    const Value& map = tree.find("moving")->items[i];
    const std::string path = item("moving", i);
    if (moving.id.empty()) {
      moving.id = moving.shape + "_" + std::to_string(i + 1);
    }
    if (!moving_ids.insert(moving.id).second) {
      checker.problem(place_of(map, "id"), path + ".id",
                      "the id '" + moving.id + "' names another moving obstacle already");
    }
    if (moving.shape.empty()) {
      continue;
    }
    if (const DescribeMoving describe = describe_moving(moving.shape)) {
      checker.check_report(describe(&moving.parameters, path + "." + moving.shape), path);
    } else {
      std::vector<std::string> names = moving_shapes();
      names.emplace_back("random");
      const std::string near = nearest_name(moving.shape, names);
      checker.problem(place_of(map, moving.shape), path,
                      "unknown shape '" + moving.shape +
                          "'; expected sphere, cylinder, box, prism or random" +
                          (near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
  }
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    EventEntry& event = scenario.events[i];
    const Value& map = tree.find("events")->items[i];
    const std::string path = item("events", i);
    if (event.add) {
      const std::string key = path + ".add";
      checker.check_plugin("environment", event.add->plugin, event.add->parameters,
                           place_of(map, "add"), key + "." + event.add->plugin, key);
      if (event.id.empty()) {
        event.id = event.add->plugin;
      }
      if (!ids.insert(event.id).second) {
        checker.problem(place_of(map, "add"), path + ".id",
                        "the id '" + event.id + "' names another layer already");
      }
    }
  }
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    const EventEntry& event = scenario.events[i];
    const Value& map = tree.find("events")->items[i];
    for (const auto& [key, id] :
         {std::pair("remove", event.remove.value_or("")),
          std::pair("move", event.move ? event.move->layer : ""),
          std::pair("set_cells", event.set_cells ? event.set_cells->layer : "")}) {
      if (!id.empty() && !ids.contains(id)) {
        const std::string near = nearest_name(id, {ids.begin(), ids.end()});
        checker.problem(place_of(map, key), item("events", i) + "." + key,
                        "there is no layer '" + id + "'" +
                            (near.empty() ? "" : "; did you mean '" + near + "'?"));
      }
    }
  }
  check_constraints(checker, scenario.constraints, tree);
}

/// Binds a step map and its alternatives.
StepEntry bind_step(Checker& checker, const Value& tree, const std::string& path,
                    bool alternative) {
  StepEntry step;
  checker.add(bind(step, &tree, path).problems);
  step.where = tree.where;
  step.path = path;
  if (alternative && !step.alternatives.empty()) {
    checker.problem(place_of(tree, "else"), path + ".else",
                    "an alternative has no alternatives of its own: list them all under the step");
    return step;
  }
  for (std::size_t i = 0; i < step.alternatives.size(); ++i) {
    step.otherwise.push_back(
        bind_step(checker, step.alternatives[i], item(path + ".else", i), true));
    if (step.otherwise.back().verb != step.verb) {
      checker.problem(step.alternatives[i].where, item(path + ".else", i),
                      std::string("expected the verb '") + name(step.verb) + "' under its else");
    }
  }
  return step;
}

/// `plan: NAME` looks for a planner, then for a local planner.
const char* kind_of_step(Registry& registry, const StepEntry& step) {
  switch (step.verb) {
    case Verb::smooth:
      return "smoother";
    case Verb::fly:
      return "local_planner";
    case Verb::plan:
      break;
  }
  return registry.offering("planner", step.plugin) == nullptr &&
                 registry.offering("local_planner", step.plugin) != nullptr
             ? "local_planner"
             : "planner";
}

void check_step(Checker& checker, Registry& registry, const StepEntry& step, const Value& tree) {
  if (step.plugin.empty()) {
    return;
  }
  const bool follows_route = step.verb == Verb::fly && step.plugin == kFollowRoute;
  if (!follows_route) {
    checker.check_plugin(kind_of_step(registry, step), step.plugin, step.with,
                         place_of(tree, name(step.verb)), step.path + ".with",
                         step.path + "." + name(step.verb));
  } else if (!step.with.entries.empty()) {
    checker.problem(place_of(tree, "with"), step.path + ".with",
                    "following the route alone has no parameters");
  }
  for (std::size_t i = 0; i < step.fly.smooth.size(); ++i) {
    const SmootherEntry& smoother = step.fly.smooth[i];
    const std::string path = item(step.path + ".smooth", i);
    checker.check_plugin("smoother", smoother.plugin, smoother.parameters, place_of(tree, "smooth"),
                         path + "." + smoother.plugin, path);
  }
  const Value& replan = step.fly.replan;
  if (replan.kind == Value::Kind::map) {
    StepEntry planner;
    checker.add(bind(planner, &replan, step.path + ".replan").problems);
    planner.path = step.path + ".replan";
    if (planner.verb != Verb::plan) {
      checker.problem(replan.where, step.path + ".replan", "expected {plan: NAME, with: {…}}");
    } else {
      check_step(checker, registry, planner, replan);
    }
  }
}

void check_steps(Checker& checker, Config& config) {
  std::set<std::string> ids;
  std::set<std::string> plans;
  bool flown = false;
  const auto check_one = [&](StepEntry& step, const Value& tree) {
    for (const std::string* reference : {step.from ? &*step.from : nullptr}) {
      if (reference != nullptr && !ids.contains(*reference)) {
        const std::string near = nearest_name(*reference, {ids.begin(), ids.end()});
        checker.problem(place_of(tree, "from"), step.path + ".from",
                        "there is no earlier step '" + *reference + "'" +
                            (near.empty() ? "" : "; did you mean '" + near + "'?"));
      }
    }
    const Value& replan = step.fly.replan;
    if (replan.kind == Value::Kind::scalar && !replan.text.empty() &&
        !plans.contains(replan.text)) {
      const std::string near = nearest_name(replan.text, {plans.begin(), plans.end()});
      checker.problem(place_of(tree, "replan"), step.path + ".replan",
                      "there is no earlier plan step '" + replan.text + "'" +
                          (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    check_step(checker, *config.registry, step, tree);
    const bool given = tree.find("id") != nullptr;
    std::string id = step.id;
    for (int n = 2; !given && ids.contains(id); ++n) {
      id = step.id + "_" + std::to_string(n);
    }
    if (given && ids.contains(id)) {
      checker.problem(place_of(tree, "id"), step.path + ".id",
                      "the id '" + id + "' names another step already");
    }
    step.id = id;
  };
  for (std::size_t i = 0; i < config.pipeline.steps.size(); ++i) {
    const Value& tree = config.pipeline.steps[i];
    StepEntry step = bind_step(checker, tree, item("steps", i), false);
    if (flown) {
      checker.problem(tree.where, step.path, "fly is the last step");
    }
    flown = flown || step.verb == Verb::fly;
    if (step.verb != Verb::plan && plans.empty()) {
      checker.problem(tree.where, step.path,
                      std::string("there is no route to ") + name(step.verb) +
                          " yet: expected a plan step before");
    }
    check_one(step, tree);
    for (std::size_t k = 0; k < step.otherwise.size(); ++k) {
      check_one(step.otherwise[k], step.alternatives[k]);
      ids.insert(step.otherwise[k].id);
    }
    ids.insert(step.id);
    if (step.verb == Verb::plan) {
      plans.insert(step.id);
      for (const StepEntry& other : step.otherwise) {
        plans.insert(other.id);
      }
    }
    config.steps.push_back(std::move(step));
  }
}

fs::path absolute_file(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

std::shared_ptr<Registry> make_registry(const Config& config) {
  std::vector<fs::path> folders = config.overrides.plugin_path;
  for (const auto* list : {&config.pipeline.plugins, &config.scenario.plugins}) {
    for (const Path& path : *list) {
      folders.emplace_back(path.text);
    }
  }
  return std::make_shared<Registry>(Registry::search_path(folders));
}

void read_scenario(Config& config, Checker& checker) {
  config.scenario_tree = load_yaml(config.scenario_path);
  apply_overrides(config.scenario_tree, config.overrides.set, true);
  checker.bind_file(config.scenario, config.scenario_tree);
  config.files.push_back(config.scenario_path);
}
}  // namespace

const PluginEntry& plugin(Registry& registry, std::string_view kind, std::string_view name) {
  if (kind == "environment") {
    for (const PluginEntry& entry : built_in_environments()) {
      if (name == entry.name) {
        return entry;
      }
    }
  }
  return registry.get(kind, name);
}

FileKind kind_of(const Value& tree) {
  if (tree.find("pipelines") != nullptr || tree.find("scenarios") != nullptr) {
    return FileKind::study;
  }
  const bool scenario = tree.find("environment") != nullptr || tree.find("start") != nullptr ||
                        tree.find("goal") != nullptr;
  return scenario ? FileKind::scenario : FileKind::pipeline;
}

Config load_scenario(const fs::path& scenario, const Overrides& overrides) {
  Config config;
  config.overrides = overrides;
  config.scenario_path = absolute_file(scenario);
  config.seed = overrides.seed.value_or(0);
  Checker checker(config);
  read_scenario(config, checker);
  config.registry = make_registry(config);
  check_scenario(checker, config.scenario, config.scenario_tree);
  checker.finish();
  return config;
}

Config load_config(const fs::path& pipeline, const Overrides& overrides) {
  Config config;
  config.overrides = overrides;
  config.pipeline_path = absolute_file(pipeline);
  config.pipeline_tree = load_yaml(config.pipeline_path);
  apply_overrides(config.pipeline_tree, overrides.set, false);
  Checker checker(config);
  checker.bind_file(config.pipeline, config.pipeline_tree);
  config.files.push_back(config.pipeline_path);
  config.seed = overrides.seed.value_or(config.pipeline.seed);
  if (overrides.scenario) {
    config.scenario_path = absolute_file(*overrides.scenario);
  } else if (config.pipeline.scenario) {
    config.scenario_path = absolute_file(config.pipeline.scenario->text);
  } else {
    checker.problem(config.pipeline_tree.where, "",
                    "the key 'scenario' is missing: a scenario file, or --scenario");
    checker.finish();
  }
  std::error_code error;
  if (!overrides.scenario && !fs::is_regular_file(config.scenario_path, error)) {
    checker.problem(place_of(config.pipeline_tree, "scenario"), "scenario",
                    "there is no file '" + config.scenario_path.string() + "'");
    checker.finish();
  }
  read_scenario(config, checker);
  config.registry = make_registry(config);
  check_scenario(checker, config.scenario, config.scenario_tree);
  check_constraints(checker, config.pipeline.constraints, config.pipeline_tree);
  check_steps(checker, config);
  checker.finish();
  return config;
}

namespace {
std::string shown_location(const std::optional<Location>& where) {
  return where ? where->text() : "default";
}

/// Leaves of a report; fields that hold plugins are explained by those plugins.
void add_fields(std::vector<Explained>& all, const ParamReport& report, const std::string& path) {
  for (const BoundField& field : report.fields) {
    if (field.spec.type == FieldType::plugin) {
      continue;
    }
    const std::string name = field.spec.type == FieldType::point ? "at" : field.spec.name;
    const std::string& value = field.value_json;
    all.push_back({path.empty() ? name : path + "." + name, value.empty() ? "null" : value,
                   shown_location(field.where), field.spec.unit});
  }
}
}  // namespace

std::vector<Explained> explain(const Config& config) {
  std::vector<Explained> all;
  Registry& registry = *config.registry;
  const auto add_plugin = [&](std::string_view kind, const std::string& name,
                              const Value& parameters, const std::string& path) {
    add_fields(all, plugin(registry, kind, name).describe(&parameters, path), path);
  };
  ScenarioFile scenario;
  for (const BoundField& field : bind(scenario, &config.scenario_tree).fields) {
    if (field.spec.type != FieldType::list) {
      add_fields(all, {{field}, {}}, "scenario");
    }
  }
  for (std::size_t i = 0; i < config.scenario.environment.size(); ++i) {
    const LayerEntry& layer = config.scenario.environment[i];
    add_plugin("environment", layer.plugin, layer.parameters,
               item("scenario.environment", i) + "." + layer.plugin);
  }
  for (const auto& [entries, path] :
       {std::pair(&config.scenario.constraints, "scenario.constraints"),
        std::pair(&config.pipeline.constraints, "constraints")}) {
    for (std::size_t i = 0; i < entries->size(); ++i) {
      const ConstraintEntry& entry = (*entries)[i];
      add_plugin("constraint", entry.plugin, entry.parameters, item(path, i) + "." + entry.plugin);
    }
  }
  PipelineFile pipeline;
  for (const BoundField& field : bind(pipeline, &config.pipeline_tree).fields) {
    if (field.spec.type != FieldType::list) {
      add_fields(all, {{field}, {}}, "");
    }
  }
  const auto add_step = [&](const StepEntry& step, const Value& tree) {
    StepEntry copy;
    for (const BoundField& field : bind(copy, &tree, step.path).fields) {
      if (field.spec.name != "with" && field.spec.name != "else" &&
          (field.where || field.value_json != "null")) {
        add_fields(all, {{field}, {}}, step.path);
      }
    }
    if (step.plugin != kFollowRoute) {
      add_plugin(kind_of_step(registry, step), step.plugin, step.with, step.path + ".with");
    }
  };
  for (std::size_t i = 0; i < config.steps.size(); ++i) {
    const StepEntry& step = config.steps[i];
    add_step(step, config.pipeline.steps[i]);
    for (std::size_t k = 0; k < step.otherwise.size(); ++k) {
      add_step(step.otherwise[k], step.alternatives[k]);
    }
  }
  return all;
}
}  // namespace altiplan::host
