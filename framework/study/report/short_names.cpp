// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <optional>
#include <set>

#include "study/report/analysis.hpp"

namespace altiplan::study::report {
namespace {

/// A variant's name taken apart: "weighted", "weight_g,weight_h", "0.3,0.7".
struct Parts {
  std::string entry;
  std::string keys;
  std::string values;
};

/// Nothing if the name is not an entry with KEY=VALUE in brackets.
std::optional<Parts> parts_of(const StoredVariant& variant) {
  const std::string& name = variant.name;
  if (!name.starts_with(variant.of + "[") || !name.ends_with("]")) {
    return std::nullopt;
  }
  Parts parts;
  parts.entry = variant.of;
  std::string_view rest(name);
  rest.remove_prefix(variant.of.size() + 1);
  rest.remove_suffix(1);
  while (true) {
    const std::string_view part = rest.substr(0, rest.find(','));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) {
      return std::nullopt;  // a value that has a comma itself
    }
    const char* between = parts.keys.empty() ? "" : ",";
    parts.keys.append(between).append(part.substr(0, equals));
    parts.values.append(between).append(part.substr(equals + 1));
    if (part.size() == rest.size()) {
      return parts;
    }
    rest.remove_prefix(part.size() + 1);
  }
}

/// The keys of each entry whose variants all have the same ones.
std::map<std::string, std::string> common_keys(const StudyData& data) {
  std::map<std::string, std::string> keys;
  std::set<std::string> unlike;
  for (const StoredVariant& variant : data.pipelines) {
    const auto parts = parts_of(variant);
    const auto [known, is_new] = keys.try_emplace(variant.of, parts ? parts->keys : "");
    if (!parts || (!is_new && known->second != parts->keys)) {
      unlike.insert(variant.of);
    }
  }
  for (const std::string& entry : unlike) {
    keys.erase(entry);
  }
  return keys;
}
}  // namespace

std::vector<std::string> short_names(const StudyData& data) {
  const auto keys = common_keys(data);
  std::vector<std::string> names;
  std::set<std::string> different;
  for (const StoredVariant& variant : data.pipelines) {
    names.push_back(keys.count(variant.of) > 0 ? variant.of + "[" + parts_of(variant)->values + "]"
                                               : variant.name);
    different.insert(names.back());
  }
  if (different.size() < names.size()) {
    for (std::size_t at = 0; at < names.size(); ++at) {
      names[at] = data.pipelines[at].name;
    }
  }
  return names;
}

std::vector<std::string> short_name_keys(const StudyData& data) {
  std::vector<std::string> lines;
  for (const auto& [entry, keys] : common_keys(data)) {
    lines.push_back(entry + "[" + keys + "]");
  }
  return lines;
}
}  // namespace altiplan::study::report
