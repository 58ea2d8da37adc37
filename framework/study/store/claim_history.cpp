// SPDX-License-Identifier: Apache-2.0
#include "study/store/claim_history.hpp"

#include "altiplan/error.hpp"
#include "host/base/json.hpp"
#include "study/store/load_study.hpp"

namespace altiplan::study {
namespace {
using host::Json;

/// {"id": ["that", "is", confidence], …}
Json json_of(const std::vector<ClaimEntry>& claims) {
  Json json = Json::object();
  for (const ClaimEntry& claim : claims) {
    json[claim.id] = {claim.that, claim.is, claim.confidence};
  }
  return json;
}

/// [{"time": …, "runs": …, "claims": …}, …], one for each change.
Json history_of(const Store& store) {
  const std::string text = store.study()["claims"];
  Json history = text.empty() ? Json::array() : host::json_or_discarded(text);
  bool is_whole = history.is_array();
  for (const Json& entry : history) {
    is_whole = is_whole && entry.is_object() && entry.value("time", Json()).is_string() &&
               entry.value("runs", Json()).is_number_unsigned() &&
               entry.value("claims", Json()).is_object();
  }
  if (!is_whole) {
    throw Error("'" + store.file().string() + "' is damaged: its claims are not a history");
  }
  return history;
}
}  // namespace

std::string claim_history(const Store& store, const StudyFile& file, const std::string& time) {
  Json history = history_of(store);
  if (history.empty() && !store.study().empty()) {  // of a former version
    history.push_back({{"time", ""}, {"runs", 0U}, {"claims", json_of(study_file(store).claims)}});
  }
  const Json now = json_of(file.claims);
  if (history.empty() || history.back().at("claims") != now) {
    history.push_back({{"time", time}, {"runs", store.keys().size()}, {"claims", now}});
  }
  return host::exact_json_text(history);
}

std::map<std::string, ClaimStatement> claim_statements(const Store& store) {
  const Json history = history_of(store);
  std::map<std::string, ClaimStatement> statements;
  Json before = Json::object();
  for (const Json& entry : history) {
    for (const auto& [id, claim] : entry.at("claims").items()) {
      if (before.contains(id) && before.at(id) == claim) {
        continue;
      }
      const bool is_known = statements.contains(id);
      statements[id] = {entry.at("time"), entry.at("runs"), is_known};
    }
    before = entry.at("claims");
  }
  return statements;
}
}  // namespace altiplan::study
