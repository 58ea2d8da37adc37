// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "altiplan/conformance.hpp"

namespace altiplan::conformance {

Cases cases_of(const PluginEntry& entry, const Setup& setup) {
  // The cases may outlive the caller's values.
  const auto copy = [](const Value* value) {
    return value != nullptr ? std::make_shared<const Value>(*value) : nullptr;
  };
  const std::shared_ptr<const Value> with = copy(setup.with);
  const std::shared_ptr<const Value> tighter = copy(setup.tighter);
  const Options& options = setup.options;
  if (entry.environment != nullptr) {
    return environment_cases(
        [entry, with](const Site& site) { return entry.environment(with.get(), site); }, options,
        setup.before);
  }
  if (entry.constraint != nullptr) {
    const auto by = [entry](std::shared_ptr<const Value> value) {
      return [entry, value = std::move(value)] { return entry.constraint(value.get()); };
    };
    return constraint_cases(by(with), tighter ? Factory<Constraint>(by(tighter)) : nullptr,
                            options);
  }
  if (entry.planner != nullptr) {
    return planner_cases([entry, with] { return entry.planner(with.get()); }, options);
  }
  if (entry.local_planner != nullptr) {
    return local_planner_cases([entry, with] { return entry.local_planner(with.get()); }, options);
  }
  if (entry.smoother != nullptr) {
    return smoother_cases([entry, with] { return entry.smoother(with.get()); }, options);
  }
  if (entry.tuner != nullptr) {
    return tuner_cases([entry, with] { return entry.tuner(with.get()); }, options);
  }
  return {};
}
}  // namespace altiplan::conformance
