// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "study/model/records.hpp"
#include "study/model/study_file.hpp"

namespace altiplan::study {

/// A run in a table, the input of statistics and figures.
struct RunRow : RunFacts {
  std::size_t store = 0;     ///< index into StudyData::stores; `id` is the run's in this store
  std::size_t scenario = 0;  ///< index into StudyData::scenarios
  std::size_t pipeline = 0;
  bool is_imported = false;  ///< from another program's database: it cannot be replayed
  /// One per StudyData::columns, to 12 significant digits; NaN if it does not apply.
  std::vector<double> values;

  bool solved() const { return outcome == "solved"; }
};

/// When a claim came into the study as it reads now.
struct ClaimStatement {
  std::string time;      ///< UTC, 2026-11-21T18:00:00Z; "" if it was not recorded
  std::size_t runs = 0;  ///< that were stored by then
  bool changed = false;  ///< it read otherwise before
};

/// All runs of a study in memory, from one store or several shards of it.
struct StudyData {
  StudyFile file;                                    ///< the study as written
  std::size_t planned = 0;                           ///< number of runs in the study; 0 if unknown
  std::map<std::string, ClaimStatement> statements;  ///< by the claim's id
  std::vector<std::string> stores;
  std::vector<StoredVariant> scenarios;
  std::vector<StoredVariant> pipelines;
  /// Of each pipeline its place among all that the study plans, by which it is coloured; empty: its
  /// index.
  std::vector<std::size_t> series;
  std::vector<StoredSession> sessions;
  std::vector<std::string> columns;  ///< names of values, sorted
  std::vector<RunRow> rows;          ///< sorted by scenario, pipeline, repetition; keys unique

  std::size_t series_of(std::size_t pipeline) const {
    return pipeline < series.size() ? series[pipeline] : pipeline;
  }
  /// Index of the column; columns.size() if there is none.
  std::size_t column(std::string_view name) const;
};

/// Times and memory, which vary between equal runs: names that end in time_s or memory_mb.
bool is_measured(std::string_view value);
/// One per pipeline: true if all repetitions of each scenario have the same outcome and values, but
/// for times and memory. Its planner draws no random numbers, and they are one run.
std::vector<bool> repeat_themselves(const StudyData& data);

/// True if lower is better; by the metric's name if the study does not specify it.
Better better(const StudyData& data, std::string_view metric);
/// The metrics that the report compares: those of the study file, or else length_m, plan_time_s
/// and expanded.
std::vector<std::string> compared_metrics(const StudyData& data);
}  // namespace altiplan::study
