// SPDX-License-Identifier: Apache-2.0
#include "maker.hpp"

namespace altiplan::conformance {

Cases cases_of(const PluginEntry& entry, const Setup& setup) {
  const Options& options = setup.options;
  const auto stricter = [&] {
    const std::shared_ptr<const Value> tighter = kept(setup.tighter);
    return tighter ? [entry,
                      tighter](const Site& site) { return entry.constraint(tighter.get(), site); }
                   : ConstraintFactory();
  };
  return with_factory(
      entry, setup.with,
      Overloaded{
          [&](const EnvironmentFactory& make) {
            return environment_cases(make, options, setup.before);
          },
          [&](const ConstraintFactory& make) {
            return constraint_cases(make, stricter(), options, setup.before);
          },
          [&](const Factory<Planner>& make) { return planner_cases(make, options); },
          [&](const Factory<LocalPlanner>& make) { return local_planner_cases(make, options); },
          [&](const Factory<Smoother>& make) { return smoother_cases(make, options); },
          [&](const Factory<Tuner>& make) { return tuner_cases(make, options); },
          [&](const ObjectiveFactory& make) {
            return objective_cases(make, options, setup.before);
          },
          [&](const TaskFactory& make) { return task_cases(make, options, setup.before); }});
}
}  // namespace altiplan::conformance
