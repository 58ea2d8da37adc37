// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "commands.hpp"
#include "progress.hpp"
#include "study/figures/text.hpp"
#include "study/model/run_values.hpp"
#include "table.hpp"
#include "tune/tune_report.hpp"

namespace altiplan::cli {
namespace {

using study::report::counted;
using study::report::readable;

struct TuneArguments {
  tune::TuneRequest request;
  tune::TuneOptions options;
  host::Overrides overrides;  ///< only the plugin path is used
  bool resume = false;        ///< no effect: the default
};

std::string line_of(const tune::TuneProgress& progress) {
  std::string line = std::to_string(progress.evaluations) + " of " +
                     std::to_string(progress.expected) + " evaluations";
  if (std::isfinite(progress.best)) {
    line += ", best " + readable(progress.best, 6);
  }
  if (progress.runs > 0 && progress.runs_left > 0) {
    line += ", " +
            duration(progress.elapsed_s / double(progress.runs) * double(progress.runs_left)) +
            " left";
  }
  return line;
}

/// Relative difference of the second value: "-3.5 %".
std::string change(double before, double now) {
  if (!std::isfinite(before) || !std::isfinite(now) || before == 0) {
    return "-";
  }
  const double percent = 100 * (now - before) / std::abs(before);
  return (percent > 0 ? "+" : "") + fixed(percent, 2) + " %";
}

void add_comparison(Table& table, const char* what, const tune::TunedComparison& comparison) {
  if (comparison.scenarios == 0) {
    return;
  }
  const Color color = comparison.mean_now < comparison.mean_before   ? Color::good
                      : comparison.mean_now > comparison.mean_before ? Color::bad
                                                                     : Color::none;
  table.add({"mean over " + counted(comparison.scenarios, std::string(what) + " scenario"),
             readable(comparison.mean_before, 6), readable(comparison.mean_now, 6),
             Table::Cell(change(comparison.mean_before, comparison.mean_now), color)});
}

std::string share_of(std::size_t part, std::size_t all) {
  return std::to_string(part) + " (" + study::report::percent(double(part) / double(all)) + ")";
}

/// "altiplan run …", which reproduces the score in the first scenario.
std::string repeating_call(const tune::TunePlan& plan, const std::string& folder) {
  const study::Variant& scenario = plan.scenarios.front();
  std::string call = "altiplan run " + study::report::shell(folder + "/tuned.yaml");
  if (!scenario.file.empty()) {
    call += " --scenario " + study::report::shell(scenario.file.string());
  }
  for (const std::string& set : scenario.set) {
    call += " --set " + study::report::shell(set);
  }
  return call;
}

void print_table(const tune::TunePlan& plan, const tune::Tuning& tuning,
                 const std::string& folder) {
  const tune::TuneSummary summary = tune::summary_of(plan, tuning);
  Table table({{plan.request.metric, false, 44},
               {"original", true, 14},
               {"tuned", true, 14},
               {"change", true, 10}});
  add_comparison(table, "tuning", summary.tuned_on);
  add_comparison(table, "held-out", summary.held_back);
  for (std::size_t p = 0; p < plan.parameters.size(); ++p) {
    const tune::TunedParameter& parameter = plan.parameters[p];
    const std::string before = parameter.shown();
    std::string now = before;
    if (tuning.best > 0) {
      const std::string& set = tuning.tuned().assignments[p];
      now = readable(std::stod(set.substr(set.find('=') + 1)), 6);
    }
    table.add({parameter.over.key, before, now, ""});
  }
  table.print(stdout);
  std::printf("  %s, %s failed, %s on the plateau of the best score\n",
              counted(summary.evaluations, "evaluation").c_str(),
              share_of(summary.failed, std::max<std::size_t>(1, summary.evaluations)).c_str(),
              share_of(summary.on_plateau, std::max<std::size_t>(1, summary.evaluations)).c_str());
  std::printf("  tuning scenarios: %s\n", summary.tuned_on.words.c_str());
  if (summary.held_back.scenarios > 0) {
    std::printf("  held-out scenarios: %s\n", summary.held_back.words.c_str());
  }
  if (tuning.best == 0) {
    std::printf("  no improvement over the original pipeline: tuned.yaml contains its values\n");
  }
  std::printf("  %s\n", repeating_call(plan, folder).c_str());
}

int tune(TuneArguments arguments) {
  const std::string folder = arguments.options.out.string();
  const tune::TunePlan plan = tune::plan_tuning(arguments.request);
  ProgressLine line;
  arguments.options.progress = [&](const tune::TuneProgress& progress) {
    line.show(line_of(progress));
  };
  const tune::Tuning tuning = tune::run_tuning(plan, arguments.options);
  line.clear();
  if (tuning.damaged_lines > 0) {
    warn(folder + "/runs.log: " + counted(tuning.damaged_lines, "line") +
         (tuning.damaged_lines == 1 ? " damaged: running its run again"
                                    : " damaged: running their runs again"));
  }
  if (tuning.is_interrupted) {
    std::printf("%s: interrupted after %s, %s now: repeat the command to continue\n",
                folder.c_str(), counted(tuning.evaluations.size() - 1, "evaluation").c_str(),
                counted(tuning.runs_done, "run").c_str());
    return kInterrupted;
  }
  tune::write_tuning(plan, tuning, arguments.options.out);
  std::printf("%s: %s in %s\n", folder.c_str(), counted(tuning.runs_done, "new run").c_str(),
              duration(tuning.elapsed_s).c_str());
  print_table(plan, tuning, folder);
  const auto& all = tuning.evaluations;
  if (std::all_of(all.begin(), all.end(), [](const auto& each) { return each.failed > 0; })) {
    warn("every evaluation failed: evaluations.csv lists the outcomes");
    return kNoRoute;
  }
  return kDone;
}

/// The message of the Error that reading an option's text throws; "" if it is valid.
template <class Read>
std::string problem_of(const Read& read) {
  try {
    read();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string metric_problem(const std::string& text) {
  return problem_of([&] { study::read_objective(text); });
}

void add_what(App& command, tune::TuneRequest& request) {
  command.add_option("pipeline", request.pipeline, "pipeline file to tune (YAML)")->required();
  command
      .add_option("--over KEY=RANGE", request.over,
                  "parameter of a step and its range: KEY=LO..HI, KEY=log:LO..HI, or "
                  "'KEY.{a,b}=simplex' for weights that sum to 1; repeatable")
      ->required()
      ->expected(1)
      ->take_all();
  command
      .add_option("--metric EXPRESSION", request.metric,
                  "metric to minimise: a value of a run, or an expression of values and numbers "
                  "with + - * / ( )")
      ->required()
      ->check(metric_problem);
  command
      .add_option("--scenarios FILE", request.scenarios,
                  "scenarios to tune on: files, or 'FILE[KEY=VALUES,…]' for each combination of "
                  "the values (default: the pipeline's scenario)")
      ->one_or_more()
      ->take_all();
  command
      .add_option("--hold-out FILE", request.hold_out,
                  "held-out scenarios, on which the tuned pipeline is compared with the original")
      ->one_or_more()
      ->take_all();
}

void add_how(App& command, tune::TuneRequest& request) {
  command.add_option("--tuner NAME", request.tuner, "tuner plugin (default pso)");
  command
      .add_option("--set-tuner KEY=VALUE", request.set_tuner, "parameter of the tuner; repeatable")
      ->expected(1)
      ->take_all()
      ->check(assignment_problem);
  command.add_option("--seed N", request.seed, "random seed of the tuner (default 0)")
      ->check(seed_problem);
  command
      .add_option("--evaluations", request.evaluations,
                  "maximum number of evaluations (default: the tuner's)")
      ->check(Check::between(1, 100000000));
  command
      .add_option("--penalty", request.penalty, "metric value of a failed run (default: infinity)")
      ->check(number_from(-1e300, 1e300));
  command.add_option("--wall-s", request.limits.wall_s, "time limit of a run (s, default 600)")
      ->check(number_from(0.001, 1e9));
  command
      .add_option("--memory-mb", request.limits.memory_mb,
                  "memory limit of a run (MB, default 4096)")
      ->check(number_from(1, 1e9));
}
}  // namespace

void add_tune(App& app, Action& action) {
  const auto prepare = [](TuneArguments& arguments) {
    const std::string over = problem_of([&] { tune::read_over(arguments.request.over); });
    if (!over.empty()) {
      throw UsageError{over};
    }
    arguments.request.plugin_path = arguments.overrides.plugin_path;
  };
  auto [command, arguments] = add_command<TuneArguments>(
      app, action, "tune", "optimise parameters of a pipeline with a tuner plugin; resumable", tune,
      prepare);
  add_what(command, arguments.request);
  add_how(command, arguments.request);
  command.add_option("-o,--out DIR", arguments.options.out, "results folder")->required();
  command.add_option("--jobs", arguments.options.jobs, "number of parallel runs (default 1)")
      ->check(Check::between(1, 1024));
  auto* fresh = command.add_flag("--fresh", arguments.options.fresh,
                                 "delete earlier tuning results in the folder first");
  command.add_flag("--resume", arguments.resume, "continue an interrupted tuning run (default)")
      ->excludes(fresh);
  add_plugin_path(command, arguments.overrides);
  set_example(command,
              "altiplan tune configs/pipelines/fusion_paper_astar_angles.yaml --out tuned --jobs 2 "
              "\\\n    --over 'steps.0.with.{weight_g,weight_h}=simplex' --metric length_m");
}
}  // namespace altiplan::cli
