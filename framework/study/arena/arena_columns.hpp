// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/model/study_data.hpp"

namespace altiplan::study {

/// Names of columns as SQL and Planner Arena can take them: small letters, digits and underscores,
/// and no two alike, with underscores read as blanks, over all tables that Planner Arena joins.
class ColumnNames {
 public:
  /// With the columns that every such database has.
  ColumnNames();
  /// "flight.min_separation_m" gives "flight_min_separation_m"; a name that is taken already gets a
  /// number.
  std::string add(std::string_view name);

 private:
  std::vector<std::string> taken_;
};

/// A column of the table of runs: one of OMPL's where it means the same, or a value of ours.
struct ArenaColumn {
  std::string name;
  const char* type;       ///< as OMPL declares it
  std::size_t value = 0;  ///< index into StudyData::columns; their number where no run has it
};
/// OMPL's first, then all other values of the study.
std::vector<ArenaColumn> arena_columns(const StudyData& data, ColumnNames& names);

/// What sets a scenario apart from others of one file: Planner Arena groups and filters by it.
struct ArenaParameter {
  std::string key;  ///< "scenario.environment.0.city.seed"
  std::string column;
  bool numbers = true;  ///< whether every scenario has a number there
};

struct ArenaExperiment {
  std::string name;  ///< that of the file where parameters tell its variants apart
  std::vector<std::string> parameters;  ///< one per ArenaParameter, "" where it is not set
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
/// OMPL's number and words where it has them, else ours from 16.
const std::vector<ArenaStatus>& arena_statuses();
}  // namespace altiplan::study
