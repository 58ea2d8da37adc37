// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "commands.hpp"
#include "flight_text.hpp"
#include "guarded_run.hpp"
#include "host/base/output_file.hpp"
#include "host/base/words.hpp"
#include "host/result/result_json.hpp"
#include "table.hpp"

namespace altiplan::cli {
namespace {

struct RunArguments {
  std::string pipeline;
  host::Overrides overrides;
  int threads = 1;
  std::optional<std::string> trace;
  std::size_t trace_limit_mb = host::kDefaultTraceMb;
  std::optional<std::string> out;
  bool json = false;
  double timeout_s = host::kDefaultStepSeconds;
};

void add_row(Table& table, const std::string& id, const std::string& plugin,
             const std::string& status, const std::optional<Measures>& m, double seconds,
             const std::vector<Table::Cell>& costs) {
  std::optional<double> length;
  std::optional<double> points;
  if (m) {
    length = m->length_m / 1000;
    points = double(m->waypoints);
  }
  std::vector<Table::Cell> row{id,
                               plugin,
                               Table::Cell(status, color_of(status)),
                               fixed(length, 3),
                               fixed(points, 0),
                               fixed(m ? m->max_turn_deg : std::nullopt, 1),
                               fixed(m ? m->min_radius_m : std::nullopt, 1),
                               fixed(m ? m->max_climb_deg : std::nullopt, 1),
                               fixed(m ? m->min_clearance_m : std::nullopt, 1),
                               fixed(m ? m->min_ground_clearance_m : std::nullopt, 1),
                               fixed(seconds * 1000, 1)};
  row.insert(row.end(), costs.begin(), costs.end());
  table.add(std::move(row));
}

/// Cost and certified gap of a step's route; nothing where length is minimised.
std::vector<Table::Cell> costs_of(const host::RunResult& result, const host::StepResult& step) {
  if (!result.objective) {
    return {};
  }
  if (!step.cost) {
    return {"-", "-"};
  }
  const double gap = step.cost->gap();  // infinite where no bound is known
  return {host::with_digits(step.cost->cost, 6), std::isfinite(gap) ? fixed(100 * gap, 2) : "-"};
}

/// The time budget of the step with this id, if it has no other budget that could end it.
std::optional<double> only_time_budget(const host::Config& config, const std::string& id) {
  const auto of_one = [&](const host::StepEntry& step) {
    return step.id == id && !step.within_iterations && !step.within_mb ? step.within_s
                                                                       : std::nullopt;
  };
  for (const host::StepEntry& step : config.steps) {
    std::optional<double> seconds = of_one(step);
    for (const host::StepEntry& other : step.otherwise) {
      seconds = seconds ? seconds : of_one(other);
    }
    if (seconds) {
      return seconds;
    }
  }
  return std::nullopt;
}

/// Names the accepted routes that a budget ended: more of it may improve them.
void print_budgets(std::FILE* to, const host::Config& config, const host::RunResult& result) {
  for (const host::StepResult& step : result.steps) {
    if (!step.budget_hit || !step.accepted || step.verb == host::Verb::fly) {
      continue;
    }
    if (const auto seconds = only_time_budget(config, step.id)) {
      std::fprintf(to, "  the budget of %g s ended '%s': more time may give a better route\n",
                   *seconds, step.id.c_str());
    } else {
      std::fprintf(to, "  the budget ended '%s': a larger one may give a better route\n",
                   step.id.c_str());
    }
  }
}

void print_table(std::FILE* to, const host::RunResult& result) {
  std::vector<Table::Column> columns{
      {"step", false, 14},  {"plugin", false, 12}, {"status", false, 12}, {"length_km", true, 9},
      {"points", true, 6},  {"turn_d", true, 6},   {"radius_m", true, 8}, {"climb_d", true, 7},
      {"clear_m", true, 8}, {"ground_m", true, 8}, {"time_ms", true, 8}};
  if (result.objective) {
    const std::string unit = result.objective->unit();
    columns.push_back({"cost" + (unit.empty() ? "" : " (" + unit + ")"), true, 8});
    columns.push_back({"gap_%", true, 6});
  }
  Table table(columns);
  for (const host::StepResult& step : result.steps) {
    const bool flown =
        result.flight && step.verb == host::Verb::fly && &step == &result.steps.back();
    add_row(table, step.id, step.plugin, step.accepted && !flown ? "accepted" : name(step.status),
            flown ? result.flight->measures : step.measures, step.time_s, costs_of(result, step));
  }
  table.print(to);
  if (const std::string flown = flown_in_words(result); !flown.empty()) {
    std::fprintf(to, "  flown in %s\n", flown.c_str());
  }
  if (const std::string stops = stops_in_words(result); !stops.empty()) {
    std::fprintf(to, "  stops: %s\n", stops.c_str());
  }
  if (result.accepted) {
    print_metrics(to, "route", result.steps[*result.accepted].metrics);
  }
  if (result.flight) {
    print_metrics(to, "flight", result.flight->metrics);
    print_flight(to, *result.flight, result.steps.back().budget_hit);
  }
  for (const host::StepResult& step : result.steps) {
    const std::string& message = result.message;  // printed last
    if (!step.accepted && (step.message.empty() || message.find(step.message) == message.npos)) {
      std::fprintf(to, "  %s: %s\n", step.id.c_str(), step.message.c_str());
    }
  }
}

void hand_out(std::FILE* to, const RunArguments& arguments, const host::Config& config,
              const host::RunResult& result, Interrupt& interrupt) {
  const host::Json json =
      arguments.out || arguments.json ? host::result_json(config, result) : host::Json();
  std::string problem;
  if (arguments.out) {
    try {
      host::write_file(*arguments.out, host::file_text(json));
    } catch (const Error& error) {  // the result is printed first
      problem = error.what();
    }
  }
  interrupt.finish();
  if (arguments.json) {
    std::fputs(host::file_text(json).c_str(), to);
  } else {
    std::fprintf(to, "%s: %s\n", config.pipeline_path.stem().c_str(),
                 painted(to, color_of(name(result.status)), name(result.status)).c_str());
    print_table(to, result);
    print_budgets(to, config, result);
    std::fprintf(to, "  %s\n", result.message.c_str());
  }
  if (!problem.empty()) {
    throw Error(problem);
  }
}

int run(const RunArguments& arguments) {
  expect_writable(arguments.out, "--out");
  expect_writable(arguments.trace, "--trace");
  const host::Config config = host::load_config(arguments.pipeline, arguments.overrides);
  std::vector<std::string> read{config.pipeline_path.string(), config.scenario_path.string()};
  for (const std::filesystem::path& file : config.files) {
    read.push_back(file.string());
  }
  expect_apart(arguments.out, "--out", read);
  read.push_back(arguments.out.value_or(""));
  expect_apart(arguments.trace, "--trace", read);
  Interrupt interrupt;
  host::RunOptions options;
  options.timeout_s = arguments.timeout_s;
  options.threads = arguments.threads;
  options.trace = arguments.trace;
  options.trace_limit_mb = arguments.trace_limit_mb;
  const HandOut to = [&](std::FILE* out, const host::RunResult& result) {
    hand_out(out, arguments, config, result, interrupt);
    return result.exit_code();
  };
  const host::RunResult result =
      guarded_run(config, options, {arguments.out, arguments.json}, interrupt, to);
  print_remarks(result);
  to(stdout, result);
  if (!result.trace_error.empty()) {
    throw Error(result.trace_error);
  }
  return interrupt.happened() ? kInterrupted : result.exit_code();
}
}  // namespace

void add_run(App& app, Action& action) {
  auto [command, arguments] = add_command<RunArguments>(
      app, action, "run", "run a pipeline: plan, smooth, judge and fly a route", run);
  command.add_option("pipeline", arguments.pipeline, "pipeline file (YAML)")->required();
  add_overrides(command, arguments.overrides);
  command
      .add_option("--threads", arguments.threads,
                  "maximum number of threads per plugin (default 1)")
      ->check(Check::between(1, 1024));
  auto* trace =
      command.add_option("--trace FILE", arguments.trace, "write a search trace to this file");
  command
      .add_option("--trace-limit MB", arguments.trace_limit_mb,
                  "maximum size of the trace (MB, default 64)")
      ->check(Check::between(1, 1'000'000))
      ->needs(trace);
  command.add_option("-o,--out FILE", arguments.out, "write the result to this file (JSON)");
  command
      .add_option("--timeout", arguments.timeout_s,
                  "timeout for steps without `within_s`, and for creating plugins and layers and "
                  "judging (s, default 60)")
      ->check(number_from(0.001, 1e8));
  command.add_flag("--json", arguments.json, "print only the result, as JSON");
  set_example(command,
              "altiplan run configs/pipelines/ridge_crossing.yaml --seed 3 "
              "--set steps.0.with.weight_g=0.6 --out result.json");
}
}  // namespace altiplan::cli
