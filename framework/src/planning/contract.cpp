// SPDX-License-Identifier: Apache-2.0
#include "contract.hpp"

#include <algorithm>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/leg_limits.hpp"

namespace altiplan {

PlanResult guarded(const std::function<PlanResult()>& call) {
  try {
    return call();
  } catch (const ParameterError&) {
    throw;
  } catch (const PluginError&) {
    throw;
  } catch (const BudgetSpent& spent) {
    PlanResult result;
    result.status = spent.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    result.reason = spent.cancelled() ? Reason::none : Reason::deadline;
    result.budget_hit = true;
    result.message = (spent.cancelled() ? "cancelled: " : "the budget was used up: ") +
                     std::string(spent.what());
    result.counters = {{"expanded", 0}};
    return result;
  } catch (...) {
    attribute_to("");
  }
}

bool legs_are_well_formed(const Route& route) {
  if (route.is_straight()) {
    return std::all_of(route.begin(), route.end(), is_finite);
  }
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    if (!is_well_formed(route.leg(i))) {
      return false;
    }
  }
  return true;
}

namespace {
/// The part of its budget that ended a plan, as far as that is visible from outside.
Reason spent_part(const PlanResult& result, const Budget& budget) {
  for (const Counter& counter : result.counters) {
    if (counter.name == "expanded" && std::uint64_t(counter.value) >= budget.max_iterations) {
      return Reason::iterations;
    }
  }
  return budget.deadline && Budget::Clock::now() >= *budget.deadline ? Reason::deadline
                                                                     : Reason::none;
}
}  // namespace

PlanResult held_to_contract(PlanResult result, const State& start, const Goal& goal,
                            const Budget& budget) {
  if (result.status == PlanStatus::timed_out && result.reason == Reason::none) {
    result.reason = spent_part(result, budget);
  }
  const auto broken = [](Reason reason, const std::string& how) {
    return PluginError("the planner violated the contract of its interface: " + how, reason);
  };
  if (result.status == PlanStatus::no_route && result.message.empty()) {
    throw broken(Reason::contract, "returns no route and gives no reason");
  }
  if (result.status != PlanStatus::solved) {
    return result;
  }
  if (result.route.empty()) {
    throw broken(Reason::contract, "reports solved but returns no route");
  }
  if (!std::all_of(result.route.begin(), result.route.end(), is_finite)) {
    throw broken(Reason::contract, "returns a route with a coordinate that is not finite");
  }
  if (!legs_are_well_formed(result.route)) {
    throw broken(Reason::contract, kMalformedLeg);
  }
  if (!start.starts_at(result.route.front())) {
    throw broken(Reason::contract_of_ends, "returns a route that does not begin at the start");
  }
  if (!goal.reached_at(result.route.back())) {
    throw broken(Reason::contract_of_ends,
                 "returns a route that ends " +
                     std::to_string((result.route.back() - goal.position).norm()) +
                     " m from the goal, outside its tolerance");
  }
  return result;
}
}  // namespace altiplan
