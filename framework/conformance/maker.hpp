// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "altiplan/conformance.hpp"

namespace altiplan::conformance {

/// The cases may outlive the caller's values.
inline std::shared_ptr<const Value> kept(const Value* value) {
  return value != nullptr ? std::make_shared<const Value>(*value) : nullptr;
}

/// Calls `visit` with the factory of the entry's kind and returns its result; its type's default if
/// the entry has no factory.
template <class Visit>
auto with_factory(const PluginEntry& entry, const Value* parameters, const Visit& visit) {
  const std::shared_ptr<const Value> with = kept(parameters);
  using Result = decltype(visit(Factory<Planner>()));
  if (entry.environment != nullptr) {
    return visit(EnvironmentFactory(
        [entry, with](const Site& site) { return entry.environment(with.get(), site); }));
  }
  if (entry.constraint != nullptr) {
    return visit(ConstraintFactory(
        [entry, with](const Site& site) { return entry.constraint(with.get(), site); }));
  }
  if (entry.planner != nullptr) {
    return visit(Factory<Planner>([entry, with] { return entry.planner(with.get()); }));
  }
  if (entry.local_planner != nullptr) {
    return visit(Factory<LocalPlanner>([entry, with] { return entry.local_planner(with.get()); }));
  }
  if (entry.smoother != nullptr) {
    return visit(Factory<Smoother>([entry, with] { return entry.smoother(with.get()); }));
  }
  if (entry.tuner != nullptr) {
    return visit(Factory<Tuner>([entry, with] { return entry.tuner(with.get()); }));
  }
  if (entry.objective != nullptr) {
    return visit(ObjectiveFactory(
        [entry, with](const Site& site) { return entry.objective(with.get(), site); }));
  }
  if (entry.task != nullptr) {
    return visit(
        TaskFactory([entry, with](const Site& site) { return entry.task(with.get(), site); }));
  }
  return Result();
}

/// One callable made of several, for with_factory.
template <class... Visits>
struct Overloaded : Visits... {
  using Visits::operator()...;
};
template <class... Visits>
Overloaded(Visits...) -> Overloaded<Visits...>;
}  // namespace altiplan::conformance
