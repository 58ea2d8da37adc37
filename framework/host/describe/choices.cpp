// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "host/base/built_in.hpp"
#include "host/base/shapes.hpp"
#include "host/config/config.hpp"
#include "host/describe/describe.hpp"
#include "host/describe/schema.hpp"

namespace altiplan::host {
namespace {

std::vector<FieldSpec> specs_of(const ParamReport& report) {
  std::vector<FieldSpec> specs;
  for (const BoundField& field : report.fields) {
    specs.push_back(field.spec);
  }
  return specs;
}
}  // namespace

Choices choices_of(Registry& registry) {
  std::set<std::string> usable;
  for (const Library& library : examine_all(registry)) {
    for (const Manifest& entry : library.plugins) {
      if (library.refused.empty()) {
        usable.insert(std::string(entry.kind) + " " + entry.name);
      }
    }
  }
  return [&registry, usable](std::string_view kind) {
    std::vector<Choice> all;
    if (kind == "moving") {
      for (const std::string& shape : moving_shapes()) {
        all.push_back({shape, specs_of(describe_moving(shape)(nullptr, ""))});
      }
      all.push_back({"random", fields_of<RandomMoving>()});
      return all;
    }
    std::set<std::string> names;
    for (const std::string& name : registry.names(kind)) {
      if (usable.contains(std::string(kind) + " " + name)) {
        names.insert(name);
      }
    }
    for (const PluginEntry& entry : built_in_plugins()) {
      if (kind == entry.kind) {
        names.insert(entry.name);
      }
    }
    for (const std::string& name : names) {
      all.push_back({name, specs_of(plugin(registry, kind, name).describe(nullptr, ""))});
    }
    return all;
  };
}
}  // namespace altiplan::host
