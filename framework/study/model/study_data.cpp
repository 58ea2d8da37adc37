// SPDX-License-Identifier: Apache-2.0
#include "study/model/study_data.hpp"

#include <algorithm>

namespace altiplan::study {

std::size_t StudyData::column(std::string_view name) const {
  const auto found = std::lower_bound(columns.begin(), columns.end(), name);
  return found != columns.end() && *found == name ? std::size_t(found - columns.begin())
                                                  : columns.size();
}

Better better(const StudyData& data, std::string_view metric) {
  for (const MetricChoice& choice : data.file.metrics) {
    if (choice.name == metric && choice.better) {
      return *choice.better == "higher" ? Better::higher : Better::lower;
    }
  }
  const std::string_view last = metric.substr(metric.rfind('.') + 1);
  const bool is_higher = last.starts_with("min_") || last == "reached" || last == "solved";
  return is_higher ? Better::higher : Better::lower;
}

std::vector<std::string> compared_metrics(const StudyData& data) {
  if (data.file.metrics.empty()) {
    return {"length_m", "plan_time_s", "expanded"};
  }
  std::vector<std::string> names;
  for (const MetricChoice& choice : data.file.metrics) {
    names.push_back(choice.name);
  }
  return names;
}
}  // namespace altiplan::study
