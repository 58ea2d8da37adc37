// SPDX-License-Identifier: Apache-2.0
#include "host/config/overrides.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "host/config/yaml.hpp"

namespace altiplan::host {
namespace {

/// A walk along the keys of a dotted path.
class Walk {
 public:
  Walk(const Value& root, std::string path, std::string text)
      : file_(root.where.file), path_(std::move(path)), text_(std::move(text)) {}

  /// The value there, with empty maps created for what is missing.
  Value& reach(Value& root) {
    Value* at = &root;
    while (next()) {
      at = at->kind == Value::Kind::list ? &item(*at, true) : &entry(*at);
    }
    return *at;
  }

  void remove(Value& root) {
    Value* at = &root;
    while (next()) {
      if (at->kind == Value::Kind::list) {
        Value& found = item(*at, false);
        if (is_last()) {
          at->items.erase(at->items.begin() + (&found - at->items.data()));
          return;
        }
        at = &found;
      } else {
        const auto found = find(*at);
        if (found == at->entries.end()) {
          fail("there is no '" + key_ + "' to remove");
        }
        if (is_last()) {
          at->entries.erase(found);
          return;
        }
        at = &found->value;
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ConfigError(Location{file_, 0, 0, text_}, path_, message);
  }
  Location here() const { return {file_, 0, 0, text_}; }

  bool next() {
    if (begin_ > path_.size()) {
      return false;
    }
    const std::size_t end = std::min(path_.find('.', begin_), path_.size());
    key_ = path_.substr(begin_, end - begin_);
    if (key_.empty()) {
      fail("expected keys separated by single dots");
    }
    begin_ = end + 1;
    return true;
  }
  bool is_last() const { return begin_ > path_.size(); }

  Value empty_map() const {
    Value fresh;
    fresh.kind = Value::Kind::map;
    fresh.where = here();
    return fresh;
  }

  Value& item(Value& list, bool may_add) const {
    std::size_t index = 0;
    const std::size_t count = list.items.size();
    const auto [stop, error] = std::from_chars(key_.data(), key_.data() + key_.size(), index);
    const bool is_index = error == std::errc() && stop == key_.data() + key_.size();
    if (is_index && index == count && may_add) {
      list.items.push_back(empty_map());
    } else if (!is_index || index >= count) {
      fail("'" + key_ + "' is not an index of this list, which " +
           (count == 0 ? "is empty"
                       : "has " + std::to_string(count) + (count == 1 ? " item" : " items") +
                             ", counted from 0") +
           (may_add ? "; " + std::to_string(count) + " adds one" : ""));
    }
    return list.items[index];
  }

  std::vector<Value::Entry>::iterator find(Value& map) const {
    return std::find_if(map.entries.begin(), map.entries.end(),
                        [&](const Value::Entry& e) { return e.key == key_; });
  }

  Value& entry(Value& map) const {
    if (map.kind == Value::Kind::scalar) {
      map.kind = Value::Kind::map;  // replaces the former value
      map.text.clear();
    }
    auto found = find(map);
    if (found == map.entries.end()) {
      found = map.entries.insert(found, {key_, here(), empty_map()});
    }
    if (is_last()) {
      found->where = here();  // its problems belong to the override, not to the file
    }
    return found->value;
  }

  const std::string file_;
  const std::string path_;
  const std::string text_;
  std::string key_;
  std::size_t begin_ = 0;
};

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

SetText parse_set(const std::string& assignment) {
  static constexpr std::string_view kPrefix = "scenario.";
  SetText set;
  if (assignment.starts_with('~')) {
    set.path = assignment.substr(1);
  } else {
    const std::size_t equals = std::min(assignment.find('='), assignment.size());
    set.path = assignment.substr(0, equals);
    if (equals < assignment.size()) {
      set.value = assignment.substr(equals + 1);
    }
  }
  if (set.path.empty() || (!set.value && !assignment.starts_with('~'))) {
    throw ConfigError(Location{"", 0, 0, "--set " + assignment}, "",
                      "expected KEY=VALUE, or ~KEY to remove");
  }
  if (set.path.starts_with(kPrefix)) {
    set.file = FileOfKey::scenario;
    set.path = set.path.substr(kPrefix.size());
  }
  return set;
}

void apply_overrides(Value& tree, const std::vector<std::string>& set, FileOfKey file) {
  for (const std::string& assignment : set) {
    const SetText one = parse_set(assignment);
    if (one.file != file) {
      continue;
    }
    const std::string text = "--set " + assignment;
    Walk walk(tree, one.path, text);
    if (one.value) {
      Value value = parse_override(*one.value, text);
      settle(value, tree.where.file);
      walk.reach(tree) = std::move(value);
    } else {
      walk.remove(tree);
    }
  }
}
}  // namespace altiplan::host
