// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "study/model/study_file.hpp"

namespace altiplan::study {

/// Of the interval of a sample, so that of hundreds of figures hardly one differs by chance.
constexpr double kSampleConfidence = 0.999;

/// A figure that the documentation prints of a row.
struct PaperFigure {
  std::string name;  ///< "nodes, mean", "verdict"
  ClaimEntry claim;  ///< of the study; of a column only its quantity `that` counts
  bool of_claim = false;
  bool is_verdict = false;  ///< otherwise the quantity
  std::string paper;
  std::string documentation;
};

/// A row of a table of the documentation.
struct ReproducibleRow {
  std::string id;
  std::string what;
  std::string heading;
  std::string source;    ///< of the paper's figures
  std::size_t runs = 0;  ///< index into Paper::runs
  std::vector<PaperFigure> figures;
  std::set<std::string> pipelines;  ///< that the figures name
};

/// Runs of a study, before any selection.
struct PaperRuns {
  std::string id;
  std::filesystem::path study;  ///< absolute
  std::string scenarios;
  double quick = 1;
  std::size_t pairs = 0;                 ///< pairs (scenario, repetition)
  std::map<std::string, double> cpu_ms;  ///< of a run of each pipeline that a row names

  /// Number of pairs that are run.
  std::size_t pairs_run(bool quick) const;
};

/// The parts of 002_fusion_astar.yaml; without digits in front all is the name.
struct PaperName {
  std::string number;
  std::string name;

  std::string text() const { return number + (number.empty() ? "" : " ") + name; }
};
PaperName name_of(const std::filesystem::path& paper);

/// A paper file with its studies, read and checked.
struct Paper {
  std::filesystem::path path;  ///< absolute
  PaperName name;
  std::string title;
  std::string page;
  std::vector<PaperRuns> runs;
  std::vector<ReproducibleRow> rows;

  /// Processor time of the runs that these rows need (s), each run once; NaN where a time
  /// is not declared.
  double cpu_s(const std::vector<const ReproducibleRow*>& selected, bool quick) const;
  std::vector<const ReproducibleRow*> all_rows() const;
};

/// Throws ConfigError with every problem of the file, and of the studies that it names. Pipelines
/// and scenarios are checked when they are run.
Paper read_paper(const std::filesystem::path& file);

/// The papers installed with the program, by file name.
std::vector<std::filesystem::path> installed_papers();
/// The files of a word of the command line: a number ("002", "2"), a name, the path of a paper
/// file, or "all". Throws Error with the nearest name.
std::vector<std::filesystem::path> papers_named(const std::string& word);
/// The rows with these ids, in the order of the paper; all without ids. Throws Error likewise.
std::vector<const ReproducibleRow*> rows_named(const Paper& paper,
                                               const std::vector<std::string>& ids);
}  // namespace altiplan::study
