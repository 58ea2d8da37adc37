// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan {

/// Replanning while the vehicle flies: keeps its last result and takes changes.
/// Contract: 1. update continues from the given state; its route begins at that position.
/// 2. After an update, result() is what update returned. A violation, or an exception, becomes a
///    PluginError, after which the session can be used again.
class ALTIPLAN_API Session {
 public:
  virtual ~Session();
  const PlanResult& result() const { return do_result(); }
  /// `world` is the known world after `changes` (since the last call).
  PlanResult update(const State& state, const Goal& goal, std::shared_ptr<const World> world,
                    std::span<const Change> changes, const Budget& budget);

 private:
  virtual const PlanResult& do_result() const = 0;
  virtual const PlanResult& do_update(const State& state, const Goal& goal,
                                      std::shared_ptr<const World> world,
                                      std::span<const Change> changes, const Budget& budget) = 0;
};

/// The `invalid_problem` result if start or goal violate a constraint; its reason says which. The
/// public functions check this before they call a planner; a session checks it at its updates.
ALTIPLAN_API std::optional<PlanResult> impossible_ends(const Request& request);

/// Why a planner with these traits cannot minimise the objective, as the rest of a sentence
/// ("minimises length alone …"); "" if it can. The public functions check this too.
ALTIPLAN_API std::string objective_problem(const Objective& objective, const Traits& traits);

/// Plans a whole route. Constructed from its parameters; const and shareable.
///
/// Contract, checked by the public functions where possible, else by the conformance suite:
///  1. The route starts at request.start.position exactly and ends within the goal's tolerance.
///  2. Every leg satisfies leg_ok of check.hpp.
///  3. `solved` if and only if a route is returned; no route is a status, never an exception. A
///     violation of the contract, or an exception, becomes a PluginError.
///  4. The budget is kept; the stop token is honoured within 1,024 iterations.
///  5. Two calls with equal requests give equal results, on any threads, in any order.
class ALTIPLAN_API Planner {
 public:
  virtual ~Planner();
  PlanResult plan(const Request& request) const;
  /// Plans, and keeps its search state for updates. The session may refer to the planner, which
  /// must outlive it, but not to the request. Where the budget ends before it has begun, the
  /// session replans from scratch.
  std::unique_ptr<Session> begin(const Request& request) const;
  Traits traits() const { return do_traits(); }

 private:
  virtual PlanResult do_plan(const Request& request) const = 0;

 protected:
  /// Default: replans from scratch at every update.
  virtual std::unique_ptr<Session> do_begin(const Request& request) const;

 private:
  virtual Traits do_traits() const = 0;
};
}  // namespace altiplan
