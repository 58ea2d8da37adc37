// SPDX-License-Identifier: Apache-2.0
#include "tune/tuned_file.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "altiplan/formats/input_file.hpp"
#include "host/base/built_in.hpp"
#include "host/base/machine_fault.hpp"
#include "host/config/config_check.hpp"
#include "host/config/overrides.hpp"
#include "host/config/yaml.hpp"
#include "host/result/result_json.hpp"
#include "study/plan/study_grid.hpp"

namespace altiplan::tune {
namespace fs = std::filesystem;
namespace {

/// True if two trees are equal; the order of keys does not count.
bool same(const Value& a, const Value& b) {
  if (a.kind != b.kind || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size()) {
    return false;
  }
  if (a.kind == Value::Kind::scalar) {
    return a.text == b.text && a.quoted == b.quoted;
  }
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!same(a.items[i], b.items[i])) {
      return false;
    }
  }
  return std::all_of(a.entries.begin(), a.entries.end(), [&](const Value::Entry& entry) {
    const Value* other = b.find(entry.key);
    return other != nullptr && same(entry.value, *other);
  });
}

/// The document being edited.
class Document {
 public:
  explicit Document(std::string text)
      : text_(std::move(text)), tree_(host::parse_yaml(text_, "")) {}

  const std::string& text() const { return text_; }
  const Value& tree() const { return tree_; }

  /// Sets the key within the text; false if that would change anything else.
  bool set(const std::string& assignment) {
    Value wanted = tree_;
    host::apply_overrides(wanted, {assignment}, host::FileOfKey::pipeline);
    const std::size_t equals = assignment.find('=');
    std::string edited = text_;
    if (!edit(edited, assignment.substr(0, equals), assignment.substr(equals + 1))) {
      return false;
    }
    try {
      Document changed(std::move(edited));
      if (!same(changed.tree_, wanted)) {
        return false;
      }
      *this = std::move(changed);
      return true;
    } catch (const ConfigError&) {
      return false;
    }
  }

 private:
  /// The value at the key; if there is none, null with the deepest existing map and the missing
  /// keys.
  const Value* find(const std::string& key, const Value*& deepest, std::string& lacking) const {
    const Value* at = &tree_;
    std::size_t begin = 0;
    while (begin <= key.size()) {
      const std::size_t end = std::min(key.find('.', begin), key.size());
      const std::string word = key.substr(begin, end - begin);
      const Value* next = nullptr;
      if (at->kind == Value::Kind::list) {
        std::size_t index = 0;
        std::from_chars(word.data(), word.data() + word.size(), index);
        next = index < at->items.size() ? &at->items[index] : nullptr;
      } else {
        next = at->find(word);
      }
      if (next == nullptr) {
        deepest = at;
        lacking = key.substr(begin);
        return nullptr;
      }
      at = next;
      begin = end + 1;
    }
    return at;
  }

  bool edit(std::string& text, const std::string& key, const std::string& value) const {
    const Value* deepest = nullptr;
    std::string lacking;
    if (const Value* there = find(key, deepest, lacking)) {
      return replace(text, *there, value);
    }
    // with.weight_g of a step without `with`.
    const std::size_t dot = lacking.find('.');
    const std::string added =
        dot == std::string::npos
            ? lacking + ": " + value
            : lacking.substr(0, dot) + ": {" + lacking.substr(dot + 1) + ": " + value + "}";
    return deepest->kind == Value::Kind::map && insert(text, *deepest, added);
  }

  static bool replace(std::string& text, const Value& old, const std::string& value) {
    const std::size_t at = offset(text, old.where);
    std::size_t length = old.text.size();
    if (old.kind != Value::Kind::scalar || at >= text.size()) {
      return false;
    }
    if (old.quoted) {
      const std::size_t end = text.find(text[at], at + 1);
      if (end == std::string::npos) {
        return false;
      }
      length = end + 1 - at;
    } else if (text.compare(at, length, old.text) != 0) {
      return false;
    }
    text.replace(at, length, value);
    return true;
  }

  /// Inserts "key: value" into a map: after the brace of a flow map, otherwise on a new line before
  /// the first key, or after it if that begins a list item.
  static bool insert(std::string& text, const Value& map, const std::string& added) {
    if (const std::size_t at = offset(text, map.where); at < text.size() && text[at] == '{') {
      text.insert(at + 1, added + (map.entries.empty() ? "" : ", "));
      return true;
    }
    if (map.entries.empty()) {
      return false;
    }
    const std::size_t first = offset(text, map.entries[0].where);
    const std::size_t line = text.rfind('\n', first) + 1;  // 0 in the first line
    const std::string indent(first - line, ' ');
    if (text.compare(line, indent.size(), indent) == 0) {
      text.insert(line, indent + added + "\n");
      return true;
    }
    const std::size_t next = map.entries.size() > 1
                                 ? text.rfind('\n', offset(text, map.entries[1].where)) + 1
                                 : std::min(text.find('\n', first), text.size() - 1) + 1;
    text.insert(next, indent + added + "\n");
    return true;
  }

  /// Columns count characters of UTF-8.
  static std::size_t offset(const std::string& text, const Location& where) {
    std::size_t at = 0;
    for (int line = 1; line < where.line; ++line) {
      at = std::min(text.find('\n', at), text.size() - 1) + 1;
    }
    for (int column = 1; column < where.column && at < text.size(); ++column) {
      do {
        ++at;
      } while (at < text.size() && (std::uint8_t(text[at]) & 0xC0) == 0x80);
    }
    return at;
  }

  std::string text_;
  Value tree_;
};

/// The path relative to the folder.
std::string rebased(const std::string& path, const fs::path& from, const fs::path& folder) {
  if (path.empty() || fs::path(path).is_absolute()) {
    return path;
  }
  const fs::path target = (from / path).lexically_normal();
  // With symbolic links in the path, ".." may lead elsewhere.
  const auto is_itself = [](const fs::path& plain) {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(plain, error);
    if (host::is_machine_fault(error.value())) {
      throw host::MachineFault(host::unreadable(plain, error.value()));
    }
    return canonical == plain;
  };
  const bool is_plain = is_itself(folder) && is_itself(target);
  const fs::path relative = target.lexically_relative(folder);
  return (is_plain && !relative.empty() ? relative : target).string();
}

/// Keys of the pipeline with paths as values, and these values.
std::vector<std::pair<std::string, std::string>> paths_of(const host::Config& config) {
  std::vector<std::pair<std::string, std::string>> paths;
  const auto add = [&](const std::string& key, const Value* value) {
    if (value != nullptr && value->kind == Value::Kind::scalar) {
      paths.emplace_back(key, value->text);
    }
  };
  add("scenario", config.pipeline_tree.find("scenario"));
  if (const Value* plugins = config.pipeline_tree.find("plugins")) {
    for (std::size_t i = 0; i < plugins->items.size(); ++i) {
      add(host::item("plugins", i), &plugins->items[i]);
    }
  }
  const auto add_fields = [&](const ParamReport& report, const Value& with,
                              const std::string& path) {
    for (const BoundField& field : report.fields) {
      if (field.spec.type == FieldType::path) {
        add(path + "." + field.spec.name, with.find(field.spec.name));
      }
    }
  };
  const auto add_step = [&](const host::StepEntry& step) {
    if (step.plugin != host::kFollowRoute) {
      const std::string path = step.path + ".with";
      const PluginEntry& entry =
          plugin(*config.registry, host::kind_of_step(*config.registry, step), step.plugin);
      add_fields(entry.describe(&step.with, path), step.with, path);
    }
  };
  for (const host::StepEntry& step : config.steps) {
    add_step(step);
    std::for_each(step.otherwise.begin(), step.otherwise.end(), add_step);
  }
  for (std::size_t i = 0; i < config.pipeline.constraints.size(); ++i) {
    const host::ConstraintEntry& entry = config.pipeline.constraints[i];
    const std::string path = host::item("constraints", i) + "." + entry.plugin;
    add_fields(
        plugin(*config.registry, "constraint", entry.plugin).describe(&entry.parameters, path),
        entry.parameters, path);
  }
  host::for_each_objective(
      config, [&](const std::string& name, const Value& parameters, const std::string& key) {
        if (!key.starts_with("scenario.")) {
          add_fields(plugin(*config.registry, "objective", name).describe(&parameters, key),
                     parameters, key);
        }
      });
  return paths;
}

std::string scalar_text(const std::string& text) {
  Value value;
  value.text = text;
  return study::flow_text(value);
}
}  // namespace

std::string tuned_text(const host::Config& config, const std::vector<std::string>& assignments,
                       const fs::path& folder) {
  Document document(formats::read_file(config.pipeline_path.string()));
  const fs::path from = config.pipeline_path.parent_path();
  const fs::path to = fs::absolute(folder / "").lexically_normal().parent_path();
  std::vector<std::string> all = assignments;
  for (const auto& [key, path] : paths_of(config)) {
    if (const std::string moved = rebased(path, from, to); moved != path) {
      all.push_back(key + "=" + scalar_text(moved));
    }
  }
  const bool is_kept = std::all_of(all.begin(), all.end(), [&](const std::string& assignment) {
    return document.set(assignment);
  });
  if (is_kept) {
    return document.text();
  }
  Value tree = document.tree();
  host::apply_overrides(tree, all, host::FileOfKey::pipeline);
  std::string text;
  for (const Value::Entry& entry : tree.entries) {
    text += entry.key + ": " + study::flow_text(entry.value) + "\n";
  }
  return text;
}
}  // namespace altiplan::tune
