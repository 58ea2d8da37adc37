// SPDX-License-Identifier: Apache-2.0
#include "host/config/yaml_edit.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "host/config/yaml.hpp"

namespace altiplan::host {
namespace {

/// A text, and where its values begin and end.
class Places {
 public:
  explicit Places(std::string_view text) : text_(text) {}

  /// Offset of a location.
  std::size_t at(const Location& where) const {
    std::size_t offset = 0;
    for (int line = 1; line < where.line; ++line) {
      offset = std::min(text_.find('\n', offset), text_.size() - 1) + 1;
    }
    for (int column = 1; column < where.column && offset < text_.size(); ++column) {
      do {
        ++offset;
      } while (offset < text_.size() && (static_cast<unsigned char>(text_[offset]) & 0xC0) == 0x80);
    }
    return offset;
  }

  bool is_flow(const Value& value) const {
    const std::size_t from = at(value.where);
    return value.kind != Value::Kind::scalar && from < text_.size() &&
           (text_[from] == '[' || text_[from] == '{');
  }

  /// Offset after the value, which stands in a list or map in brackets or not.
  std::size_t end(const Value& value, bool in_flow) const {
    const std::size_t from = at(value.where);
    if (value.kind == Value::Kind::scalar) {
      return value.quoted ? after_quote(from) : after_plain(from, in_flow);
    }
    if (is_flow(value)) {
      return after_bracket(from);
    }
    std::size_t last = from;
    for (const Value& item : value.items) {
      last = std::max(last, end(item, false));
    }
    for (const Value::Entry& entry : value.entries) {
      last = std::max(last, end(entry.value, false));
    }
    return last;
  }

  /// Offset of the first character of the line.
  std::size_t line_begin(std::size_t from) const {
    const std::size_t before = from > 0 ? text_.rfind('\n', from - 1) : text_.npos;
    return before == text_.npos ? 0 : before + 1;
  }
  std::size_t after_line(std::size_t end) const { return std::min(end + 1, text_.size()); }
  /// True if nothing but blanks stands before it in its line.
  bool begins_line(std::size_t from) const {
    const std::size_t first = text_.find_first_not_of(' ', line_begin(from));
    return first >= from;
  }
  /// Offset of the comma before an item in brackets.
  std::size_t before_comma(std::size_t from) const { return text_.rfind(',', from); }
  /// Offset of the end of the line.
  std::size_t line_end(std::size_t from) const {
    return std::min(text_.find('\n', from), text_.size());
  }

 private:
  std::size_t after_quote(std::size_t from) const {
    const char quote = text_[from];
    for (std::size_t i = from + 1; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        if (quote == '\'' && i + 1 < text_.size() && text_[i + 1] == quote) {
          ++i;
        } else {
          return i + 1;
        }
      }
    }
    return text_.size();
  }

  std::size_t after_plain(std::size_t from, bool in_flow) const {
    std::size_t i = from;
    while (i < text_.size() && text_[i] != '\n' && text_[i] != '\r' &&
           !(in_flow && (text_[i] == ',' || text_[i] == ']' || text_[i] == '}')) &&
           !(text_[i] == '#' && i > 0 && (text_[i - 1] == ' ' || text_[i - 1] == '\t'))) {
      ++i;
    }
    while (i > from && (text_[i - 1] == ' ' || text_[i - 1] == '\t')) {
      --i;
    }
    return i;
  }

  std::size_t after_bracket(std::size_t from) const {
    int depth = 0;
    for (std::size_t i = from; i < text_.size(); ++i) {
      const char c = text_[i];
      const bool begins =
          i == 0 || std::string_view(" \t\n\r,[{:").find(text_[i - 1]) != std::string_view::npos;
      if ((c == '"' || c == '\'') && begins) {
        i = after_quote(i) - 1;
      } else if (c == '#' && begins) {
        i = line_end(i) - 1;
      } else if (c == '[' || c == '{') {
        ++depth;
      } else if ((c == ']' || c == '}') && --depth == 0) {
        return i + 1;
      }
    }
    return text_.size();
  }

  std::string_view text_;
};

/// One assignment's change of a text.
struct Change {
  std::size_t from = 0;
  std::size_t to = 0;
  std::string text;
};

/// The keys of a path that no value has yet, as nested maps around the value.
std::string nested(const std::vector<std::string>& keys, std::size_t from,
                   const std::string& value) {
  std::string text;
  for (std::size_t n = from; n < keys.size(); ++n) {
    text += (n == from ? "" : "{") + keys[n] + ": ";
  }
  return text + value + std::string(keys.size() - from - 1, '}');
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> keys;
  std::size_t begin = 0;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    keys.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return keys;
}

const Value* child(const Value& of, const std::string& key) {
  if (of.kind == Value::Kind::map) {
    return of.find(key);
  }
  std::size_t index = of.items.size();
  const auto [stop, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  const bool is_index = error == std::errc() && stop == key.data() + key.size();
  return is_index && index < of.items.size() ? &of.items[index] : nullptr;
}

/// Adds an item to a list.
Change appended(const Places& places, const Value& list, const std::string& value) {
  if (places.is_flow(list)) {
    const std::size_t end = places.end(list, true) - 1;
    return {end, end, list.items.empty() ? value : ", " + value};
  }
  const int indent = list.where.column - 1;
  const std::size_t end = places.line_end(places.end(list, false));
  return {end, end, "\n" + std::string(std::size_t(indent), ' ') + "- " + value};
}

/// Takes away what stands from one offset to another in a list or map in brackets.
Change without(const Places& places, const Value& holder, std::size_t n, std::size_t from,
               std::size_t next, std::size_t to) {
  const bool is_last = n + 1 == std::max(holder.items.size(), holder.entries.size());
  return is_last ? Change{places.before_comma(from), to, ""} : Change{from, next, ""};
}

/// Takes the key, or the list's item, away from its holder.
Change removed(const Places& places, const Value& holder, const std::string& key, bool in_flow) {
  const std::size_t count = std::max(holder.items.size(), holder.entries.size());
  const bool is_list = holder.kind == Value::Kind::list;
  if (count == 1) {
    return {places.at(holder.where), places.end(holder, in_flow), is_list ? "[]" : "{}"};
  }
  std::size_t n = 0;
  if (is_list) {
    std::from_chars(key.data(), key.data() + key.size(), n);
  } else {
    while (holder.entries[n].key != key) {
      ++n;
    }
  }
  const auto begin = [&](std::size_t which) {
    return places.at(is_list ? holder.items[which].where : holder.entries[which].where);
  };
  const Value& value = is_list ? holder.items[n] : holder.entries[n].value;
  const bool is_flow = places.is_flow(holder);
  const std::size_t end = places.end(value, in_flow || is_flow);
  if (is_flow) {
    return without(places, holder, n, begin(n), n + 1 < count ? begin(n + 1) : end, end);
  }
  if (n == 0 && !is_list && !places.begins_line(begin(0))) {
    return {begin(0), begin(1), ""};  // the dash before the first key stays
  }
  // Whole lines, with the comment behind the value.
  const std::size_t last = places.line_end(end);
  const std::size_t first = places.line_begin(begin(n));
  return first > 0 ? Change{first - 1, last, ""} : Change{first, places.after_line(last), ""};
}

/// Adds the keys from `at` on to a map.
Change added(const Places& places, const Value& map, const std::vector<std::string>& keys,
             std::size_t at, const std::string& value) {
  const std::string entry = nested(keys, at, value);
  if (places.is_flow(map)) {
    const std::size_t end = places.end(map, true) - 1;
    return {end, end, map.entries.empty() ? entry : ", " + entry};
  }
  const int indent = map.entries.front().where.column - 1;
  const std::size_t end = places.line_end(places.end(map, false));
  return {end, end, "\n" + std::string(std::size_t(indent), ' ') + entry};
}

/// `tree` is the text's.
Change change_of(std::string_view text, const Value& tree, const SetText& set) {
  const Places places(text);
  const std::vector<std::string> keys = split(set.path);
  const std::string value = set.value.value_or("");
  const Value* here = &tree;
  bool in_flow = false;
  for (std::size_t n = 0; n < keys.size(); ++n) {
    const Value* next = child(*here, keys[n]);
    if (!set.value && n + 1 == keys.size()) {
      return removed(places, *here, keys[n], in_flow);
    }
    if (next == nullptr && here->kind == Value::Kind::list) {
      return appended(places, *here,
                      n + 1 == keys.size() ? value : "{" + nested(keys, n + 1, value) + "}");
    }
    if (next == nullptr) {
      if (here->kind == Value::Kind::scalar || (here->entries.empty() && !places.is_flow(*here))) {
        const std::size_t from = places.at(here->where);
        return {from, places.end(*here, in_flow), "{" + nested(keys, n, value) + "}"};
      }
      return added(places, *here, keys, n, value);
    }
    in_flow = in_flow || places.is_flow(*here);
    here = next;
  }
  return {places.at(here->where), places.end(*here, in_flow), value};
}
}  // namespace

const Value* value_at(const Value& tree, const std::string& path) {
  const Value* here = &tree;
  for (const std::string& key : split(path)) {
    here = here != nullptr ? child(*here, key) : nullptr;
  }
  return here;
}

bool same_values(const Value& a, const Value& b) {
  return a.kind == b.kind && a.text == b.text && a.quoted == b.quoted &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same_values) &&
         std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(),
                    [](const Value::Entry& x, const Value::Entry& y) {
                      return x.key == y.key && same_values(x.value, y.value);
                    });
}

std::string with_assignments(std::string text, const std::string& name,
                             const std::vector<std::string>& set, FileOfKey file) {
  for (const std::string& assignment : set) {
    const SetText one = parse_set(assignment);
    if (one.file != file) {
      continue;
    }
    Value wanted = parse_yaml(text, name);
    const Value before = wanted;
    apply_overrides(wanted, {assignment}, file);
    if (same_values(wanted, before)) {
      continue;
    }
    const Change change = change_of(text, before, one);
    std::string changed = text;
    changed.replace(change.from, change.to - change.from, change.text);
    bool is_as_wanted = false;
    try {
      is_as_wanted = same_values(parse_yaml(changed, name), wanted);
    } catch (const ConfigError&) {
      is_as_wanted = false;
    }
    if (!is_as_wanted) {
      throw ConfigError({name, 0, 0, ""}, one.path,
                        "cannot be changed without changing other parts of the text: change it by "
                        "hand");
    }
    text = std::move(changed);
  }
  return text;
}
}  // namespace altiplan::host
