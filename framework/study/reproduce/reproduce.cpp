// SPDX-License-Identifier: Apache-2.0
#include "study/reproduce/reproduce.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "host/base/words.hpp"
#include "study/report/analysis.hpp"
#include "study/store/load_study.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

/// A process loads the plugins once for so many runs.
constexpr int kReuse = 20;

fs::path store_of(const fs::path& folder, const PaperRuns& runs) {
  return folder / (runs.study.stem().string() + ".db");
}

/// The study's data of the planned runs alone, in the order of reports.
StudyData data_of(const fs::path& store, const StudyPlan& plan) {
  std::set<std::string> keys;
  for (const PlannedRun& run : plan.runs) {
    keys.insert(run.key);
  }
  StudyData data = load_study_data({store.string()});
  std::erase_if(data.rows, [&](const RunRow& row) { return !keys.contains(row.key); });
  return report::in_order(std::move(data), true);
}

/// "2 crashed, 1 failed"
std::string failures_of(const StudyData& data) {
  std::map<std::string, std::size_t> counts;
  for (const RunRow& row : data.rows) {
    if (report::unexplained(row.outcome)) {
      ++counts[report::outcome_text(row.outcome)];
    }
  }
  std::string text;
  for (const auto& [outcome, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + outcome;
  }
  return text;
}

/// Of the runs that are not counted yet; others of the paper's runs may have shared them.
double cpu_s_of(const StudyData& data, std::set<std::string>& counted) {
  const std::size_t column = data.column("cpu_time_s");
  double sum = 0;
  for (const RunRow& row : data.rows) {
    sum += counted.insert(row.key).second ? row.values[column] : 0;
  }
  return sum;
}

std::size_t pairs_in(const StudyPlan& plan) {
  std::set<std::pair<std::size_t, int>> pairs;
  for (const PlannedRun& run : plan.runs) {
    pairs.insert({run.scenario, run.repetition});
  }
  return pairs.size();
}
}  // namespace

bool reproduce(const Paper& paper, const std::vector<const ReproducibleRow*>& rows,
               const ReproduceOptions& options) {
  std::set<std::string> counted;
  for (std::size_t i = 0; i < paper.runs.size(); ++i) {
    const PaperRuns& runs = paper.runs[i];
    StudySelection selection;
    ReproducedRuns result;
    result.runs = &runs;
    for (const ReproducibleRow* row : rows) {
      if (row->runs == i) {
        selection.pipelines.insert(row->pipelines.begin(), row->pipelines.end());
        result.rows.push_back({row, {}});
      }
    }
    if (result.rows.empty()) {
      continue;
    }
    selection.scenarios = runs.scenarios;
    if (options.quick && runs.quick < 1) {
      selection.sample = runs.quick;
    }
    options.progress(runs, {});  // a study of thousands of worlds takes seconds to read
    const StudyPlan plan = load_study(runs.study, selection, options.study.plugin_path);
    StudyOptions study = options.study;
    study.store = store_of(options.folder, runs);
    study.reuse = kReuse;
    study.progress = [&](const StudyProgress& progress) { options.progress(runs, progress); };
    if (run_study(plan, study).is_interrupted) {
      return false;
    }
    const StudyData data = data_of(study.store, plan);
    result.pairs = pairs_in(plan);
    result.cpu_s = cpu_s_of(data, counted);
    result.failures = failures_of(data);
    for (ReproducedRow& row : result.rows) {
      for (const PaperFigure& figure : row.row->figures) {
        row.figures.push_back(compare_figure(data, figure, result.pairs < runs.pairs));
      }
    }
    options.done(result);
  }
  return true;
}
}  // namespace altiplan::study
