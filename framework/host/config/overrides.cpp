// SPDX-License-Identifier: Apache-2.0
#include "host/config/overrides.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "host/config/yaml.hpp"

namespace altiplan::host {
namespace {

/// The value at a dotted path, with empty maps created for missing parents.
Value& reach(Value& root, const std::string& path, const std::string& text) {
  const auto fail = [&](const std::string& message) -> void {
    throw ConfigError(Location{root.where.file, 0, 0, text}, path, message);
  };
  Value* at = &root;
  std::size_t begin = 0;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (key.empty()) {
      fail("expected keys separated by single dots");
    }
    if (at->kind == Value::Kind::list) {
      std::size_t index = 0;
      const auto [stop, error] = std::from_chars(key.data(), key.data() + key.size(), index);
      if (error != std::errc() || stop != key.data() + key.size() || index >= at->items.size()) {
        const std::size_t count = at->items.size();
        fail("'" + key + "' is not an index of this list, which " +
             (count == 0 ? "is empty"
                         : "has " + std::to_string(count) + (count == 1 ? " item" : " items") +
                               ", counted from 0"));
      }
      at = &at->items[index];
    } else {
      if (at->kind == Value::Kind::scalar) {
        at->kind = Value::Kind::map;  // replaces the former value
        at->text.clear();
      }
      const Location here{root.where.file, 0, 0, text};
      auto entry = std::find_if(at->entries.begin(), at->entries.end(),
                                [&](const Value::Entry& e) { return e.key == key; });
      if (entry == at->entries.end()) {
        Value fresh;
        fresh.kind = Value::Kind::map;
        fresh.where = here;
        entry = at->entries.insert(entry, {key, here, fresh});
      }
      if (end == path.size()) {
        entry->where = here;  // its problems belong to the override, not to the file
      }
      at = &entry->value;
    }
    begin = end + 1;
  }
  return *at;
}

/// Sets the file that the override's paths are relative to in every location of its value.
void settle(Value& value, const std::string& file) {
  value.where.file = file;
  for (Value& item : value.items) {
    settle(item, file);
  }
  for (Value::Entry& entry : value.entries) {
    entry.where.file = file;
    settle(entry.value, file);
  }
}

}  // namespace

void apply_overrides(Value& tree, const std::vector<std::string>& set, FileOfKey file) {
  static constexpr std::string_view kPrefix = "scenario.";
  for (const std::string& assignment : set) {
    const std::string text = "--set " + assignment;
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(Location{"", 0, 0, text}, "", "expected KEY=VALUE");
    }
    std::string path = assignment.substr(0, equals);
    const bool of_scenario = path.starts_with(kPrefix);
    if (of_scenario != (file == FileOfKey::scenario)) {
      continue;
    }
    if (of_scenario) {
      path = path.substr(kPrefix.size());
    }
    Value value = parse_override(assignment.substr(equals + 1), text);
    settle(value, tree.where.file);
    reach(tree, path, text) = std::move(value);
  }
}
}  // namespace altiplan::host
