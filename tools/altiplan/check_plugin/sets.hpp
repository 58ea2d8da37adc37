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

/// One entry of a conformance.yaml: parameters under which plugins are held to their laws.
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

  /// The first layer of `before` that no library offers; "" where all are there.
  std::string missing_layer(const host::Registry& registry) const;
  /// The values in `setup` are this set's. The layers before it come from the registry's libraries;
  /// throws Error where one cannot be made.
  conformance::Setup setup(host::Registry& registry) const;
};

/// Those of the file (docs/reference/conformance.md). Throws ConfigError.
std::vector<ParameterSet> parameter_sets(const std::filesystem::path& file);
}  // namespace altiplan::cli
