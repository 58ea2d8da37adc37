// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <map>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace {

using Declared = ScriptField::Value;

template <class T>
Declared plain(const Json& value) {
  return value.is_null() ? Declared(T{}) : Declared(value.get<T>());
}

/// The value of a field, or an optional one.
template <class T, class Make>
Declared either(const Json& field, const Make& make) {
  const Json& value = field.at("default");
  if (!field.at("optional").get<bool>()) {
    return value.is_null() ? Declared(T{}) : Declared(make(value));
  }
  return value.is_null() ? Declared(std::optional<T>()) : Declared(std::optional<T>(make(value)));
}

Declared default_of(const Json& field) {
  const auto type = field.at("type").get<std::string>();
  const Json& value = field.at("default");
  if (type == "boolean") {
    return either<bool>(field, [](const Json& v) { return v.get<bool>(); });
  }
  if (type == "integer") {
    return either<std::int64_t>(field, [](const Json& v) { return v.get<std::int64_t>(); });
  }
  if (type == "number") {
    return either<double>(field, [](const Json& v) { return v.get<double>(); });
  }
  if (type == "text") {
    return either<std::string>(field, [](const Json& v) { return v.get<std::string>(); });
  }
  if (type == "path") {
    return either<Path>(field, [](const Json& v) { return Path{v.get<std::string>()}; });
  }
  if (type == "vec2") {
    return plain<std::array<double, 2>>(value);
  }
  if (type == "vec3") {
    const auto three = std::get<std::vector<double>>(plain<std::vector<double>>(value));
    return three.size() == 3 ? Vec3(three[0], three[1], three[2]) : Vec3(Vec3::Zero());
  }
  if (type == "list of integer") {
    return plain<std::vector<std::int64_t>>(value);
  }
  if (type == "list of number") {
    return plain<std::vector<double>>(value);
  }
  return plain<std::vector<std::string>>(value);
}

ScriptField field_of(const Json& declared) {
  ScriptField field;
  FieldSpec& spec = field.spec;
  spec.name = declared.at("name").get<std::string>();
  if (!is_snake_case(spec.name)) {
    throw PluginError("a parameter is named " + excerpt(spec.name) +
                      ", expected lower-case letters, digits and '_'");
  }
  spec.unit = declared.at("unit").get<std::string>();
  spec.doc = declared.at("doc").get<std::string>();
  spec.required = declared.at("required").get<bool>();
  spec.min = declared.at("min").is_null() ? -kInfinity : declared.at("min").get<double>();
  spec.max = declared.at("max").is_null() ? kInfinity : declared.at("max").get<double>();
  spec.above = declared.at("above").get<bool>();
  spec.min_items = declared.at("min_items").get<std::size_t>();
  spec.choices = declared.at("choices").get<std::vector<std::string>>();
  field.value = default_of(declared);
  return field;
}
}  // namespace

ScriptParams::ScriptParams(const Json& declared) {
  try {
    for (const Json& field : declared) {
      fields_.push_back(field_of(field));
    }
  } catch (const nlohmann::json::exception& error) {
    throw PluginError(std::string("its parameters cannot be read: ") + error.what());
  }
}

void ScriptParams::describe(Fields& fields) {
  for (ScriptField& field : fields_) {
    const FieldSpec& declared = field.spec;
    FieldRef ref =
        std::visit([&](auto& value) { return fields(declared.name, value); }, field.value);
    ref.unit(declared.unit).doc(declared.doc).min_items(declared.min_items);
    if (declared.required) {
      ref.required();
    }
    FieldSpec& spec = fields.bound().back().spec;
    spec.above = declared.above;
    spec.min = std::max(spec.min, declared.min);
    spec.max = std::min(spec.max, declared.max);
    if (!declared.choices.empty()) {
      spec.type = FieldType::choice;
      spec.choices = declared.choices;
    }
  }
}
}  // namespace altiplan::host
