// SPDX-License-Identifier: Apache-2.0
#include "host/describe/describe.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "host/base/built_in.hpp"
#include "host/config/config.hpp"

namespace altiplan::host {
namespace {

constexpr std::array<const char*, 8> kKinds = {"environment",   "constraint", "planner",
                                               "local_planner", "smoother",   "tuner",
                                               "objective",     "task"};

std::string number_text(double number) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), end.ptr};
}

/// "number", "list of maps", "one of a, b" …
std::string type_text(const FieldSpec& spec) {
  switch (spec.type) {
    case FieldType::boolean:
      return "true or false";
    case FieldType::integer:
      return "integer";
    case FieldType::number:
      return "number";
    case FieldType::auto_number:
      return "number or auto";
    case FieldType::text:
      return "text";
    case FieldType::choice:
      return "word";
    case FieldType::path:
      return "path";
    case FieldType::vec2:
      return "2 numbers";
    case FieldType::vec3:
      return "3 numbers";
    case FieldType::point:
      return "point";
    case FieldType::list:
      return "list of " + type_text(spec.children.at(0));
    case FieldType::structure:
      return "map";
    case FieldType::plugin:
      return spec.choices.at(0);
    default:
      return "any";
  }
}

std::string range_text(const FieldSpec& spec) {
  std::string text;
  if (spec.type == FieldType::choice) {
    for (const std::string& word : spec.choices) {
      text += (text.empty() ? "" : ", ") + word;
    }
    return text;
  }
  const bool low = std::isfinite(spec.min);
  const bool high = std::isfinite(spec.max);
  if (low && high && !spec.above) {
    text = number_text(spec.min) + " … " + number_text(spec.max);
  } else {
    text = low ? (spec.above ? "> " : "≥ ") + number_text(spec.min) : "";
    text += high ? (low ? ", ≤ " : "≤ ") + number_text(spec.max) : "";
  }
  if (spec.min_items > 0) {
    text += (text.empty() ? "" : ", ") + std::to_string(spec.min_items) + " or more";
  }
  return text;
}

std::string default_text(const FieldSpec& spec) {
  if (spec.required) {
    return "required";
  }
  const bool shown = !spec.default_json.empty() && spec.default_json != "null" &&
                     spec.default_json != "\"\"" && spec.type != FieldType::structure;
  return shown ? spec.default_json : "";
}

std::string key_text(const FieldSpec& spec) {
  return spec.type == FieldType::point    ? "at_m, at_lonlat or at_cell; above_ground_m"
         : spec.type == FieldType::plugin ? "NAME of a " + spec.choices.at(0)
                                          : spec.name;
}

/// Lists every field followed by the fields inside it; `key` includes the enclosing keys.
struct Row {
  std::string key;
  const FieldSpec* spec;
};
void add_rows(const std::vector<FieldSpec>& fields, const std::string& before,
              std::vector<Row>& rows) {
  for (const FieldSpec& field : fields) {
    rows.push_back({before + key_text(field), &field});
    const FieldSpec* inner = &field;
    std::string suffix;
    while (inner->type == FieldType::list) {
      inner = &inner->children.at(0);
      suffix += "[]";
    }
    if (inner->type == FieldType::structure) {
      add_rows(inner->children, before + field.name + suffix + ".", rows);
    }
  }
}

std::vector<Row> rows_of(const std::vector<FieldSpec>& fields) {
  std::vector<Row> rows;
  add_rows(fields, "", rows);
  return rows;
}

std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '|' ? "\\|" : std::string(1, c);
  }
  return out.empty() ? " " : " " + out + " ";
}

Json json_of(const FieldSpec& spec) {
  Json json = {{"key", key_text(spec)}, {"type", type_text(spec)}};
  json["unit"] = spec.unit.empty() ? Json() : Json(spec.unit);
  json["required"] = spec.required;
  json["default"] = spec.default_json.empty() ? Json() : json_or_discarded(spec.default_json);
  if (json["default"].is_discarded()) {
    json["default"] = spec.default_json;
  }
  json["min"] = std::isfinite(spec.min) ? Json(spec.min) : Json();
  json["min_itself_allowed"] = !spec.above;
  json["max"] = std::isfinite(spec.max) ? Json(spec.max) : Json();
  json["choices"] = spec.choices;
  json["doc"] = spec.doc;
  Json inner = Json::array();
  for (const FieldSpec& child : spec.children) {
    inner.push_back(json_of(child));
  }
  json["parts"] = std::move(inner);
  return json;
}

std::vector<std::pair<const char*, bool>> listed(const Traits& traits) {
  return {{"complete", traits.complete},
          {"optimal", traits.optimal},
          {"any_angle", traits.any_angle},
          {"anytime", traits.anytime},
          {"incremental", traits.incremental},
          {"planar", traits.planar},
          {"spatial", traits.spatial},
          {"loiters", traits.loiters},
          {"avoids_obstacles", traits.avoids_obstacles},
          {"objectives", traits.objectives},
          {"whole_routes", traits.whole_routes}};
}

std::optional<Traits> traits_of(const PluginEntry& entry) {
  try {
    if (entry.planner != nullptr) {
      return entry.planner(nullptr)->traits();
    }
    if (entry.local_planner != nullptr) {
      return entry.local_planner(nullptr)->traits();
    }
  } catch (const ConfigError&) {
    // Some parameter has no default, so no planner can be made to read its traits.
  }
  return std::nullopt;
}

Description description_of(const PluginEntry& entry, const Library* library) {
  Description text;
  text.kind = entry.kind;
  text.name = entry.name;
  text.sentence = entry.sentence;
  if (library != nullptr) {
    text.library = library->file.string();
    text.build = library->build;
  }
  for (const BoundField& field : entry.describe(nullptr, "").fields) {
    text.parameters.push_back(field.spec);
  }
  text.traits = traits_of(entry);
  return text;
}
}  // namespace

std::vector<Description> describe_plugin(Registry& registry, std::string_view name) {
  std::vector<Description> found;
  for (const PluginEntry& entry : built_in_plugins()) {
    if (name == entry.name) {
      found.push_back(description_of(entry, nullptr));
    }
  }
  std::vector<std::string> known;
  for (const char* kind : kKinds) {
    if (const Library* library = registry.offering(kind, name)) {
      found.push_back(description_of(registry.get(kind, name), library));
    }
    const std::vector<std::string> names = registry.names(kind);
    known.insert(known.end(), names.begin(), names.end());
  }
  if (found.empty()) {
    const std::string near = nearest_name(name, known);
    throw Error("no plugin is named '" + std::string(name) + "'" +
                (near.empty() ? "" : "; did you mean '" + near + "'?") +
                " (altiplan plugins lists them)");
  }
  return found;
}

std::string describe_text(const Description& description) {
  std::string text = description.kind + " " + description.name + ": " + description.sentence + "\n";
  text += description.library.empty() ? "built in\n" : "library " + description.library + "\n";
  if (description.traits) {
    std::string holds;
    for (const auto& [name, value] : listed(*description.traits)) {
      holds += value ? (holds.empty() ? "" : ", ") + std::string(name) : "";
    }
    text += "traits with default parameters: " + (holds.empty() ? "none" : holds) + "\n";
  }
  text += description.parameters.empty() ? "no parameters\n" : "parameters\n";
  for (const Row& row : rows_of(description.parameters)) {
    const FieldSpec& spec = *row.spec;
    text +=
        "  " + row.key + ": " + type_text(spec) + (spec.unit.empty() ? "" : " [" + spec.unit + "]");
    const std::string range = range_text(spec);
    const std::string value = default_text(spec);
    text += range.empty() ? "" : ", " + range;
    text += value.empty() ? "" : spec.required ? ", required" : ", default " + value;
    text += (spec.doc.empty() ? "" : "\n      " + spec.doc) + "\n";
  }
  return text;
}

Json describe_json(const Description& description) {
  Json json = {{"kind", description.kind},
               {"name", description.name},
               {"sentence", description.sentence},
               {"library", description.library.empty() ? Json() : Json(description.library)},
               {"build", description.build.empty() ? Json() : Json(description.build)}};
  json["traits"] = Json();
  if (description.traits) {
    json["traits"] = Json::object();
    for (const auto& [name, value] : listed(*description.traits)) {
      json["traits"][name] = value;
    }
  }
  json["parameters"] = Json::array();
  for (const FieldSpec& spec : description.parameters) {
    json["parameters"].push_back(json_of(spec));
  }
  return json;
}

std::string parameter_table(const std::vector<FieldSpec>& parameters) {
  if (parameters.empty()) {
    return "None.\n";
  }
  std::string text = "| key | type | unit | default | range | meaning |\n";
  text += "|---|---|---|---|---|---|\n";
  for (const Row& row : rows_of(parameters)) {
    const FieldSpec& spec = *row.spec;
    const std::string value = default_text(spec);
    text += "|" + cell("`" + row.key + "`") + "|" + cell(type_text(spec)) + "|" + cell(spec.unit) +
            "|" + cell(value.empty() || spec.required ? value : "`" + value + "`") + "|" +
            cell(range_text(spec)) + "|" + cell(spec.doc) + "|\n";
  }
  return text;
}
}  // namespace altiplan::host
