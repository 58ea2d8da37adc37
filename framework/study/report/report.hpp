// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/report/convergence.hpp"
#include "study/report/scenes.hpp"

namespace altiplan::study::report {

/// What a report is made of.
struct Source {
  StudyData data;
  std::string study_text;  ///< the study's file
  ResultSource results;
  TraceSource traces = [](const RunRow&) { return std::string(); };
};

struct Options {
  std::string title;    ///< "": the study's name
  std::string command;  ///< as it was called
  bool times = true;    ///< false: nothing that differs from run to run
  SceneOptions scenes;  ///< `times` of it follows the one above
};

/// From stores of one study. Throws as load_study_data.
Source load_source(const std::vector<std::string>& stores);

/// What write_report says of what it wrote.
struct Written {
  std::size_t page_bytes = 0;
  std::size_t figures = 0;
  std::size_t scenes = 0;
  std::vector<std::string> notes;    ///< on scenes that could not be made
  std::vector<std::string> changed;  ///< sentences: what is not as it was when the runs were made
  std::string summary;
};

/// Throws Error where the folder holds anything but an earlier report, or cannot be written.
void expect_report_folder(const std::filesystem::path& folder);

/// Writes index.html, runs.csv, figures/ and tables/ (docs/reference/report.md) into the folder, in
/// place of those of an earlier report. The same data give the same bytes.
Written write_report(const Source& source, const Options& options,
                     const std::filesystem::path& folder);
}  // namespace altiplan::study::report
