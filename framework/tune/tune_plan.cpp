// SPDX-License-Identifier: Apache-2.0
#include "tune/tune_plan.hpp"

#include <algorithm>
#include <set>

#include "altiplan/attributed.hpp"
#include "altiplan_build.hpp"
#include "host/base/input.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/sha256.hpp"
#include "host/config/overrides.hpp"
#include "host/config/yaml.hpp"
#include "study/model/run_values.hpp"
#include "study/plan/study_grid.hpp"

namespace altiplan::tune {
namespace fs = std::filesystem;
namespace {

/// Splits "a=1,b=[2,3]" at the commas outside brackets.
std::vector<std::string> split_outside_brackets(const std::string& text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  for (const char c : text) {
    depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    if (c == ',' && depth == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// The keys and values of FILE[KEY=VALUES,…], like a study's `set`.
Value set_of(const std::string& text, const Location& where) {
  Value set;
  set.kind = Value::Kind::map;
  set.where = where;
  for (const std::string& part : split_outside_brackets(text)) {
    const std::size_t equals = part.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw ConfigError(where, "", "expected FILE[KEY=VALUES,…], found " + excerpt(part));
    }
    for (const auto& entry : set.entries) {
      if (entry.key == part.substr(0, equals)) {
        throw ConfigError(where, "", "the key '" + entry.key + "' is given twice");
      }
    }
    set.entries.push_back({part.substr(0, equals), where,
                           host::parse_override(part.substr(equals + 1), where.override_text)});
  }
  return set;
}

/// One entry of --scenarios or --hold-out: a file, or a file with keys set to each of their values.
std::vector<study::Variant> scenarios_of(const std::string& entry, const std::string& option) {
  const Location where{"", 0, 0, option + " " + entry};
  const std::size_t bracket =
      host::is_there(entry) || !entry.ends_with(']') ? std::string::npos : entry.find('[');
  const std::string file = entry.substr(0, bracket);
  if (const std::string why = host::file_problem(file); !why.empty()) {
    throw ConfigError(where, "", why);
  }
  const std::string of = fs::path(file).stem().string();
  const fs::path path = fs::absolute(file).lexically_normal();
  if (bracket == std::string::npos) {
    return {study::Variant{of, of, path, {}}};
  }
  std::vector<study::Variant> all;
  const std::string inner = entry.substr(bracket + 1, entry.size() - bracket - 2);
  for (const study::GridCell& cell : study::grid_of(set_of(inner, where), "")) {
    study::Variant variant{of + cell.label, of, path, {}};
    for (const study::Assignment& assignment : cell.assignments) {
      variant.set.push_back("scenario." + assignment.key + "=" + assignment.value);
    }
    all.push_back(std::move(variant));
  }
  return all;
}

/// A canonical form, equal for two names of the same scenario.
std::string identity(const fs::path& file, const std::vector<std::string>& set) {
  return fs::weakly_canonical(file).string() + " " + host::exact_json_text(set);
}

/// Fills the plan's scenarios.
void find_scenarios(TunePlan& plan) {
  const TuneRequest& request = plan.request;
  std::set<std::string> known;
  for (const auto& [entries, option] :
       {std::pair(&request.scenarios, "--scenarios"), std::pair(&request.hold_out, "--hold-out")}) {
    for (const std::string& entry : *entries) {
      for (study::Variant& variant : scenarios_of(entry, option)) {
        if (!known.insert(identity(variant.file, variant.set)).second) {
          throw ConfigError(
              Location{"", 0, 0, std::string(option) + " " + entry}, "",
              "the scenario '" + variant.name + "' is given twice" +
                  (entries == &request.hold_out ? ": held-out scenarios must be new to the tuning"
                                                : ""));
        }
        plan.scenarios.push_back(std::move(variant));
      }
    }
    if (plan.scenarios.empty()) {
      plan.scenarios.push_back({"", "", {}, {}});  // the pipeline's own
    }
    plan.tuned_on = entries == &request.scenarios ? plan.scenarios.size() : plan.tuned_on;
  }
}

/// The pipeline in that scenario; problems are reported at the option that named the scenario.
host::Config load_in(const TunePlan& plan, std::size_t scenario) {
  try {
    return host::load_config(plan.request.pipeline, plan.overrides(scenario, {}),
                             plan.config.registry);
  } catch (const ConfigError& error) {
    std::vector<Problem> problems = error.problems();
    const char* option = scenario < plan.tuned_on ? "--scenarios " : "--hold-out ";
    for (Problem& problem : problems) {
      std::string& text = problem.where.override_text;
      text = text.empty() ? "" : option + plan.scenarios[scenario].name;
    }
    throw ConfigError(std::move(problems));
  }
}

/// The tuner with its parameters, and these as JSON.
host::Json make_tuner(TunePlan& plan) {
  const TuneRequest& request = plan.request;
  Value with = host::empty_map();
  for (const std::string& assignment : request.set_tuner) {
    const Location where{"", 0, 0, "--set-tuner " + assignment};
    const std::size_t equals = assignment.find('=');
    const std::string key = assignment.substr(0, equals);
    if (with.find(key) != nullptr) {
      throw ConfigError(where, key, "is given twice");
    }
    with.entries.push_back(
        {key, where, host::parse_override(assignment.substr(equals + 1), where.override_text)});
  }
  const PluginEntry& entry = plugin(*plan.config.registry, "tuner", request.tuner);
  const std::string who = "the tuner '" + request.tuner + "'";
  const ParamReport report =
      attributed([&] { return "describing " + who; }, [&] { return entry.describe(&with, ""); });
  if (!report.problems.empty()) {
    throw ConfigError(report.problems);
  }
  plan.tuner = attributed([&] { return "making " + who; }, [&] { return entry.tuner(&with); });
  host::Json json = {{"name", request.tuner},
                     {"build", plan.config.registry->offering("tuner", request.tuner)->build}};
  for (const BoundField& field : report.fields) {
    json["parameters"][field.spec.name] = host::parse_json(field.value_json);
  }
  return json;
}

host::Json settings_of(const TunePlan& plan, const host::Json& tuner,
                       const std::set<fs::path>& files, const host::Json& plugins) {
  const TuneRequest& request = plan.request;
  host::Json names = host::Json::array();
  for (const study::Variant& scenario : plan.scenarios) {
    names.push_back({scenario.name, scenario.set});
  }
  const auto middle = names.begin() + std::ptrdiff_t(plan.tuned_on);
  host::Json settings = {{"altiplan", ALTIPLAN_VERSION}, {"program", study::host_build()}};
  settings["pipeline"] = request.pipeline.filename().string();
  settings["--over"] = request.over;
  settings["--metric"] = request.metric;
  settings["--scenarios"] = host::Json(names.begin(), middle);
  settings["--hold-out"] = host::Json(middle, names.end());
  settings["--tuner"] = tuner;
  settings["--seed"] = request.seed;
  settings["--penalty"] = request.penalty ? host::Json(*request.penalty) : host::Json();
  settings["limits"] = {{"wall_s", request.limits.wall_s}, {"memory_mb", request.limits.memory_mb}};
  for (const fs::path& file : files) {
    settings["files"][file.string()] = host::sha256(file);
  }
  settings["plugins"] = plugins;
  return settings;
}
}  // namespace

std::vector<Dimension> TunePlan::space() const {
  std::vector<Dimension> space;
  for (const TunedParameter& parameter : parameters) {
    space.push_back(parameter.dimension());
  }
  return space;
}

std::vector<std::string> TunePlan::assignments(const std::vector<double>& point) const {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < point.size(); ++i) {
    all.push_back(parameters[i].over.key + "=" + parameters[i].value(point[i]));
  }
  return all;
}

host::Overrides TunePlan::overrides(std::size_t scenario,
                                    const std::vector<std::string>& assignments) const {
  host::Overrides overrides;
  const study::Variant& variant = scenarios[scenario];
  if (!variant.file.empty()) {
    overrides.scenario = variant.file;
  }
  overrides.set = variant.set;
  overrides.set.insert(overrides.set.end(), assignments.begin(), assignments.end());
  overrides.plugin_path = request.plugin_path;
  return overrides;
}

TunePlan plan_tuning(const TuneRequest& request) {
  TunePlan plan;
  plan.request = request;
  plan.objective = study::read_objective(request.metric);
  const std::vector<OverEntry> entries = read_over(request.over);
  find_scenarios(plan);
  std::set<fs::path> files;
  std::set<host::Json> plugins;
  for (std::size_t s = 0; s < plan.scenarios.size(); ++s) {
    host::Config config = load_in(plan, s);
    files.insert(config.files.begin(), config.files.end());
    const host::Json used = host::plugins_json(config);
    plugins.insert(used.begin(), used.end());
    if (s == 0) {
      plan.config = std::move(config);
    }
  }
  std::vector<std::string> metrics;
  for (const auto* given : {&plan.config.scenario.metrics, &plan.config.pipeline.metrics}) {
    for (const host::MetricEntry& metric : *given) {
      metrics.push_back(metric.id);
    }
  }
  study::PipelineParts parts{plan.config.pipeline_path.stem().string(), {}, false, true};
  for (const host::StepEntry& step : plan.config.steps) {
    parts.steps.push_back(step.id);
    parts.flies = parts.flies || step.verb == host::Verb::fly;
    for (const host::StepEntry& other : step.otherwise) {
      parts.steps.push_back(other.id);
    }
  }
  for (const study::ClaimValue& value : plan.objective.values) {
    std::string why = study::why_no_value(value.name, metrics);
    why = why.empty() ? study::why_no_part(value.name, {parts}) : why;
    if (!why.empty()) {
      throw ConfigError(Location{"", 0, 0, "--metric " + request.metric}, "", why);
    }
  }
  if (plan.scenarios[0].name.empty()) {
    const fs::path& own = plan.config.scenario_path;
    plan.scenarios[0].name = own.stem().string();
    for (std::size_t s = plan.tuned_on; s < plan.scenarios.size(); ++s) {
      if (identity(plan.scenarios[s].file, plan.scenarios[s].set) == identity(own, {})) {
        throw ConfigError(Location{"", 0, 0, "--hold-out " + own.string()}, "",
                          "the scenario is the pipeline's own, which it is tuned on: held-out "
                          "scenarios must be new to the tuning");
      }
    }
  }
  plan.parameters = find_parameters(plan.config, entries);
  const host::Json tuner = make_tuner(plan);
  plan.settings = settings_of(plan, tuner, files, host::Json(plugins));
  return plan;
}
}  // namespace altiplan::tune
