// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/page.hpp"

namespace altiplan::study::report {
namespace {

/// The runs of one pipeline in one scenario.
struct Tally {
  std::size_t runs = 0;
  std::size_t solved = 0;
  std::vector<double> values;  ///< of the metric, for solved runs that have it
};

/// For each scenario and pipeline.
std::vector<std::vector<Tally>> tallies_of(const StudyData& data, const std::string& metric) {
  const std::size_t column = data.column(metric);
  std::vector<std::vector<Tally>> tallies(data.scenarios.size(),
                                          std::vector<Tally>(data.pipelines.size()));
  for (const RunRow& row : data.rows) {
    Tally& tally = tallies[row.scenario][row.pipeline];
    ++tally.runs;
    tally.solved += row.solved();
    const bool has_value = row.solved() && column < data.columns.size();
    if (const double value = has_value ? row.values[column] : kNone; std::isfinite(value)) {
      tally.values.push_back(value);
    }
  }
  return tallies;
}

Cell solved_cell(const Tally& tally, std::size_t scenario, std::size_t pipeline) {
  if (tally.runs == 0) {
    return "–";
  }
  Cell cell(std::to_string(tally.solved) + "/" + std::to_string(tally.runs),
            double(tally.solved) / double(tally.runs));
  cell.open = "cell " + std::to_string(scenario) + " " + std::to_string(pipeline);
  cell.kind = tally.solved < tally.runs ? "lost" : "";
  return cell;
}
}  // namespace

Table scenario_table(const Content& content) {
  const StudyData& data = content.data;
  const bool has_metric = !content.analysis.metrics.empty();
  const std::string metric = has_metric ? content.analysis.metrics.front().metric : "";
  Table table{"scenarios",
              "Solved runs of each scenario" +
                  (has_metric ? ", and their median " + metric_label(metric) : std::string()),
              {{"scenario"}},
              {}};
  for (const std::string& pipeline : content.short_names) {
    table.columns.push_back({pipeline + ": solved", true});
    if (has_metric) {
      table.columns.push_back({pipeline + ": " + metric_label(metric), true});
    }
  }
  // The published cost of the best route is the same for all runs of a scenario.
  const std::size_t reference = data.column("reference");
  std::vector<double> references(data.scenarios.size(), kNone);
  for (const RunRow& row : data.rows) {
    if (reference < row.values.size()) {
      references[row.scenario] = row.values[reference];
    }
  }
  if (reference < data.columns.size()) {
    table.columns.push_back({"reference", true});
  }
  const auto tallies = tallies_of(data, metric);
  for (std::size_t s = 0; s < data.scenarios.size(); ++s) {
    std::vector<Cell> cells{data.scenarios[s].name};
    for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
      const Tally& tally = tallies[s][p];
      cells.push_back(solved_cell(tally, s, p));
      if (has_metric) {
        const double value = median(tally.values);
        cells.emplace_back(readable_value(metric, value), value);
      }
    }
    if (reference < data.columns.size()) {
      cells.emplace_back(readable(references[s]), references[s]);
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Grid run_grid(const Content& content) {
  const StudyData& data = content.data;
  Grid grid{{"scenario", "pipeline", "repetition", "seed", "outcome", "message", "key"}, {}};
  if (content.times) {
    grid.columns.insert(grid.columns.end(), {"store", "run", "place"});
  }
  grid.columns.insert(grid.columns.end(), data.columns.begin(), data.columns.end());
  for (const RunRow& row : data.rows) {
    std::vector<std::string> cells{data.scenarios[row.scenario].name,
                                   data.pipelines[row.pipeline].name,
                                   std::to_string(row.repetition),
                                   std::to_string(row.seed),
                                   row.outcome,
                                   row.message,
                                   row.key};
    if (content.times) {
      cells.push_back(data.stores.at(row.store));
      cells.push_back(std::to_string(row.id));
      cells.push_back(std::to_string(row.place));
    }
    for (const double value : row.values) {
      cells.push_back(exact(value));
    }
    grid.rows.push_back(std::move(cells));
  }
  return grid;
}
}  // namespace altiplan::study::report
