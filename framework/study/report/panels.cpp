// SPDX-License-Identifier: Apache-2.0
#include "study/report/panels.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "study/figures/text.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kScale = 10;
constexpr std::size_t kMaxTitle = 48;  // characters

/// Scenarios of one entry, and the medians of their absolute values.
struct Group {
  std::vector<std::size_t> scenarios;
  std::vector<double> medians;  ///< ascending
  bool is_whole_entry = true;

  double size() const { return median(medians); }
};

/// True if values of the second size would make those of the first, a smaller one, look alike.
bool is_beyond(double small, double large) { return small > 0 && large >= kScale * small; }

std::map<std::size_t, std::vector<double>> sizes_of(const StudyData& data,
                                                    const MetricAnalysis& metric) {
  std::map<std::size_t, std::vector<double>> sizes;
  for (const Sample& sample : metric.samples) {
    for (std::size_t at = 0; at < sample.values.size(); ++at) {
      sizes[data.rows[sample.rows[at]].scenario].push_back(
          std::abs(without_noise(metric.metric, sample.values[at])));
    }
  }
  return sizes;
}

/// Each entry's scenarios by size, cut where there is a gap.
std::vector<Group> groups_of(const StudyData& data, const MetricAnalysis& metric) {
  std::map<std::string, std::vector<std::pair<double, std::size_t>>> entries;
  for (const auto& [scenario, values] : sizes_of(data, metric)) {
    entries[data.scenarios[scenario].of].emplace_back(median(values), scenario);
  }
  std::vector<Group> groups;
  for (auto& [of, scenarios] : entries) {
    std::sort(scenarios.begin(), scenarios.end());
    const std::size_t first = groups.size();
    for (const auto& [size, scenario] : scenarios) {
      if (groups.size() == first || is_beyond(groups.back().medians.back(), size)) {
        groups.emplace_back();
      }
      groups.back().scenarios.push_back(scenario);
      groups.back().medians.push_back(size);
    }
    for (std::size_t at = first; at < groups.size(); ++at) {
      groups[at].is_whole_entry = groups.size() == first + 1;
    }
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.size() < b.size(); });
  return groups;
}

/// "city, ridge", "city and 4 more".
std::string title_of(const StudyData& data, const std::vector<Group>& groups) {
  std::vector<std::string> names;
  for (const Group& group : groups) {
    if (group.is_whole_entry) {
      names.push_back(data.scenarios[group.scenarios.front()].of);
      continue;
    }
    for (const std::size_t scenario : group.scenarios) {
      names.push_back(data.scenarios[scenario].name);
    }
  }
  std::sort(names.begin(), names.end(), natural_less);
  std::string title;
  for (std::size_t at = 0; at < names.size(); ++at) {
    const std::string next = (at > 0 ? ", " : "") + printable(names[at]);
    const std::string more = " and " + std::to_string(names.size() - at) + " more";
    if (at > 0 && characters(title) + characters(next) + characters(more) > kMaxTitle) {
      return title + more;
    }
    title += next;
  }
  return shortened(title, kMaxTitle);
}
}  // namespace

std::vector<Panel> panels_of(const StudyData& data, const MetricAnalysis& metric) {
  std::vector<std::vector<Group>> shared;
  for (Group& group : groups_of(data, metric)) {
    if (shared.empty() || is_beyond(shared.back().front().size(), group.size())) {
      shared.emplace_back();
    }
    shared.back().push_back(std::move(group));
  }
  std::vector<Panel> panels;
  for (const std::vector<Group>& groups : shared) {
    Panel panel{shared.size() > 1 ? title_of(data, groups) : "",
                std::vector<bool>(data.scenarios.size(), false)};
    for (const Group& group : groups) {
      for (const std::size_t scenario : group.scenarios) {
        panel.has[scenario] = true;
      }
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}
}  // namespace altiplan::study::report
