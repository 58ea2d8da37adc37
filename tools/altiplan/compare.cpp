// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "host/base/words.hpp"
#include "progress.hpp"
#include "study/compare/compare.hpp"
#include "study/compare/origin.hpp"
#include "study/store/load_study.hpp"
#include "table.hpp"

namespace altiplan::cli {
namespace {

struct CompareArguments {
  std::string first;
  std::string second;
  std::vector<std::string> metrics;
  double tolerance_percent = 5;
  bool gate = false;
};

constexpr std::size_t kShown = 20;

std::string number(double value) {
  if (!std::isfinite(value)) {
    return "-";
  }
  char text[64];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// With all digits, so that different numbers never print alike.
std::string exact(double value) { return host::exact_json_text(value); }

const char* name(study::MetricChange::Verdict verdict) {
  constexpr const char* kNames[] = {"same",  "within tolerance", "better",
                                    "WORSE", "unclear",          "no data"};
  return kNames[std::size_t(verdict)];
}

void print_more(std::size_t all) {
  if (all > kShown) {
    std::printf("  … and %zu more\n", all - kShown);
  }
}

void print_outcomes(const char* title, const std::vector<study::OutcomeChange>& changes) {
  if (changes.empty()) {
    return;
  }
  std::printf("%s: %zu\n", title, changes.size());
  for (std::size_t n = 0; n < std::min(changes.size(), kShown); ++n) {
    const study::OutcomeChange& change = changes[n];
    const bool has_reason = change.after != "solved" && !change.message.empty();
    std::printf("  %s: %s, then %s%s%s\n", change.run.c_str(), change.before.c_str(),
                change.after.c_str(), has_reason ? ": " : "",
                has_reason ? change.message.c_str() : "");
  }
  print_more(changes.size());
}

void print_values(const std::vector<study::ValueChange>& changes) {
  if (changes.empty()) {
    return;
  }
  std::printf("different values of metrics that do not depend on time: %zu\n", changes.size());
  for (std::size_t n = 0; n < std::min(changes.size(), kShown); ++n) {
    const study::ValueChange& change = changes[n];
    std::printf("  %s: %s was %s and is %s\n", change.run.c_str(), change.metric.c_str(),
                exact(change.before).c_str(), exact(change.after).c_str());
  }
  print_more(changes.size());
}

std::string change_text(const study::MetricChange& change) {
  if (change.pairs == 0) {
    return "-";
  }
  std::string text = (change.is_ratio            ? "x "
                      : change.effect.median < 0 ? ""
                                                 : "+") +
                     number(change.effect.median);
  if (change.effect.interval) {
    text += " [" + number(change.effect.interval->low) + ", " +
            number(change.effect.interval->high) + "]";
  }
  return text;
}

std::string verdict_text(const study::MetricChange& change) {
  const bool has_reason =
      change.verdict == study::MetricChange::Verdict::unclear && !change.why_no_interval.empty();
  return name(change.verdict) + (has_reason ? ", " + change.why_no_interval : std::string());
}

void print_metrics(const std::vector<study::MetricChange>& changes) {
  Table table({{"pipeline"},
               {"metric"},
               {"pairs", true, 6},
               {"first", true, 12},
               {"second", true, 12},
               {"second vs. first [95 % CI]"},
               {"n", true, 14},
               {"p (Holm)", true, 9},
               {"verdict"}},
              0, 2);
  for (const study::MetricChange& change : changes) {
    table.add({change.pipeline, change.metric, std::to_string(change.pairs), number(change.before),
               number(change.after), change_text(change),
               change.pairs > 0 ? change.effect.units.words() : "-", number(change.p),
               Table::Cell(verdict_text(change), color_of(name(change.verdict)))});
  }
  table.print(stdout);
}

/// Reads results out of a store.
study::ResultOf results_of(const std::string& file) {
  auto store = std::make_shared<study::Store>(file, study::StoreMode::read);
  return [store](const study::RunRow& row) {
    const auto run = store->run(row.id);
    return run ? run->result : std::string();
  };
}

void print_origins(const study::Comparison& comparison, const study::StudyData& first,
                   const study::StudyData& second, const CompareArguments& arguments) {
  if (comparison.other_origins.empty()) {
    return;
  }
  std::vector<std::string> changed = study::changed_origins(
      comparison, first, second, results_of(arguments.first), results_of(arguments.second));
  if (changed.empty()) {
    changed.emplace_back(
        "no file, setting or plugin in the results differs: a different build of the program");
  }
  std::printf("inputs differ: %zu pairs\n", comparison.other_origins.size());
  for (std::size_t n = 0; n < std::min(changed.size(), kShown); ++n) {
    std::printf("  %s\n", changed[n].c_str());
  }
  print_more(changed.size());
}

/// "newly failing: astar city #0; beyond the tolerance: length_m of astar"
std::string what_is_worse(const study::Comparison& comparison) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> runs;
  std::vector<std::string> metrics;
  for (const study::OutcomeChange& change : comparison.lost) {
    runs.push_back(change.run);
  }
  for (const study::MetricChange& change : comparison.metrics) {
    if (change.verdict == study::MetricChange::Verdict::worse) {
      metrics.push_back(change.metric + " of " + change.pipeline);
    }
  }
  std::string words = runs.empty() ? "" : "newly failing: " + host::listed(runs, kNamed);
  if (!metrics.empty()) {
    words +=
        (runs.empty() ? "" : "; ") + ("beyond the tolerance: " + host::listed(metrics, kNamed));
  }
  return words;
}

/// Prints the last line; true if the gate passes.
bool print_verdict(const study::Comparison& comparison) {
  const std::size_t missing = comparison.only_first + comparison.other_seeds;
  std::string words = comparison.is_worse() ? "the second is worse: " + what_is_worse(comparison)
                                            : "nothing is worse";
  words += comparison.differs_in_times_only() ? "; only times or memory differ" : "";
  if (missing > 0) {
    words += "; " + std::to_string(missing) + (missing == 1 ? " run" : " runs") +
             " of the first cannot be compared: the second has no run of that name and seed";
  }
  const Color color = comparison.is_worse() ? Color::bad : Color::good;
  std::printf("%s\n", painted(stdout, color, words).c_str());
  return !comparison.is_worse() && comparison.is_whole();
}

int compare(const CompareArguments& arguments) {
  std::optional<Activity> activity("reading the databases");
  const study::StudyData first = study::load_study_data({arguments.first});
  const study::StudyData second = study::load_study_data({arguments.second});
  activity->begin("comparing");
  const study::Comparison comparison =
      study::compare_studies(first, second, {arguments.metrics, arguments.tolerance_percent / 100});
  activity.reset();
  std::printf("%zu pairs of runs; %zu runs only in the first, %zu only in the second\n",
              comparison.pairs, comparison.only_first, comparison.only_second);
  if (comparison.other_seeds > 0) {
    std::printf("%zu runs have different seeds and are skipped\n", comparison.other_seeds);
  }
  print_origins(comparison, first, second, arguments);
  print_outcomes("newly failing", comparison.lost);
  print_outcomes("newly solved", comparison.won);
  print_outcomes("unsolved for another reason", comparison.others);
  print_values(comparison.differing);
  print_metrics(comparison.metrics);
  const bool passes = print_verdict(comparison);
  return arguments.gate && !passes ? kNoRoute : kDone;
}
}  // namespace

void add_compare(App& app, Action& action) {
  auto [command, arguments] = add_command<CompareArguments>(
      app, action, "compare", "compare the results of two executions of a study", compare);
  command.add_option("first DB", arguments.first, "reference study database")->required();
  command.add_option("second DB", arguments.second, "new study database")->required();
  command
      .add_option("--metric", arguments.metrics,
                  "metric to compare; repeatable (default: the study's metrics)")
      ->expected(1)
      ->take_all();
  command
      .add_option("--tolerance P", arguments.tolerance_percent,
                  "allowed degradation of a metric (%)")
      ->check(number_from(0, 1000))
      ->capture_default_str();
  command.add_flag("--gate", arguments.gate,
                   "exit with code 1 if a run newly fails, a metric is worse, or a run of the "
                   "first database cannot be compared");
  set_example(command, "altiplan compare before.db after.db --gate");
}
}  // namespace altiplan::cli
