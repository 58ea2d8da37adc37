// SPDX-License-Identifier: Apache-2.0
#include "tune/tune_report.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/base/output_file.hpp"
#include "study/figures/tables.hpp"
#include "study/figures/text.hpp"
#include "study/statistics/statistics.hpp"
#include "tune/tuned_file.hpp"

namespace altiplan::tune {
namespace fs = std::filesystem;
namespace {

using study::report::counted;
using study::report::exact;

/// The result of the paired test of the differences, now minus before, as the end of a sentence.
/// The test uses ranks, so a few large differences can put the mean on the other side.
std::string test_words(const std::vector<double>& differences, bool has_penalties) {
  const std::optional<study::Wilcoxon> test = study::wilcoxon(differences);
  if (!test) {
    return "no scenario differs";
  }
  const std::string p = std::string("Wilcoxon's signed-rank test") +
                        (has_penalties ? ", failures with the penalty: " : ": ") +
                        study::report::p_equals(test->p);
  if (!(test->p < 0.05)) {
    return p + ", no significant difference";
  }
  const bool is_better = test->rank_biserial < 0;
  const double change = study::mean(differences);
  const std::string verdict = p + ", the tuned pipeline is " + (is_better ? "better" : "worse");
  if (is_better ? change < 0 : change > 0) {
    return verdict;
  }
  return verdict + " by the ranks of the differences, but its mean is " +
         (change == 0 ? "the same"
          : is_better ? "worse"
                      : "better");
}

/// The test of the numbers of scenarios that only one of them solves.
std::string success_words(std::size_t only_before, std::size_t only_now) {
  const double p = study::mcnemar(std::int64_t(only_before), std::int64_t(only_now));
  return "McNemar's test of success: " + study::report::p_equals(p) +
         (!(p < 0.05)              ? ", no significant difference"
          : only_now > only_before ? ", the tuned pipeline solves more"
                                   : ", the tuned pipeline solves fewer");
}

TunedComparison compare(const TunePlan& plan, const Tuning& tuning, std::size_t from,
                        std::size_t to) {
  TunedComparison comparison;
  std::vector<double> before;
  std::vector<double> now;
  std::vector<double> differences;
  for (std::size_t s = from; s < to; ++s) {
    const ScoredRun& first = tuning.as_it_is().runs[s];
    const ScoredRun& second = tuning.tuned().runs[s];
    ++comparison.scenarios;
    comparison.failed_before += !first.value;
    comparison.failed_now += !second.value;
    comparison.only_before += first.value && !second.value;
    comparison.only_now += second.value && !first.value;
    // A failure counts as in the score; both failing is no difference.
    const std::optional<double> value_before = first.value ? first.value : plan.request.penalty;
    const std::optional<double> value_now = second.value ? second.value : plan.request.penalty;
    if (value_before && value_now) {
      before.push_back(*value_before);
      now.push_back(*value_now);
      differences.push_back(*value_now - *value_before);
      comparison.better += differences.back() < 0;
      comparison.worse += differences.back() > 0;
      comparison.equal += differences.back() == 0;
    }
  }
  comparison.mean_before = study::mean(before);
  comparison.mean_now = study::mean(now);
  if (comparison.scenarios == 0) {
    return comparison;
  }
  comparison.words = "better in " + std::to_string(comparison.better) + ", worse in " +
                     std::to_string(comparison.worse) + " and equal in " +
                     std::to_string(comparison.equal) + " of " +
                     counted(comparison.scenarios, "scenario");
  const bool has_failures = comparison.failed_before + comparison.failed_now > 0;
  if (has_failures) {
    comparison.words += " (original fails in " + std::to_string(comparison.failed_before) +
                        ", tuned in " + std::to_string(comparison.failed_now) + "); " +
                        success_words(comparison.only_before, comparison.only_now);
  }
  comparison.words += differences.empty()
                          ? ""
                          : "; " + test_words(differences, has_failures && plan.request.penalty);
  return comparison;
}

host::Json json_of(const TunedComparison& comparison) {
  const auto number = [](double value) {
    return std::isfinite(value) ? host::Json(value) : host::Json();
  };
  return {{"scenarios", comparison.scenarios},
          {"failed_as_it_is", comparison.failed_before},
          {"failed_tuned", comparison.failed_now},
          {"only_as_it_is", comparison.only_before},
          {"only_tuned", comparison.only_now},
          {"better", comparison.better},
          {"worse", comparison.worse},
          {"equal", comparison.equal},
          {"mean_as_it_is", number(comparison.mean_before)},
          {"mean_tuned", number(comparison.mean_now)},
          {"words", comparison.words}};
}

/// The part of an assignment after '='.
std::string value_of(const std::string& assignment) {
  return assignment.substr(assignment.find('=') + 1);
}

study::report::Grid evaluations_grid(const TunePlan& plan, const Tuning& tuning) {
  study::report::Grid grid{{"evaluation", "iteration"}, {}};
  for (const TunedParameter& parameter : plan.parameters) {
    grid.columns.push_back(parameter.over.key);
  }
  grid.columns.insert(grid.columns.end(), {"score", "failed_runs"});
  for (std::size_t s = 0; s < plan.tuned_on; ++s) {
    grid.columns.push_back(plan.scenarios[s].name);
  }
  grid.columns.push_back("first_failure");
  for (std::size_t i = 0; i < tuning.evaluations.size(); ++i) {
    const Evaluation& evaluation = tuning.evaluations[i];
    std::vector<std::string> row{std::to_string(i), std::to_string(evaluation.iteration)};
    for (std::size_t p = 0; p < plan.parameters.size(); ++p) {
      row.push_back(i == 0 ? plan.parameters[p].shown() : value_of(evaluation.assignments[p]));
    }
    row.push_back(std::isfinite(evaluation.score) ? exact(evaluation.score) : "inf");
    row.push_back(std::to_string(evaluation.failed));
    std::string failure;
    for (std::size_t s = 0; s < plan.tuned_on; ++s) {
      const ScoredRun& run = evaluation.runs[s];
      row.push_back(run.value ? exact(*run.value) : run.outcome);
      failure = !run.value && failure.empty() ? run.outcome + ": " + run.message : failure;
    }
    row.push_back(failure);
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

study::report::Grid held_back_grid(const TunePlan& plan, const Tuning& tuning) {
  study::report::Grid grid{{"scenario", "as_it_is", "tuned"}, {}};
  const auto cell = [](const ScoredRun& run) {
    return run.value ? exact(*run.value) : run.outcome;
  };
  for (std::size_t s = plan.tuned_on; s < plan.scenarios.size(); ++s) {
    grid.rows.push_back(
        {plan.scenarios[s].name, cell(tuning.as_it_is().runs[s]), cell(tuning.tuned().runs[s])});
  }
  return grid;
}

host::Json summary_json(const TunePlan& plan, const Tuning& tuning, const TuneSummary& summary) {
  const auto score = [](double value) {
    return std::isfinite(value) ? host::Json(value) : host::Json();
  };
  host::Json json = {{"altiplan", 1},
                     {"metric", plan.request.metric},
                     {"tuner", plan.request.tuner},
                     {"seed", plan.request.seed},
                     {"evaluations", summary.evaluations},
                     {"failed_evaluations", summary.failed},
                     {"evaluations_on_plateau", summary.on_plateau},
                     {"best_evaluation", tuning.best},
                     {"score_as_it_is", score(tuning.as_it_is().score)},
                     {"score_tuned", score(tuning.tuned().score)}};
  for (std::size_t p = 0; p < plan.parameters.size(); ++p) {
    const host::Json before = host::json_or_discarded(plan.parameters[p].as_it_is);
    json["parameters"][plan.parameters[p].over.key] = {
        {"as_it_is", before.is_discarded() ? host::Json() : before},
        {"tuned", tuning.best == 0 ? (before.is_discarded() ? host::Json() : before)
                                   : host::parse_json(value_of(tuning.tuned().assignments[p]))}};
  }
  json["tuned_on"] = json_of(summary.tuned_on);
  json["held_back"] = summary.held_back.scenarios > 0 ? json_of(summary.held_back) : host::Json();
  return json;
}

/// The header comment of the tuned pipeline.
std::string heading(const TunePlan& plan, const Tuning& tuning) {
  const std::string where = counted(plan.tuned_on, "scenario");
  return "# Tuned by altiplan tune from " + plan.config.pipeline_path.filename().string() + ": " +
         study::report::printable(plan.request.metric) + " = " + exact(tuning.tuned().score) +
         " over " + where + ", originally " +
         (std::isfinite(tuning.as_it_is().score) ? exact(tuning.as_it_is().score) : "a failure") +
         " (" + plan.request.tuner + ", seed " + std::to_string(plan.request.seed) + ", " +
         counted(tuning.evaluations.size() - 1, "evaluation") + ").\n";
}

std::string tuned_pipeline(const TunePlan& plan, const Tuning& tuning, const fs::path& folder) {
  return heading(plan, tuning) + tuned_text(plan.config, tuning.tuned().assignments, folder);
}
}  // namespace

TuneSummary summary_of(const TunePlan& plan, const Tuning& tuning) {
  TuneSummary summary;
  summary.tuned_on = compare(plan, tuning, 0, plan.tuned_on);
  summary.held_back = compare(plan, tuning, plan.tuned_on, plan.scenarios.size());
  summary.evaluations = tuning.evaluations.size() - 1;
  double min_score = kInfinity;
  for (std::size_t i = 1; i < tuning.evaluations.size(); ++i) {
    min_score = std::min(min_score, tuning.evaluations[i].score);
  }
  for (std::size_t i = 1; i < tuning.evaluations.size(); ++i) {
    const Evaluation& evaluation = tuning.evaluations[i];
    summary.failed += evaluation.failed > 0;
    summary.on_plateau +=
        std::isfinite(min_score) && evaluation.score <= min_score + 1e-9 * std::abs(min_score);
  }
  return summary;
}

void write_tuning(const TunePlan& plan, const Tuning& tuning, const fs::path& folder) {
  host::write_file(folder / "evaluations.csv",
                   study::report::csv_text(evaluations_grid(plan, tuning)));
  if (plan.scenarios.size() > plan.tuned_on) {
    host::write_file(folder / "held_back.csv",
                     study::report::csv_text(held_back_grid(plan, tuning)));
  }
  host::write_file(folder / "convergence.svg",
                   study::report::svg_text(convergence_figure(plan, tuning), false));
  host::write_file(folder / "summary.json",
                   host::file_text(summary_json(plan, tuning, summary_of(plan, tuning))));
  host::write_file(folder / "tuned.yaml", tuned_pipeline(plan, tuning, folder));
}
}  // namespace altiplan::tune
