// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/reproduce/paper.hpp"
#include "study/run/study_run.hpp"

namespace altiplan::study {

/// How a figure of this machine compares with the documentation's.
enum class Mark {
  equal,    ///< to every digit of the documentation
  within,   ///< a sample: the documentation's figure lies in the sample's interval
  time,     ///< a time, which differs between machines
  too_few,  ///< a sample too small for an interval
  differs,
  none  ///< the documentation has no figure
};
const char* name(Mark mark);  ///< "equal", "within", "time", "too few", "DIFFERS", …

struct ReproducedFigure {
  const PaperFigure* figure = nullptr;
  std::string here;
  Mark mark = Mark::equal;
  std::string why;  ///< the interval of a sample, in words
};

struct ReproducedRow {
  const ReproducibleRow* row = nullptr;
  std::vector<ReproducedFigure> figures;
};

/// The rows that one entry of the paper's runs gives.
struct ReproducedRuns {
  const PaperRuns* runs = nullptr;
  std::size_t pairs = 0;  ///< run, of PaperRuns::pairs
  double cpu_s = 0;       ///< processor time of those that no earlier entry had
  std::string failures;   ///< runs that failed, crashed …, by outcome; "" without any
  std::vector<ReproducedRow> rows;
};

struct ReproduceOptions {
  bool quick = false;
  StudyOptions study;            ///< without `store`
  std::filesystem::path folder;  ///< of the databases, one for each study
  std::function<void(const PaperRuns&, const StudyProgress&)> progress;
  std::function<void(const ReproducedRuns&)> done;
};

/// Runs what these rows of the paper need and is not stored yet, and compares; false if
/// interrupted.
bool reproduce(const Paper& paper, const std::vector<const ReproducibleRow*>& rows,
               const ReproduceOptions& options);

/// The figure from the runs in `data`; `is_sample`: these are a part of the documented runs.
ReproducedFigure compare_figure(const StudyData& data, const PaperFigure& figure, bool is_sample);
}  // namespace altiplan::study
