// SPDX-License-Identifier: Apache-2.0
#include "study/model/study_data.hpp"

#include <algorithm>
#include <cmath>

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

bool is_measured(std::string_view value) {
  const bool is_flying_time = value == "time_s" || value == "flight.time_s";
  return (value.ends_with("time_s") && !is_flying_time) || value.ends_with("first_route_s") ||
         value.ends_with("memory_mb");
}

std::vector<bool> repeat_themselves(const StudyData& data) {
  std::vector<std::size_t> compared;
  for (std::size_t at = 0; at < data.columns.size(); ++at) {
    if (!is_measured(data.columns[at])) {
      compared.push_back(at);
    }
  }
  const auto are_equal = [&](const RunRow& a, const RunRow& b) {
    return a.outcome == b.outcome &&
           std::all_of(compared.begin(), compared.end(), [&](std::size_t at) {
             return a.values[at] == b.values[at] ||
                    (std::isnan(a.values[at]) && std::isnan(b.values[at]));
           });
  };
  std::vector<bool> repeat(data.pipelines.size(), true);
  std::map<std::pair<std::size_t, std::size_t>, const RunRow*> first;  // scenario, pipeline
  for (const RunRow& row : data.rows) {
    const RunRow* before = first.try_emplace({row.scenario, row.pipeline}, &row).first->second;
    repeat[row.pipeline] = repeat[row.pipeline] && are_equal(*before, row);
  }
  return repeat;
}
}  // namespace altiplan::study
