// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/report/analysis.hpp"

namespace altiplan::study::report {

/// Scenarios whose values share an axis.
struct Panel {
  std::string title;      ///< their names; "" if there is one panel
  std::vector<bool> has;  ///< one per scenario of the study
};

/// Panels of scenarios whose median values differ less than tenfold, from small ones on. Those of
/// one entry of the study, such as random worlds, stay together unless there is such a gap between
/// them.
std::vector<Panel> panels_of(const StudyData& data, const MetricAnalysis& metric);
}  // namespace altiplan::study::report
