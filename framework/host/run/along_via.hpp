// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "altiplan/planner.hpp"

namespace altiplan::host {

/// Plans one section, from a request's start to its goal.
using PlanPart = std::function<PlanResult(const Request&)>;

/// Plans start – via … – goal section by section and joins them; each section starts with the
/// heading at the end of the previous one. Where a planner uses all of its budget (`anytime`), each
/// section has an equal part of what is left.
PlanResult plan_along(Request request, const std::vector<Goal>& via, bool anytime,
                      const PlanPart& plan_part);

/// Plans a section in a wind that changes: in that of its start as far as it is flown before the
/// change, and anew from there; an `anytime` planner has an equal part of its budget for each
/// that may blow on the way. No route is proved to be none.
PlanResult plan_in_winds(const Request& request, bool anytime, const PlanPart& plan_part);

/// A session for planners without one: plans from scratch, past the via points still ahead.
class FreshVia final : public Session {
 public:
  FreshVia(Request request, std::vector<Goal> via, PlanPart plan_part, bool anytime);

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change> changes,
                              const Budget& budget) override;

  void take(PlanResult result);

  Request request_;
  std::vector<Goal> via_;  ///< still ahead
  PlanPart plan_part_;
  bool anytime_;
  PlanResult result_;
  Route flown_;  ///< the last route found
};
}  // namespace altiplan::host
