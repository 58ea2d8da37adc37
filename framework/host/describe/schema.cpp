// SPDX-License-Identifier: Apache-2.0
#include "host/describe/schema.hpp"

#include <algorithm>
#include <cmath>

#include "host/config/config.hpp"

namespace altiplan::host {
namespace {

constexpr const char* kDraft = "http://json-schema.org/draft-07/schema#";

/// Writes schemas; the parameters of each plugin are written once, into `definitions`.
class Writer {
 public:
  explicit Writer(const Choices& choices) : choices_(choices) {}

  Json& definitions() { return definitions_; }

  /// A map with exactly these keys.
  Json object(const std::vector<FieldSpec>& fields) {
    Json schema = {{"type", "object"}, {"properties", Json::object()}};
    Json required = Json::array();
    Json all_of = Json::array();
    for (const FieldSpec& field : fields) {
      if (field.type == FieldType::point) {
        add_point(field, schema["properties"], all_of);
      } else if (field.type == FieldType::plugin) {
        add_plugin(field, schema["properties"], all_of);
      } else {
        schema["properties"][field.name] = described(field);
        if (field.required) {
          required.push_back(field.name);
        }
      }
    }
    if (!required.empty()) {
      schema["required"] = std::move(required);
    }
    schema["additionalProperties"] = false;
    if (!all_of.empty()) {
      schema["allOf"] = std::move(all_of);
    }
    return schema;
  }

  /// Names offered for a kind; adds their parameters to the definitions.
  std::vector<Choice> named(const std::string& kind) {
    std::vector<Choice> all = choices_(kind);
    for (const Choice& choice : all) {
      const std::string key = kind + "_" + choice.name;
      if (!definitions_.contains(key)) {
        definitions_[key] = nullptr;  // reserves the entry, and ends a recursion
        Json schema = object(choice.parameters);
        definitions_[key] = std::move(schema);
      }
    }
    return all;
  }
  static Json reference(const std::string& kind, const std::string& name) {
    return {{"$ref", "#/definitions/" + kind + "_" + name}};
  }

  static bool needs_parameters(const Choice& choice) {
    return std::any_of(choice.parameters.begin(), choice.parameters.end(),
                       [](const FieldSpec& field) { return field.required; });
  }

  Json described(const FieldSpec& field) {
    Json schema = value(field, field);
    const std::string unit = field.unit.empty() ? "" : "[" + field.unit + "]";
    const std::string text = field.doc + (field.doc.empty() || unit.empty() ? "" : " ") + unit;
    if (!text.empty()) {
      schema["description"] = text;
    }
    if (!field.default_json.empty() && field.type != FieldType::structure) {
      Json given = json_or_discarded(field.default_json);
      if (!given.is_discarded() && !given.is_null()) {
        schema["default"] = std::move(given);
      }
    }
    return schema;
  }

 private:
  /// The bounds belong to the field, even if it is a list of numbers.
  static Json number(const char* type, const FieldSpec& field) {
    Json schema = {{"type", type}};
    if (std::isfinite(field.min)) {
      schema[field.above ? "exclusiveMinimum" : "minimum"] = field.min;
    }
    if (std::isfinite(field.max)) {
      schema["maximum"] = field.max;
    }
    return schema;
  }
  static Json numbers(std::size_t min_items, std::size_t max_items, const FieldSpec& field) {
    return {{"type", "array"},
            {"items", number("number", field)},
            {"minItems", min_items},
            {"maxItems", max_items}};
  }

  Json value(const FieldSpec& shape, const FieldSpec& field) {
    switch (shape.type) {
      case FieldType::boolean:
        return {{"type", "boolean"}};
      case FieldType::integer:
        return number("integer", field);
      case FieldType::number:
        return number("number", field);
      case FieldType::auto_number:
        return {{"anyOf", Json::array({number("number", field), {{"const", "auto"}}})}};
      case FieldType::text:
      case FieldType::path:
        return {{"type", "string"}};
      case FieldType::choice:
        return {{"enum", field.choices}};
      case FieldType::vec2:
        return numbers(2, 2, field);
      case FieldType::vec3:
        return numbers(3, 3, field);
      case FieldType::list: {
        Json schema = {{"type", "array"}, {"items", value(shape.children.at(0), field)}};
        if (shape.min_items > 0) {
          schema["minItems"] = shape.min_items;
        }
        return schema;
      }
      case FieldType::structure:
        return object(shape.children);
      default:
        return Json::object();
    }
  }

  /// at_m, at_lonlat or at_cell, with the height in the point or above the ground.
  static void add_point(const FieldSpec& field, Json& properties, Json& all_of) {
    Json one_of = Json::array();
    Json none = Json::array();
    const FieldSpec unbounded;
    for (const auto& [key, text] :
         {std::pair{"at_m", "east, north, height above sea level [m]"},
          std::pair{"at_lonlat", "longitude, latitude [deg], height above sea level [m]"},
          std::pair{"at_cell", "a cell of the layer that has cells"}}) {
      properties[key] = numbers(2, 3, unbounded);
      properties[key]["description"] = text;
      one_of.push_back({{"required", Json::array({key})}});
      none.push_back(one_of.back());
    }
    properties["above_ground_m"] = {{"type", "number"},
                                    {"description", "height above the ground there [m]"}};
    if (!field.required) {
      one_of.push_back({{"not", {{"anyOf", std::move(none)}}}});
    }
    all_of.push_back({{"oneOf", std::move(one_of)}});
  }

  /// Exactly one key: a plugin's name, with its parameters as value.
  void add_plugin(const FieldSpec& field, Json& properties, Json& all_of) {
    const std::string& kind = field.choices.at(0);
    Json one_of = Json::array();
    for (const Choice& choice : named(kind)) {
      if (!properties.contains(choice.name)) {
        properties[choice.name] = reference(kind, choice.name);
      }
      one_of.push_back({{"required", Json::array({choice.name})}});
    }
    if (one_of.empty()) {
      one_of.push_back(false);  // nothing is offered, so nothing is valid
    }
    if (!field.required) {
      Json none = {{"not", {{"anyOf", one_of}}}};
      one_of.push_back(std::move(none));
    }
    all_of.push_back({{"oneOf", std::move(one_of)}});
  }

  const Choices& choices_;
  Json definitions_ = Json::object();
};

Json names_of(const std::vector<Choice>& choices) {
  Json names = Json::array();
  for (const Choice& choice : choices) {
    names.push_back(choice.name);
  }
  return names;
}

/// Restricts `with` to the parameters of the plugin that the verb names.
void add_parameter_rules(const std::string& verb, const std::string& kind, Writer& writer,
                         Json& all_of, Json& names) {
  for (const Choice& choice : writer.named(kind)) {
    names.push_back(choice.name);
    Json then = {{"properties", {{"with", Writer::reference(kind, choice.name)}}}};
    if (Writer::needs_parameters(choice)) {
      then["required"] = Json::array({"with"});
    }
    all_of.push_back(
        {{"if",
          {{"properties", {{verb, {{"const", choice.name}}}}}, {"required", Json::array({verb})}}},
         {"then", std::move(then)}});
  }
}

/// A step: the keys common to all verbs, those of its verb, and the parameters by plugin.
Json step_schema(Writer& writer) {
  const Json a_step = {{"$ref", "#/definitions/step"}};
  Json properties = Json::object();
  for (const FieldSpec& field : fields_of<StepEntry>()) {
    if (field.name != "smooth") {
      properties[field.name] = writer.described(field);
    }
  }
  properties["with"]["type"] = "object";
  properties["else"]["items"] = a_step;
  properties["replan"]["anyOf"] = Json::array({{{"type", "string"}}, a_step});
  Json smoothers;
  Json only_flying = Json::object();
  for (const FieldSpec& field : fields_of<FlyKeys>()) {
    if (field.name == "smooth") {
      smoothers = writer.described(field);
    } else {
      only_flying[field.name] = false;
    }
  }

  Json all_of = Json::array();
  Json planners = Json::array();
  Json pilots = Json::array({kFollowRoute});
  Json unused = Json::array();
  add_parameter_rules("plan", "planner", writer, all_of, planners);
  add_parameter_rules("plan", "local_planner", writer, all_of, planners);
  add_parameter_rules("fly", "local_planner", writer, all_of, pilots);
  add_parameter_rules("smooth", "smoother", writer, all_of, unused);
  properties["plan"]["enum"] = std::move(planners);
  properties["fly"]["enum"] = std::move(pilots);
  properties["smooth"] = Json::object();

  Json not_flying = only_flying;
  not_flying["smooth"] = {{"enum", names_of(writer.named("smoother"))},
                          {"description", "a smoother"}};
  all_of.push_back(
      {{"if", {{"required", Json::array({"fly"})}}},
       {"then", {{"properties", {{"smooth", smoothers}, {"plan", false}, {"returns", false}}}}},
       {"else",
        {{"properties", std::move(not_flying)},
         {"oneOf", Json::array({{{"required", Json::array({"plan"})}},
                                {{"required", Json::array({"smooth"})}},
                                {{"required", Json::array({"returns"})}}})}}}});
  Json not_judging = Json::object();
  for (const char* key : {"with", "from", "within_s", "within_iterations", "within_mb", "else"}) {
    not_judging[key] = false;
  }
  all_of.push_back({{"if", {{"required", Json::array({"returns"})}}},
                    {"then", {{"properties", std::move(not_judging)}}},
                    {"else", {{"properties", {{"params", false}}}}}});
  all_of.push_back({{"if", {{"required", Json::array({"plan"})}}},
                    {"then", {{"properties", {{"from", false}}}}}});
  return {{"type", "object"},
          {"properties", std::move(properties)},
          {"additionalProperties", false},
          {"allOf", std::move(all_of)}};
}

Json file_schema(const char* title, const Json& body, Writer& writer) {
  Json schema = {{"$schema", kDraft}, {"title", title}};
  schema.update(body);
  if (!writer.definitions().empty()) {
    schema["definitions"] = writer.definitions();
  }
  return schema;
}

/// A mission may replace the start, and the goal or its position; a task needs neither.
Json scenario_body(Writer& writer) {
  Json body = writer.object(fields_of<ScenarioFile>());
  Json& required = body["required"];
  for (const char* key : {"start", "goal"}) {
    required.erase(std::find(required.begin(), required.end(), key));
  }
  Json placed_goal = body["properties"]["goal"];
  body["properties"]["goal"].erase("allOf");
  body["anyOf"] = Json::array({{{"required", Json::array({"mission"})}},
                               {{"required", Json::array({"task"})}},
                               {{"required", Json::array({"start", "goal"})},
                                {"properties", {{"goal", std::move(placed_goal)}}}}});
  return body;
}

Json pipeline_body(Writer& writer) {
  Json body = writer.object(fields_of<PipelineFile>());
  body["properties"]["steps"]["items"] = {{"$ref", "#/definitions/step"}};
  Json step = step_schema(writer);
  writer.definitions()["step"] = std::move(step);
  return body;
}

Json study_body(Writer& writer, const std::vector<FieldSpec>& study) {
  Json body = writer.object(study);
  for (const char* list : {"scenarios", "pipelines"}) {
    body["properties"][list]["items"]["properties"]["set"]["type"] = "object";
  }
  return body;
}

/// Figures are text for the reader, but numbers for YAML unless they are quoted.
Json paper_body(Writer& writer, const std::vector<FieldSpec>& paper) {
  Json body = writer.object(paper);
  const Json figure = {{"type", {"string", "number"}}};
  Json& table = body["properties"]["tables"]["items"]["properties"];
  Json& row = table["rows"]["items"]["properties"];
  Json& claim = table["claims"]["items"]["properties"];
  row["paper"]["items"] = row["documentation"]["items"] = figure;
  claim["paper"].update(figure);
  claim["measured"].update(figure);
  return body;
}

const Choices kNothing = [](std::string_view) { return std::vector<Choice>{}; };
}  // namespace

Json schema_of(const std::vector<FieldSpec>& fields, const Choices& choices) {
  Writer writer(choices);
  Json schema = writer.object(fields);
  if (!writer.definitions().empty()) {
    schema["definitions"] = writer.definitions();
  }
  return schema;
}

Json scenario_schema(const Choices& choices) {
  Writer writer(choices);
  return file_schema("altiplan scenario", scenario_body(writer), writer);
}

Json pipeline_schema(const Choices& choices) {
  Writer writer(choices);
  return file_schema("altiplan pipeline", pipeline_body(writer), writer);
}

Json study_schema(const std::vector<FieldSpec>& study) {
  Writer writer(kNothing);
  return file_schema("altiplan study", study_body(writer, study), writer);
}

Json any_file_schema(const Choices& choices, const std::vector<FieldSpec>& study,
                     const std::vector<FieldSpec>& paper) {
  Writer writer(choices);
  // The same keys as in kind_of determine a file's kind.
  const Json is_study = {{"anyOf", Json::array({{{"required", Json::array({"pipelines"})}},
                                                {{"required", Json::array({"scenarios"})}}})}};
  const Json is_scenario = {{"anyOf", Json::array({{{"required", Json::array({"environment"})}},
                                                   {{"required", Json::array({"start"})}},
                                                   {{"required", Json::array({"goal"})}},
                                                   {{"required", Json::array({"task"})}},
                                                   {{"required", Json::array({"mission"})}}})}};
  const Json other = {
      {"if", is_scenario}, {"then", scenario_body(writer)}, {"else", pipeline_body(writer)}};
  Json body = {{"if", {{"required", Json::array({"tables"})}}},
               {"then", paper_body(writer, paper)},
               {"else", {{"if", is_study}, {"then", study_body(writer, study)}, {"else", other}}}};
  return file_schema("altiplan file: pipeline, scenario, study or paper", body, writer);
}
}  // namespace altiplan::host
