// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/kit/layers/field_layer.hpp"
#include "altiplan/kit/layers/scalar_field.hpp"
#include "host/base/shapes.hpp"
#include "host/scripts/object.hpp"
#include "host/scripts/values.hpp"

namespace altiplan::host {
namespace {

constexpr std::chrono::seconds kBuildTimeout(600);  ///< to build a layer

/// As if a file had the values.
Value value_of(const Json& json) {
  Value value;
  if (json.is_array()) {
    value.kind = Value::Kind::list;
    for (const Json& item : json) {
      value.items.push_back(value_of(item));
    }
  } else if (json.is_object()) {
    value.kind = Value::Kind::map;
    for (const auto& [key, item] : json.items()) {
      value.entries.push_back({key, {}, value_of(item)});
    }
  } else {
    value.quoted = json.is_string();
    value.text = json.is_string() ? json.get<std::string>() : exact_json_text(json);
  }
  return value;
}

/// The shapes of one solid, written as in a scenario: {"box": {"min_m": …, "max_m": …}}.
std::vector<Shape> shapes_of(const std::string& kind, const Json& keys, const std::string& which,
                             const Site& site) {
  std::vector<std::string> kinds;
  for (const PluginEntry& entry : built_in_environments()) {
    kinds.emplace_back(entry.name);
    if (kind != entry.name) {
      continue;
    }
    const Value value = value_of(keys);
    const ParamReport report = entry.describe(&value, which + "." + kind);
    if (!report.problems.empty()) {
      throw PluginError(report.problems.front().key + ": " + report.problems.front().message);
    }
    const std::unique_ptr<Environment> made = entry.environment(&value, site);
    return dynamic_cast<const kit::ShapeLayer&>(*made).set().shapes();
  }
  std::string expected;
  for (const std::string& one : kinds) {
    expected += (expected.empty() ? "" : ", ") + one;
  }
  throw PluginError(which + ": expected one of " + expected + ", found " + excerpt(kind));
}

std::unique_ptr<Environment> solids_of(const Json& solids, const Site& site) {
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const auto only = solids[i].items().begin();
    const std::string which = "solid " + std::to_string(i);
    for (Shape& shape : shapes_of(only.key(), only.value(), which, site)) {
      shapes.push_back(std::move(shape));
    }
  }
  LayerInfo info;
  info.threats = kit::threats_of(shapes);
  info.notes = {std::to_string(shapes.size()) + (shapes.size() == 1 ? " solid" : " solids")};
  return std::make_unique<kit::ShapeLayer>(std::move(shapes), std::move(info));
}

Vec3 vector_of(const Json& three) {
  return {three.at(0).get<double>(), three.at(1).get<double>(), three.at(2).get<double>()};
}

std::unique_ptr<Environment> cells_of(const Json& reported, const std::vector<double>& numbers) {
  GridSpec spec;
  spec.origin = vector_of(reported.at("origin_m"));
  spec.cell = vector_of(reported.at("cell_m"));
  spec.counts = reported.at("counts").get<Cell>();
  spec.rule = GridSpec::Rule::native;
  VoxelGrid grid(spec);
  std::size_t at = 0;  // the last axis of the array is the fastest
  for (int i = 0; i < spec.counts[0]; ++i) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      for (int k = 0; k < spec.counts[2]; ++k) {
        if (numbers.at(at++) != 0) {
          grid.set({i, j, k}, true);
        }
      }
    }
  }
  const std::string note = std::to_string(grid.blocked_count()) + " of " +
                           std::to_string(spec.cell_count()) + " cells are blocked";
  return std::make_unique<kit::CellLayer>(std::move(grid), std::vector{note});
}

class ScriptGround final : public kit::FieldLayer<kit::WholeField> {
 public:
  ScriptGround(HeightField field, double vehicle_radius)
      : FieldLayer(vehicle_radius, std::move(field)) {
    const HeightField& posts = model().field();
    char note[120];
    std::snprintf(note, sizeof note, "%d x %d posts of %.1f x %.1f m, %.0f to %.0f m",
                  posts.columns(), posts.rows(), posts.spacing()[0], posts.spacing()[1],
                  posts.min_height(), posts.max_height());
    info_.notes = {note};
  }

 private:
  const LayerInfo& do_info() const override { return info_; }
  LayerInfo info_;
};

std::unique_ptr<Environment> ground_of(const Json& reported, const std::vector<double>& numbers,
                                       const Site& site) {
  HeightField field(reported.at("origin_m").get<std::array<double, 2>>(),
                    reported.at("spacing_m").get<std::array<double, 2>>(),
                    reported.at("counts").at(0).get<int>(), reported.at("counts").at(1).get<int>(),
                    {numbers.begin(), numbers.end()});
  return std::make_unique<ScriptGround>(std::move(field), site.vehicle.radius_m);
}
}  // namespace

namespace {
ScriptMessage built_by(ScriptSource source, const Site& site) {
  return ScriptObject(std::move(source))
      .answer({{{"build", script_values(site)}}, {}}, {site.before, nullptr, &site.frame},
              kBuildTimeout);
}
}  // namespace

std::unique_ptr<Objective> script_objective(ScriptSource source, const Site& site) {
  const ScriptMessage built = built_by(std::move(source), site);
  const Json& field = built.head.at("field");
  const Json& elsewhere = field.at("elsewhere");
  kit::Posts posts;  // on one level where the field has no third axis
  for (std::size_t axis = 0; axis < field.at("counts").size(); ++axis) {
    posts.counts[axis] = field["counts"][axis].get<int>();
    posts.step[axis] = field.at("spacing_m").at(axis).get<double>();
    posts.origin[axis] = field.at("origin_m").at(axis).get<double>();
  }
  return std::make_unique<kit::FieldIntegral>(
      kit::ScalarField(posts, {built.numbers.begin(), built.numbers.end()},
                       elsewhere.is_null() ? kInfinity : elsewhere.get<double>()),
      field.at("unit").get<std::string>());
}

std::unique_ptr<Environment> script_environment(ScriptSource source, const Site& site) {
  const ScriptMessage built = built_by(std::move(source), site);
  if (built.head.contains("ground")) {
    return ground_of(built.head["ground"], built.numbers, site);
  }
  if (built.head.contains("cells")) {
    return cells_of(built.head["cells"], built.numbers);
  }
  return solids_of(built.head.at("solids"), site);
}
}  // namespace altiplan::host
