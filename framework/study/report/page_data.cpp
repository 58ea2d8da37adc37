// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "study/figures/text.hpp"
#include "study/report/page.hpp"

namespace altiplan::study::report {
namespace {

/// About 6 bytes each when packed.
constexpr std::size_t kMaxValues = 300'000;

/// Six digits: more than the page shows, and smaller than all digits.
std::string short_number(std::string_view metric, double value) {
  if (is_straight(metric, value)) {
    return "\"straight\"";
  }
  value = without_noise(metric, value);
  if (!std::isfinite(value)) {
    return "null";
  }
  return host::with_digits(value + 0.0, 6);
}

/// Unique texts, and the index of the text of each run.
class Texts {
 public:
  std::size_t operator()(const std::string& text) {
    const auto [found, is_new] = index_.try_emplace(text, all_.size());
    if (is_new) {
      all_.push_back(printable(text, true));
    }
    return found->second;
  }
  host::Json take() { return std::move(all_); }

 private:
  std::map<std::string, std::size_t> index_;
  host::Json all_ = host::Json::array();
};

host::Json names(const std::vector<StoredVariant>& variants) {
  host::Json all = host::Json::array();
  for (const StoredVariant& variant : variants) {
    all.push_back(printable(variant.name));
  }
  return all;
}

/// The columns in the page: all, or for many runs only the metrics of the whole run and those
/// compared.
std::vector<std::size_t> shown_columns(const Content& content) {
  const StudyData& data = content.data;
  const bool all = data.rows.size() * data.columns.size() <= kMaxValues;
  std::vector<std::size_t> shown;
  for (std::size_t at = 0; at < data.columns.size(); ++at) {
    const std::string& name = data.columns[at];
    const bool compared =
        std::any_of(content.analysis.metrics.begin(), content.analysis.metrics.end(),
                    [&](const MetricAnalysis& metric) { return metric.metric == name; });
    if (all || compared || name.find('.') == std::string::npos) {
      shown.push_back(at);
    }
  }
  return shown;
}

/// The values of each run as one text, which is smaller than numbers of JSON with 17 digits.
std::string values_json(const StudyData& data, const std::vector<std::size_t>& columns) {
  std::string text = "[";
  for (const RunRow& row : data.rows) {
    text += text.size() > 1 ? ",[" : "[";
    for (const std::size_t at : columns) {
      text += (at == columns.front() ? "" : ",") + short_number(data.columns[at], row.values[at]);
    }
    text += "]";
  }
  return text + "]";
}
}  // namespace

std::string page_data(const Content& content, const Table& scenarios) {
  const StudyData& data = content.data;
  host::Json json;
  json["pipelines"] = names(data.pipelines);
  json["scenarios"] = names(data.scenarios);
  json["series"] = data.series;
  json["columns"] = host::Json::array();
  const std::vector<std::size_t> columns = shown_columns(content);
  for (const std::size_t at : columns) {
    const std::string& name = data.columns[at];
    json["columns"].push_back({printable(name), metric_title(name), metric_unit(name)});
  }
  json["all_columns"] = columns.size() == data.columns.size();
  Texts outcomes;
  Texts messages;
  json["runs"] = host::Json::array();
  for (const RunRow& row : data.rows) {
    host::Json run{row.scenario,          row.pipeline,
                   row.repetition,        std::to_string(row.seed),
                   outcomes(row.outcome), messages(row.message)};
    if (content.times) {
      run.push_back(row.store);
      run.push_back(row.id);
    }
    json["runs"].push_back(std::move(run));
  }
  json["imported"] = host::Json::array();
  for (std::size_t at = 0; at < data.rows.size(); ++at) {
    if (data.rows[at].is_imported) {
      json["imported"].push_back(at);
    }
  }
  json["outcomes"] = outcomes.take();
  json["stores"] = host::Json::array({"DB"});  // independent of the number of stores
  if (content.times) {
    json["stores"] = host::Json::array();
    for (const std::string& store : data.stores) {
      json["stores"].push_back(printable(store));
    }
  }
  json["scenes"] = host::Json::array();
  for (const PackedScene& scene : content.scenes.scenes) {
    json["scenes"].push_back(scene.rows);
  }
  json["why_not"] = host::Json::array();
  for (const auto& [row, why] : content.scenes.why_not) {
    json["why_not"].push_back({row, messages(why)});
  }
  json["messages"] = messages.take();
  json["more_rows"] = host::Json::array();
  for (std::size_t at = kRowsShown; at < scenarios.rows.size(); ++at) {
    json["more_rows"].push_back(html_row(scenarios, at));
  }
  std::string text = host::json_text(json);
  text.back() = ',';
  return text + "\"values\":" + values_json(data, columns) + "}";
}
}  // namespace altiplan::study::report
