// SPDX-License-Identifier: Apache-2.0
#include "host/result/difference.hpp"

#include <algorithm>

namespace altiplan::host {
namespace {

std::string shown(const Json& value) {
  constexpr std::size_t kLongest = 80;
  std::string text = json_text(value);
  if (text.size() > kLongest) {
    text.resize(text.find_last_of(" ,", kLongest) == text.npos ? kLongest
                                                               : text.find_last_of(" ,", kLongest));
    text += " …";
  }
  return text;
}

std::string below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// Wall times; `time_s` among metrics is that of a flight.
bool varies(const std::string& path, const std::string& key) {
  return (key.ends_with("time_s") && !(key == "time_s" && path.ends_with("metrics"))) ||
         key == "first_route_s" || (path.empty() && (key == "trace" || key == "folder"));
}

std::optional<Difference> differ_at(const std::string& path, const Json& first, const Json& second);

std::optional<Difference> objects_differ(const std::string& path, const Json& first,
                                         const Json& second) {
  for (const auto& [key, value] : first.items()) {
    if (varies(path, key)) {
      continue;
    }
    if (!second.contains(key)) {
      return Difference{below(path, key), shown(value), "nothing"};
    }
    if (auto found = differ_at(below(path, key), value, second.at(key))) {
      return found;
    }
  }
  for (const auto& [key, value] : second.items()) {
    if (!varies(path, key) && !first.contains(key)) {
      return Difference{below(path, key), "nothing", shown(value)};
    }
  }
  return std::nullopt;
}

std::optional<Difference> arrays_differ(const std::string& path, const Json& first,
                                        const Json& second) {
  const std::size_t both = std::min(first.size(), second.size());
  for (std::size_t n = 0; n < both; ++n) {
    if (auto found = differ_at(below(path, std::to_string(n)), first[n], second[n])) {
      return found;
    }
  }
  if (first.size() == second.size()) {
    return std::nullopt;
  }
  return Difference{below(path, std::to_string(both)),
                    both < first.size() ? shown(first[both]) : "nothing",
                    both < second.size() ? shown(second[both]) : "nothing"};
}

std::optional<Difference> differ_at(const std::string& path, const Json& first,
                                    const Json& second) {
  if (first.is_object() && second.is_object()) {
    return objects_differ(path, first, second);
  }
  if (first.is_array() && second.is_array()) {
    return arrays_differ(path, first, second);
  }
  // Compared as texts, to distinguish 0 from -0 and 1 from 1.0.
  if (json_text(first) == json_text(second)) {
    return std::nullopt;
  }
  return Difference{path, shown(first), shown(second)};
}
}  // namespace

std::optional<Difference> first_difference(const Json& first, const Json& second) {
  return differ_at("", first, second);
}

std::optional<Difference> first_difference(const std::string& first, const std::string& second) {
  if (first == second) {
    return std::nullopt;
  }
  const Json one = first.empty() ? Json() : json_or_discarded(first);
  const Json other = second.empty() ? Json() : json_or_discarded(second);
  if (one.is_discarded() || other.is_discarded()) {
    return Difference{"result", excerpt(first), excerpt(second)};
  }
  return first_difference(one, other);
}
}  // namespace altiplan::host
