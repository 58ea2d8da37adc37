// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/claims/claims.hpp"
#include "study/figures/tables.hpp"
#include "study/report/analysis.hpp"
#include "study/report/figures.hpp"
#include "study/report/scenes.hpp"

namespace altiplan::study::report {

/// A group of runs with the same failure.
struct FailureGroup {
  std::size_t pipeline = 0;
  std::string outcome;
  std::string message;
  std::vector<std::size_t> rows;
};

/// The builds of the program and of the plugins that ran.
struct Builds {
  std::vector<std::string> versions;              ///< of altiplan
  std::vector<std::vector<std::string>> plugins;  ///< kind, name, build
};

/// The content of the report, independent of the output format.
struct Content {
  StudyData data;  ///< in_order, without what is absent
  Absent absent;
  std::vector<std::string> short_names;  ///< of its pipelines
  bool times = true;
  std::string title;
  std::string command;
  std::string study_text;
  Analysis analysis;
  std::vector<JudgedClaim> claims;
  std::vector<std::string> claims_left_out;  ///< sentences
  std::vector<FailureGroup> failures;
  std::vector<Figure> success_figures;
  std::vector<std::vector<Figure>> metric_figures;  ///< one list per metric of the analysis
  std::vector<Figure> trade_figures;                ///< one per trade of the analysis
  std::vector<Figure> effort_figures;
  std::vector<Convergence> convergence;
  std::vector<Figure> convergence_figures;  ///< of the first kMaxConvergence
  std::vector<Anytime> anytime;
  std::vector<Figure> anytime_figures;
  Builds builds;
  Scenes scenes;
};

// Tables.
Table failure_table(const Content& content);
Table claim_table(const Content& content);
Table success_table(const Content& content);
Table success_comparison_table(const Content& content);
Table metric_table(const Content& content);
/// The same over the pairs that all pipelines solved.
Table common_table(const Content& content);
/// PAR-2 and PAR-10, for a study with a time budget.
Table par_table(const Content& content);
Table comparison_table(const Content& content, const MetricAnalysis& metric);
/// The pipelines of a trade: those of the front, and what it loses without each.
Table pareto_table(const Content& content, const Trade& trade);
/// The iterations at which the searches of each pipeline came near to their final length.
Table convergence_table(const Content& content);
/// How long each pipeline takes to a first route, and to come near to the best known cost.
Table anytime_table(const Content& content);
/// One row per scenario: solved runs of each pipeline, and the median of the first metric.
Table scenario_table(const Content& content);
Table pipeline_table(const Content& content);
Table session_table(const Content& content);
Table build_table(const Content& content);
/// Every run, with all its values.
Grid run_grid(const Content& content);

/// "A study of 4 pipelines …", one sentence.
std::string summary(const Content& content);
/// Sentences on what the report lacks beside what it has, each once: pipelines, scenarios and
/// intervals.
std::vector<std::string> lacking(const Content& content);
/// "34 of 540 planned runs are stored (6 %): verdicts are preliminary.", "" if all are stored.
std::string incomplete(const StudyData& data);
/// Paragraphs on methods: tests, corrections, resamples, omissions.
std::vector<std::string> method_text(const Content& content);
/// The command that repeats a run.
std::string replay_command(const Content& content, const RunRow& row);

/// The data of all runs for the script, as JSON.
std::string page_data(const Content& content, const Table& scenarios);
/// index.html.
std::string page_text(const Content& content);

/// Number of convergence figures in the page.
inline constexpr std::size_t kMaxConvergence = 48;
/// Rows of the scenario table in the page; the script adds the others.
inline constexpr std::size_t kRowsShown = 50;
}  // namespace altiplan::study::report
