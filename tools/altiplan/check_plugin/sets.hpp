// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/conformance.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::cli {

struct VolumeParams {
  Vec3 min_m{0, 0, 0};
  Vec3 max_m{0, 0, 0};
  void describe(Fields& f);
};

/// One entry of a conformance.yaml: parameters with which plugins are checked.
struct ParameterSet {
  std::optional<std::string> plugin;
  Value with;
  std::optional<Value> tighter;
  double unit_m = conformance::Options{}.unit_m;
  std::int64_t iterations = std::int64_t(conformance::Options{}.iterations);
  std::optional<VolumeParams> volume;
  std::vector<Value> before;

  ParameterSet() { with.kind = Value::Kind::map; }
  void describe(Fields& f);

  /// Adds to `tighter` the parameters of `with` that it lacks.
  void inherit();
  /// The first layer of `before` that no library provides; "" if all are found.
  std::string missing_layer(host::Registry& registry) const;
  /// The setup refers to this set's values. The layers before it come from the registry's
  /// libraries; throws Error if one cannot be created.
  conformance::Setup setup(host::Registry& registry) const;
};

/// Reads the sets of a file (docs/reference/conformance.md). Throws ConfigError.
std::vector<ParameterSet> parameter_sets(const std::filesystem::path& file);
}  // namespace altiplan::cli
