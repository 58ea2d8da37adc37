// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/params.hpp"

namespace altiplan::study {

// A paper file as written: what a paper and our documentation print, and the study that gives each
// figure. Field for field, nothing resolved yet.

/// Runs of a study that tables take their figures from.
struct RunsChoice {
  std::string id;
  Path study;
  std::string scenarios;  ///< id of an entry of the study; "": all
  double quick = 1;       ///< share of the pairs (scenario, repetition) that --quick runs
  Value cpu_ms;           ///< by pipeline
  void describe(Fields& f);
};

struct PaperColumn {
  std::string name;
  std::string of;  ///< "median(ROW.length_m / 1000)"
  void describe(Fields& f);
};

struct PaperRow {
  std::string id;
  std::string what;
  std::string row;  ///< replaces ROW; default: the id
  std::vector<std::string> paper;
  std::optional<std::vector<std::string>> documentation;
  void describe(Fields& f);
};

/// A row whose figures are the verdict of a claim of the study, and its estimate.
struct PaperClaim {
  std::string id;
  std::string claim;  ///< default: the id
  std::string what;
  std::string paper;
  std::string verdict;
  std::string measured;
  void describe(Fields& f);
};

struct PaperTable {
  std::string heading;
  std::string source;
  std::string runs;
  std::vector<PaperColumn> columns;
  std::vector<PaperRow> rows;
  std::vector<PaperClaim> claims;
  void describe(Fields& f);
};

struct PaperFile {
  int altiplan = 0;
  std::optional<std::string> title;
  std::optional<std::string> page;
  std::vector<RunsChoice> runs;
  std::vector<PaperTable> tables;
  void describe(Fields& f);
};
}  // namespace altiplan::study
