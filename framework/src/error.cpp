// SPDX-License-Identifier: Apache-2.0
#include "altiplan/error.hpp"

#include <algorithm>
#include <new>
#include <numeric>

namespace altiplan {

std::string Location::text() const {
  if (!override_text.empty()) {
    return override_text;
  }
  std::string text = file;
  if (line > 0) {
    text += ":" + std::to_string(line) + ":" + std::to_string(column);
  }
  return text;
}

std::string Problem::text() const {
  std::string text = where.text();
  if (!key.empty()) {
    text += (text.empty() ? "" : ": ") + key;
  }
  return text + (text.empty() ? "" : ": ") + message;
}

// The key functions: one type_info each, in this library, whoever throws or catches.
Error::~Error() = default;
ConfigError::~ConfigError() = default;
ParameterError::~ParameterError() = default;
PluginError::~PluginError() = default;
BudgetSpent::~BudgetSpent() = default;

void attribute_to(const std::string& who) {
  try {
    throw;
  } catch (const PluginError& error) {  // which says what it did
    throw PluginError(who + error.what(), error.reason());
  } catch (const std::bad_alloc& error) {
    throw PluginError(who + "threw: " + error.what(), Reason::out_of_memory);
  } catch (const std::exception& error) {
    throw PluginError(who + "threw: " + error.what(), Reason::threw);
  } catch (...) {
    throw PluginError(who + "threw something that is not a std::exception", Reason::threw);
  }
}

namespace {
std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    text += (text.empty() ? "" : "\n") + problem.text();
  }
  return text;
}
}  // namespace

ConfigError::ConfigError(std::vector<Problem> problems)
    : Error(joined(problems)), problems_(std::move(problems)) {}

ConfigError::ConfigError(Location where, std::string key, std::string message)
    : ConfigError(std::vector<Problem>{{std::move(where), std::move(key), std::move(message)}}) {}

namespace {
/// Edit distance with transpositions (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> older;
  std::vector<std::size_t> previous(b.size() + 1);
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> current(b.size() + 1);
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t cost = a[i - 1] == b[j - 1] ? 0 : 1;
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + cost});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], older[j - 2] + 1);
      }
    }
    older = std::move(previous);
    previous = std::move(current);
  }
  return previous.back();
}
}  // namespace

std::string excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string quoted = "'";
  for (const char c : text.substr(0, kLongest)) {
    quoted += c >= ' ' && c < 0x7f ? c : '?';
  }
  return quoted + (text.size() > kLongest ? "…'" : "'");
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string_view head = word.substr(0, 64);  // the cost is quadratic in the length
  std::size_t best = std::max<std::size_t>(1, head.size() / 3) + 1;
  std::string found;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(head, candidate);
    if (distance < best) {
      best = distance;
      found = candidate;
    }
  }
  return found;
}
}  // namespace altiplan
