// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "altiplan/plugin_abi.hpp"

namespace altiplan::host {

/// Plugins of every kind that are built in: the shapes, the objectives `length` and `weighted`, and
/// the constraint `limit`.
const std::vector<PluginEntry>& built_in_plugins();

/// One of the objectives that `weighted` adds up: `{exposure: {…}, weight: 2}`.
struct ObjectiveTerm {
  std::string plugin;
  Value parameters;
  double weight = 1;
  void describe(Fields& f);
};

struct WeightedParams {
  std::vector<ObjectiveTerm> of;
  void describe(Fields& f);
};

/// The objective whose total `limit` limits.
struct LimitedObjective {
  std::string plugin;
  Value parameters;
  void describe(Fields& f);
};

struct LimitParams {
  LimitedObjective of;
  double maximum = 0;
  void describe(Fields& f);
};

/// Calls `visit(name, parameters, key)` of an objective and of all those that it adds up; `path` is
/// the key of its map ("objective"), `key` that of its parameters.
using VisitObjective =
    std::function<void(const std::string& name, const Value& parameters, const std::string& key)>;
void for_each_objective(const std::string& name, const Value& parameters, const std::string& path,
                        const VisitObjective& visit);
}  // namespace altiplan::host
