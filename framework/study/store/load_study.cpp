// SPDX-License-Identifier: Apache-2.0
#include "study/store/load_study.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "altiplan/error.hpp"
#include "host/config/yaml.hpp"
#include "study/statistics/statistics.hpp"
#include "study/store/claim_history.hpp"

namespace altiplan::study {
namespace {

/// Index of each name in `all`; missing names are appended.
std::map<std::string, std::size_t> gather(std::vector<StoredVariant>& all,
                                          const std::vector<StoredVariant>& more) {
  for (const StoredVariant& variant : more) {
    const bool is_known = std::any_of(all.begin(), all.end(), [&](const StoredVariant& known) {
      return known.name == variant.name;
    });
    if (!is_known) {
      all.push_back(variant);
    }
  }
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < all.size(); ++i) {
    index[all[i].name] = i;
  }
  return index;
}

RunRow row_of(const StoredRun& run, std::size_t store, const std::vector<std::string>& columns) {
  RunRow row;
  static_cast<RunFacts&>(row) = run;
  row.store = store;
  row.values.assign(columns.size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& [name, value] : run.values) {  // both are sorted
    row.values[std::size_t(std::lower_bound(columns.begin(), columns.end(), name) -
                           columns.begin())] = in_12_digits(value);
  }
  return row;
}
}  // namespace

StudyFile study_file(const Store& store) {
  std::map<std::string, std::string> study = store.study();
  const std::string name = "'" + store.file().string() + "'";
  if (study.empty()) {
    throw Error(name + " contains no study yet");
  }
  if (study["text"].empty()) {
    throw Error(name + " is damaged: the text of its study is missing");
  }
  StudyFile file;
  try {
    const Value tree = host::parse_yaml(study["text"], study["path"]);
    if (const ParamReport report = bind(file, &tree); !report.problems.empty()) {
      throw ConfigError(report.problems);
    }
  } catch (const ConfigError& error) {
    throw Error("the study in " + name + ": " + error.problems().front().text());
  }
  return file;
}

StudyData load_study_data(const std::vector<std::string>& stores) {
  StudyData data;
  data.stores = stores;
  std::vector<std::vector<StoredRun>> runs;
  std::set<std::string> columns;
  std::string text;
  for (const std::string& name : stores) {
    const Store store(name, StoreMode::read);
    std::map<std::string, std::string> study = store.study();
    if (runs.empty()) {
      text = study["text"];
      data.file = study_file(store);
      const std::string& planned = study["planned"];
      std::from_chars(planned.data(), planned.data() + planned.size(), data.planned);
    } else if (study["text"] != text) {
      throw Error("'" + name + "' belongs to another study than '" + stores.front() +
                  "': their study files differ");
    }
    for (const auto& [id, statement] : claim_statements(store)) {
      ClaimStatement& latest = data.statements.try_emplace(id, statement).first->second;
      if (latest.runs < statement.runs) {
        latest = statement;
      }
    }
    gather(data.scenarios, store.scenarios());
    gather(data.pipelines, store.pipelines());
    for (const StoredSession& session : store.sessions()) {
      data.sessions.push_back(session);
    }
    runs.push_back(store.runs());
    for (const StoredRun& run : runs.back()) {
      for (const auto& [column, value] : run.values) {
        columns.insert(column);
      }
    }
  }
  data.columns.assign(columns.begin(), columns.end());
  const auto scenario = gather(data.scenarios, {});
  const auto pipeline = gather(data.pipelines, {});
  std::set<std::string> keys;
  for (std::size_t s = 0; s < runs.size(); ++s) {
    for (const StoredRun& run : runs[s]) {
      if (keys.insert(run.key).second) {
        data.rows.push_back(row_of(run, s, data.columns));
        data.rows.back().scenario = scenario.at(run.scenario);
        data.rows.back().pipeline = pipeline.at(run.pipeline);
      }
    }
  }
  std::sort(data.rows.begin(), data.rows.end(), [](const RunRow& a, const RunRow& b) {
    return std::tie(a.scenario, a.pipeline, a.repetition, a.key) <
           std::tie(b.scenario, b.pipeline, b.repetition, b.key);
  });
  return data;
}
}  // namespace altiplan::study
