// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/report/convergence.hpp"
#include "study/report/scenes.hpp"

namespace altiplan::study::report {

/// The input of a report.
struct Source {
  StudyData data;
  std::string study_text;  ///< the study's file
  ResultSource results;
  TraceSource traces = [](const RunRow&) { return std::string(); };
};

struct Options {
  std::string title;                  ///< "": the study's name
  std::string command;                ///< the command line
  bool times = true;                  ///< false: no values that vary between equal runs
  std::filesystem::path to_pdf = {};  ///< rsvg-convert, to write figures as PDF too; "" for none
  SceneOptions scenes;                ///< `times` of it follows the one above
  /// Called with what is done next: "building scene 3 of 48".
  std::function<void(const std::string&)> begins = [](const std::string&) {};
};

/// Loads stores of one study. Throws like load_study_data.
Source load_source(const std::vector<std::string>& stores);

/// A summary of the files written by write_report.
struct Written {
  std::size_t page_bytes = 0;
  std::size_t figures = 0;
  std::size_t scenes = 0;
  std::vector<std::string> notes;    ///< on scenes that could not be built
  std::vector<std::string> changed;  ///< sentences on changes since the runs were made
  std::string summary;
  std::vector<std::string> lacking;  ///< sentences on what the study has no runs of
};

/// Throws Error if the folder contains anything but an earlier report, or is not writable.
void expect_report_folder(const std::filesystem::path& folder);

/// Writes index.html, runs.csv, figures/ and tables/ (docs/report.md) into the folder, replacing
/// those of an earlier report. The same data give the same bytes. Throws Error if a figure cannot
/// be written as PDF.
Written write_report(const Source& source, const Options& options,
                     const std::filesystem::path& folder);
}  // namespace altiplan::study::report
