// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/json.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::host {

/// A name that a file may use, and its parameters.
struct Choice {
  std::string name;
  std::vector<FieldSpec> parameters;
};

/// The names available for a kind ("environment", "moving", "planner" …).
using Choices = std::function<std::vector<Choice>(std::string_view kind)>;

/// Built-in shapes and the plugins of the registry's libraries, except those that `examine_all`
/// refuses. The registry must outlive the result.
Choices choices_of(Registry& registry);

/// The declared fields of a struct.
template <class T>
std::vector<FieldSpec> fields_of() {
  T target;
  std::vector<FieldSpec> specs;
  for (BoundField& field : bind(target, nullptr).fields) {
    specs.push_back(std::move(field.spec));
  }
  return specs;
}

/// JSON Schemas (draft-07) of the files that users write; `study` declares the fields of a study.
Json scenario_schema(const Choices& choices);
Json pipeline_schema(const Choices& choices);
Json study_schema(const std::vector<FieldSpec>& study);
/// One schema for all, and for papers: the keys identify the kind of file.
Json any_file_schema(const Choices& choices, const std::vector<FieldSpec>& study,
                     const std::vector<FieldSpec>& paper);
/// Schema of a map with these fields; the parameters of plugins that it may name are in
/// `definitions`.
Json schema_of(const std::vector<FieldSpec>& fields, const Choices& choices);
}  // namespace altiplan::host
