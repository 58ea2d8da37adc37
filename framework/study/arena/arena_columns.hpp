// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/model/study_data.hpp"

namespace altiplan::study {

/// Column names that SQL and Planner Arena accept: lower-case letters, digits and underscores,
/// unique over all tables that Planner Arena joins, with underscores read as blanks.
class ColumnNames {
 public:
  /// Reserves the columns that every such database has.
  ColumnNames();
  /// "flight.min_separation_m" gives "flight_min_separation_m"; a name already in use gets a
  /// number.
  std::string add(std::string_view name);

 private:
  std::vector<std::string> taken_;
};

/// A column of the table of runs: OMPL's if it means the same, otherwise a value of ours.
struct ArenaColumn {
  std::string name;
  const char* type;       ///< as OMPL declares it
  std::size_t value = 0;  ///< index into StudyData::columns; columns.size() if no run has it
};
/// The value of runs that a column of OMPL's has, or the column's own name.
std::string value_of_column(const std::string& column);
/// OMPL's first, then all other values of the study.
std::vector<ArenaColumn> arena_columns(const StudyData& data, ColumnNames& names);

/// A parameter that distinguishes the scenarios of one file: Planner Arena groups and filters by
/// it.
struct ArenaParameter {
  std::string key;  ///< "scenario.environment.0.city.seed"
  std::string column;
  bool numbers = true;  ///< true if its value is a number in every scenario
};

struct ArenaExperiment {
  std::string name;                     ///< the file's if parameters distinguish its variants
  std::vector<std::string> parameters;  ///< one per ArenaParameter, "" if not set
};

struct ArenaExperiments {
  std::vector<ArenaParameter> parameters;
  std::vector<ArenaExperiment> experiments;  ///< one per scenario of the study
};
ArenaExperiments arena_experiments(const StudyData& data, ColumnNames& names);

/// The outcome as a value of OMPL's status.
int arena_status(std::string_view outcome);

struct ArenaStatus {
  int value;
  const char* outcome;
  const char* description;
};
/// OMPL's number and description if it has them, otherwise ours, numbered from 16.
const std::vector<ArenaStatus>& arena_statuses();
}  // namespace altiplan::study
