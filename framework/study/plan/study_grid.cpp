// SPDX-License-Identifier: Apache-2.0
#include "study/plan/study_grid.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "host/base/json.hpp"

namespace altiplan::study {
namespace {

constexpr std::size_t kMaxCells = 1000000;

/// FROM..TO, both included.
using Range = std::pair<std::int64_t, std::int64_t>;

std::optional<Range> range_of(const Value& value, const std::string& key) {
  if (value.kind != Value::Kind::scalar || value.quoted) {
    return std::nullopt;
  }
  const std::size_t dots = value.text.find("..");
  if (dots == std::string::npos) {
    return std::nullopt;
  }
  const auto whole = [](std::string_view text) -> std::optional<std::int64_t> {
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && stop == text.data() + text.size() ? std::optional(number)
                                                                     : std::nullopt;
  };
  const auto from = whole(std::string_view(value.text).substr(0, dots));
  const auto to = whole(std::string_view(value.text).substr(dots + 2));
  if (!from && !to) {
    return std::nullopt;  // a path, such as ../data/hills.tif
  }
  if (!from || !to || *from > *to) {
    throw ConfigError(
        value.where, key,
        "expected FROM..TO, two whole numbers with FROM at most TO, found " + value.what());
  }
  // Unsigned, since the difference may overflow a signed type.
  if (std::uint64_t(*to) - std::uint64_t(*from) >= kMaxCells) {
    throw ConfigError(value.where, key,
                      "expected at most 1000000 values, found the range " + value.text);
  }
  return Range{*from, *to};
}

/// A value as part of a name: 125x125x25 for a list of numbers.
std::string short_value(const Value& value) {
  if (value.kind != Value::Kind::list) {
    return flow_text(value);
  }
  std::string text;
  for (const Value& part : value.items) {
    text += (text.empty() ? "" : "x") + short_value(part);
  }
  return text;
}

std::vector<Assignment> values_of(const Value::Entry& entry, const std::string& key) {
  std::vector<Assignment> all;
  const Value& value = entry.value;
  if (value.kind == Value::Kind::list) {
    if (value.items.empty()) {
      throw ConfigError(value.where, key, "expected values, found an empty list");
    }
    for (const Value& item : value.items) {
      all.push_back({entry.key, flow_text(item), short_value(item), item.where});
    }
  } else if (const auto range = range_of(value, key)) {
    const std::uint64_t last = std::uint64_t(range->second) - std::uint64_t(range->first);
    for (std::uint64_t i = 0; i <= last; ++i) {
      const std::string text = std::to_string(std::int64_t(std::uint64_t(range->first) + i));
      all.push_back({entry.key, text, text, value.where});
    }
  } else {
    all.push_back({entry.key, flow_text(value), "", value.where});
  }
  return all;
}

/// The shortest unique suffix of the key, split at dots: weight_g of steps.0.with.weight_g.
std::string short_name(const std::string& key, const Value& set) {
  std::size_t begin = key.size();
  while (begin > 0) {
    const std::size_t dot = key.rfind('.', begin - 1);
    begin = dot == std::string::npos ? 0 : dot;
    const std::string end = key.substr(begin == 0 ? 0 : begin + 1);
    const auto shared =
        std::count_if(set.entries.begin(), set.entries.end(), [&](const Value::Entry& other) {
          return other.key == end || other.key.ends_with("." + end);
        });
    if (shared == 1) {
      return end;
    }
  }
  return key;
}

/// True if YAML would read this plain text, in a flow list, as something else.
bool needs_quotes(const std::string& text) {
  return text.empty() || text.find_first_of(",[]{}:#&*!|>'\"%@`?\\\n\t") != std::string::npos ||
         text.front() == ' ' || text.back() == ' ' || text == "-";
}
}  // namespace

std::string flow_text(const Value& value) {
  std::string text;
  switch (value.kind) {
    case Value::Kind::scalar:
      return value.quoted || needs_quotes(value.text) ? host::exact_json_text(value.text)
                                                      : value.text;
    case Value::Kind::list:
      for (const Value& item : value.items) {
        text += (text.empty() ? "" : ", ") + flow_text(item);
      }
      return "[" + text + "]";
    case Value::Kind::map:
      for (const Value::Entry& entry : value.entries) {
        text += (text.empty() ? "" : ", ") + host::exact_json_text(entry.key) + ": " +
                flow_text(entry.value);
      }
      return "{" + text + "}";
  }
  return text;
}

std::vector<GridCell> grid_of(const Value& set, const std::string& path) {
  if (set.kind == Value::Kind::scalar && set.text.empty()) {
    return {GridCell{}};  // not given
  }
  if (set.kind != Value::Kind::map) {
    throw ConfigError(set.where, path, "expected keys with values, found " + set.what());
  }
  std::vector<GridCell> cells{GridCell{}};
  for (const Value::Entry& entry : set.entries) {
    const std::vector<Assignment> values = values_of(entry, path + "." + entry.key);
    if (cells.size() * values.size() > kMaxCells) {
      throw ConfigError(entry.where, path, "expected at most 1000000 combinations, found more");
    }
    std::vector<GridCell> finer;
    for (const GridCell& cell : cells) {
      for (const Assignment& value : values) {
        finer.push_back(cell);
        finer.back().assignments.push_back(value);
        if (values.size() > 1) {
          finer.back().label +=
              (cell.label.empty() ? "" : ",") + short_name(entry.key, set) + "=" + value.label;
        }
      }
    }
    cells = std::move(finer);
  }
  for (GridCell& cell : cells) {
    cell.label = cell.label.empty() ? "" : "[" + cell.label + "]";
  }
  return cells;
}
}  // namespace altiplan::study
