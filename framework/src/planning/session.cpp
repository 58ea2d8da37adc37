// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "altiplan/error.hpp"
#include "altiplan/planner.hpp"
#include "contract.hpp"

namespace altiplan {

Session::~Session() = default;

namespace {
bool same(const PlanResult& a, const PlanResult& b) {
  return a.status == b.status && a.message == b.message && a.route == b.route &&
         a.budget_hit == b.budget_hit && a.proved == b.proved &&
         std::equal(a.counters.begin(), a.counters.end(), b.counters.begin(), b.counters.end(),
                    [](const Counter& x, const Counter& y) {
                      return x.name == y.name && x.value == y.value;
                    });
}
}  // namespace

PlanResult Session::update(const State& state, const Goal& goal, std::shared_ptr<const World> world,
                           std::span<const Change> changes, const Budget& budget) {
  PlanResult result = held_to_contract(
      guarded([&] { return do_update(state, goal, std::move(world), changes, budget); }), state,
      goal, budget);
  const PlanResult shown = guarded([&] { return do_result(); });
  if (!same(result, shown)) {
    throw PluginError(
        "the session violated the contract of its interface: result() is not what update returned",
        Reason::contract_of_results);
  }
  return result;
}
}  // namespace altiplan
