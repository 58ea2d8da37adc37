// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>

#include <filesystem>

#include "altiplan/error.hpp"
#include "host/base/output_file.hpp"
#include "host/gate/route_returns.hpp"
#include "host/result/stored_result.hpp"
#include "host/run/pipeline.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "python/arrays.hpp"
#include "python/attended.hpp"
#include "python/records.hpp"

namespace altiplan::python {
namespace {

namespace fs = std::filesystem;

/// A result with what result.json does not hold.
struct Result : Record {
  std::vector<std::shared_ptr<Step>> steps;
  std::shared_ptr<const Route> route;  ///< the accepted one, or null
  std::vector<fs::path> plugin_path;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;
};

/// Of altiplan.plan, a run of one step: the step and the warnings, no more is worked out.
using Plan = std::pair<std::shared_ptr<Step>, std::vector<std::string>>;

struct RunCall {
  fs::path file;
  bool may_be_scenario = false;
  host::Overrides overrides;
  int threads = 1;
  double timeout_s = host::kDefaultStepSeconds;
  std::optional<std::string> out;
};

/// Before any computation: the file can be written, and is not one of those that are read.
void expect_writable(const std::string& out, const host::Config& config) {
  if (const std::string why = host::output_problem(out); !why.empty()) {
    throw Error("out: " + why);
  }
  std::vector<fs::path> read{config.pipeline_path, config.scenario_path};
  read.insert(read.end(), config.files.begin(), config.files.end());
  for (const fs::path& file : read) {
    std::error_code error;
    if (fs::equivalent(out, file, error)) {
      throw Error("out: '" + out + "' is already read by this run: give another name");
    }
  }
}

std::shared_ptr<Step> step_of(Json json, const host::StepResult& result) {
  auto step = std::make_shared<Step>(Step{{std::move(json)}, nullptr});
  if (!result.route.empty()) {
    step->route = std::make_shared<const Route>(result.route);
  }
  return step;
}

/// The result in Python's form; written to the file first, as `altiplan run --out` does.
Result hand_over(const RunCall& call, const host::Config& config, const host::RunResult& run) {
  Result result;
  result.json = host::result_json(config, run);
  if (call.out) {
    host::write_file(*call.out, host::file_text(result.json));
  }
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    result.steps.push_back(step_of(result.json.at("steps").at(i), run.steps[i]));
  }
  if (run.accepted) {
    result.route = result.steps.at(*run.accepted)->route;
  }
  result.plugin_path = call.overrides.plugin_path;
  result.warnings = run.warnings;
  result.notes = run.notes;
  return result;
}

/// The route of a result or of a step, as result.json has it.
std::shared_ptr<const Route> stored_route(const Json& holder) {
  const bool has_one = holder.at("route").is_array() && !holder.at("route").empty();
  return has_one ? std::make_shared<const Route>(host::route_of(holder, "the stored result"))
                 : nullptr;
}

/// Of a result that a study has stored.
Result stored(const std::string& text, const std::vector<fs::path>& plugin_path) {
  Result result;
  result.json = Json::parse(text);
  for (const Json& step : result.json.at("steps")) {
    result.steps.push_back(std::make_shared<Step>(Step{{step}, stored_route(step)}));
  }
  result.route = stored_route(result.json);
  result.plugin_path = plugin_path;
  return result;
}

Plan plan_of(const RunCall&, const host::Config&, const host::RunResult& run) {
  if (run.steps.empty()) {
    throw Error(run.message);  // of a layer that is never built
  }
  return {step_of(host::to_json(run.steps[0]), run.steps[0]), run.warnings};
}

/// `made_of` makes what is handed over.
template <class T>
T run(const RunCall& call,
      T (*convert)(const RunCall&, const host::Config&, const host::RunResult&)) {
  return attended<T>([=](const std::shared_ptr<Outcome<T>>& outcome, const std::stop_token& stop) {
    const host::Config config = call.may_be_scenario ? host::load_plan(call.file, call.overrides)
                                                     : host::load_config(call.file, call.overrides);
    if (call.out) {
      expect_writable(*call.out, config);
    }
    host::RunOptions options;
    options.threads = call.threads;
    options.timeout_s = call.timeout_s;
    options.stop = stop;
    options.judge_returns = host::judge_route_returns;
    if (call.out) {
      options.out = *call.out;
    }
    // The program ends itself here. A script goes on, and leaves the step that never stops to
    // its thread.
    options.on_stuck = [&](const host::RunResult& so_far) {
      try {
        outcome->give(convert(call, config, so_far));
      } catch (...) {
        outcome->fail(std::current_exception());
      }
      while (true) {
        ::pause();
      }
    };
    return convert(call, config, host::run(config, options));
  });
}

/// The page of `altiplan view`, of the world built again from the run's files.
std::string page_of(const Result& result) {
  return attended<std::string>(
      [json = result.json, plugin_path = result.plugin_path](const auto&, const std::stop_token&) {
        host::Overrides overrides;
        overrides.plugin_path = plugin_path;
        // Where the result was written, its files are where it says.
        const std::string name = fs::path(json.at("pipeline").get<std::string>()).stem().string();
        const fs::path folder = json.value("folder", std::string());
        const host::Scene scene =
            host::build_scene({host::stored_result((folder / name).string(), json, overrides)});
        return host::viewer_page(scene.json);
      });
}

std::string framed(const std::string& page) {
  std::string text = "<iframe style=\"width: 100%; height: 480px; border: 0\" srcdoc=\"";
  for (const char c : page) {
    text += c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return text + "\"></iframe>";
}

template <class Class>
void add_outcome(Class& type) {
  using T = typename Class::type;
  add_keys(type, {{"status", "str", "the outcome; 'solved' only with an accepted route and flight"},
                  {"reason", "Optional[str]", "its machine-readable cause, or None"},
                  {"message", "str", "a sentence"},
                  {"budget_hit", "bool", "True if a budget ended it"},
                  {"cost", "Optional[float]",
                   "what its route costs by the objective, by default its length (m)"},
                  {"bound", "Optional[float]", "what any such route costs at least"},
                  {"setup_time_s", "float", "wall time of the setup (s)"}});
  type.def_property_readonly(
      "route", [](const T& t) { return t.route; }, "Optional[Route]: its route, or None.");
  type.def_property_readonly(
      "legs",
      [](const T& t) -> py::object { return t.route ? py::object(legs_of(*t.route)) : py::none(); },
      "Optional[list[Leg]]: the legs of that route.");
  type.def_property_readonly(
      "metrics", [](const T& t) { return record_or_none<Metrics>(t.json.at("metrics")); },
      "Optional[Metrics]: the measures of that route.");
  type.def_property_readonly(
      "check", [](const T& t) { return check_or_none(t.json.at("check"), t.route); },
      "Optional[Check]: the verdict on that route.");
}

void add_step(py::module_& module) {
  auto step = record_class<Step>(
      module, "Step", "One attempt of a step of a pipeline.",
      {{"id", "str", "name of the step"},
       {"verb", "str", "'plan', 'smooth' or 'fly'"},
       {"plugin", "str", "name of the plugin"},
       {"instead_of", "Optional[str]", "id of the step that this attempt replaces, or None"},
       {"accepted", "bool", "True if the route is accepted"},
       {"proved", "bool", "True if the planner's search space contains no route"},
       {"time_s", "float", "wall time of the call (s)"},
       {"counters", "dict[str, int]", "the plugin's counters, including 'expanded'"}});
  add_outcome(step);
  step.def("__repr__", [](const Step& s) {
    const std::string status = s.json.at("accepted").get<bool>() ? "accepted" : s.json.at("status");
    return "<altiplan.Step '" + s.json.at("id").get<std::string>() + "' " +
           s.json.at("plugin").get<std::string>() + ": " + status + ">";
  });
}

void add_result_class(py::module_& module) {
  auto result = record_class<Result>(
      module, "Result", "What a run gave: its attributes are the keys of result.json.",
      {{"version", "str", "of altiplan"},
       {"folder", "Optional[str]", "where `out` was written, or None"},
       {"pipeline", "str", "absolute path"},
       {"scenario", "str", "absolute path"},
       {"files", "list[dict[str, str]]", "path, sha256"},
       {"plugins", "list[dict[str, str]]", "kind, name, build, checksum"},
       {"overrides", "dict[str, Any]", "what replaced values of the files"},
       {"seed", "int", "the seed"}});
  add_outcome(result);
  result.def_property_readonly(
      "steps", [](const Result& r) { return r.steps; }, "list[Step]: every attempt, in order.");
  result.def_property_readonly(
      "flight", [](const Result& r) { return record_or_none<Flight>(r.json.at("flight")); },
      "Optional[Flight]: the flight, None where there is none.");
  result.def_property_readonly(
      "route_lonlat", [](const Result& r) { return to_array(r.json.at("route_lonlat"), 3); },
      "Optional[NDArray[float64]]: (m, 3), read-only: degrees east, degrees north, metres above\n"
      "sea level of route.chords(); None without a route or a georeference.");
  result.def_property_readonly(
      "warnings", [](const Result& r) { return r.warnings; }, "list[str]: sentences to check.");
  result.def_property_readonly(
      "notes", [](const Result& r) { return r.notes; }, "list[str]: sentences on the data read.");
  result.def(
      "to_json", [](const Result& r) { return host::file_text(r.json); },
      "The text of result.json, as `altiplan run --out` writes it.");
  result.def("__repr__", [](const Result& r) {
    return "<altiplan.Result " + r.json.at("status").get<std::string>() + ": " +
           r.json.at("message").get<std::string>() + ">";
  });
  result.def(
      "_repr_html_", [](const Result& r) { return framed(page_of(r)); },
      "The page of `altiplan view` in a frame, which works offline. Builds the world again;\n"
      "altiplan.Error if its files are gone.");
}
}  // namespace

void add_result(py::module_& module) {
  add_step(module);
  add_result_class(module);
  module.def(
      "run",
      [](const fs::path& pipeline, std::optional<std::int64_t> seed,
         const std::vector<std::string>& set, const std::vector<fs::path>& plugin_path, int threads,
         double timeout_s, const std::optional<std::string>& out) {
        return run({pipeline, false, {{}, seed, set, plugin_path}, threads, timeout_s, out},
                   hand_over);
      },
      py::arg("pipeline"), py::arg("seed"), py::arg("set"), py::arg("plugin_path"),
      py::arg("threads"), py::arg("timeout_s"), py::arg("out"));
  module.def("stored", stored, py::arg("text"), py::arg("plugin_path"));
  module.def(
      "plan",
      [](const fs::path& file, std::optional<std::int64_t> seed,
         const std::vector<std::string>& set, const std::vector<fs::path>& plugin_path) {
        RunCall call;
        call.file = file;
        call.may_be_scenario = true;
        call.overrides = {{}, seed, set, plugin_path};
        return run(call, plan_of);
      },
      py::arg("file"), py::arg("seed"), py::arg("set"), py::arg("plugin_path"));
}
}  // namespace altiplan::python
