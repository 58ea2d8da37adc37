// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/planner.hpp"
#include "plan.hpp"

namespace altiplan::dstar_lite {

/// Plans, and repairs the plan for as long as lattice and goal are unchanged.
class Replanner {
 public:
  /// Parameters and pools must outlive it.
  Replanner(const kit::SearchParams& params, const Request& request, Pools& pools)
      : params_(params), request_(request), pools_(pools) {}
  Replanner(const Replanner&) = delete;
  Replanner& operator=(const Replanner&) = delete;

  PlanResult plan() {
    if (auto answer = settled()) {
      return *std::move(answer);
    }
    return plan_afresh();
  }

  PlanResult update(const State& state, const Goal& goal, std::shared_ptr<const World> world,
                    std::span<const Change> changes, const Budget& budget) {
    const bool same_world = world == request_.world;
    const bool same_start =
        state.position == request_.start.position && state.velocity == request_.start.velocity;
    bool goes_on = plan_ && goal.position == request_.goal.position &&
                   goal.tolerance_m == request_.goal.tolerance_m &&
                   world->native_grid() == request_.world->native_grid();
    request_.start = state;
    request_.goal = goal;
    request_.world = std::move(world);
    request_.budget = budget;
    const kit::MoveCheck moves = settings_.moves;
    settings_ = params_.settings(request_);
    goes_on = goes_on && moves == settings_.moves;
    auto plan = std::exchange(plan_, nullptr);  // an interrupted change leaves none
    if (goes_on && !(same_world && same_start)) {
      // From another position, or in another world, a leg may lead to the goal itself.
      goes_on = !plan->within() && (same_world || plan->take(changes)) && plan->find_start();
    }
    if (goes_on) {
      plan_ = std::move(plan);
    }
    if (auto answer = settled()) {
      return *std::move(answer);
    }
    return plan_ ? finish(plan_->run()) : plan_afresh();
  }

 private:
  static constexpr double kGreatestError = 1e-4;  ///< largest relative error of a step's cost

  /// The result if no search is needed.
  std::optional<PlanResult> settled() const {
    if (auto impossible = impossible_ends(request_)) {
      return impossible;
    }
    PlanResult result;
    if (!request_.goal.reached_at(request_.start.position)) {
      return std::nullopt;
    }
    result.status = PlanStatus::solved;
    result.message = "the start is at the goal";
    result.route = {request_.start.position};
    result.counters = {{"expanded", 0}};
    return result;
  }

  PlanResult plan_afresh() {
    settings_ = params_.settings(request_);
    const std::size_t bytes = VertexMemory::kBytesPerCell +
                              (cells_decide(request_, settings_) ? 0 : LegMemory::kBytesPerCell);
    const kit::Lattice lattice(request_, settings_.cell_m, settings_.neighbours,
                               {params_.max_bytes(), bytes});
    if (auto refused = kit::beyond_budget(lattice, bytes, request_.budget)) {
      return *std::move(refused);
    }
    const Box box = lattice.spec().box();
    // Few paths are longer than four times this, except in mazes.
    return plan_on(lattice, 4 * (box.max - box.min).sum(), false, {});
  }

  /// Plans anew for paths up to that length, after a plan that has used part of the budget.
  PlanResult plan_on(const kit::Lattice& lattice, double longest_m, bool within,
                     const Counters& spent) {
    const auto scale = kit::StepCosts::between(settings_.costs, lattice, request_.start.position,
                                               request_.goal.position);
    const kit::StepCosts costs(lattice, scale, longest_m);
    if (costs.error() > kGreatestError) {
      PlanResult result;
      result.status = PlanStatus::invalid_problem;
      result.message = "dstar_lite cannot distinguish the lengths of paths up to " +
                       std::to_string(longest_m) + " m on such cells: use astar";
      result.counters = spent;
      return result;
    }
    request_.budget = kit::after(request_, spent).budget;
    plan_.reset();  // its memory is reused
    plan_ = std::make_unique<Plan>(request_, settings_, lattice, costs, within, pools_);
    PlanResult result = finish(plan_->run());
    if (!spent.empty()) {
      kit::add(result.counters, spent);
    }
    return result;
  }

  /// The result, or that of a new plan: with coarser lengths, or to the cells within the goal's
  /// tolerance if no leg leads to the goal itself.
  PlanResult finish(PlanResult result) {
    if (plan_->too_long()) {
      const kit::Lattice lattice = plan_->lattice();
      return plan_on(lattice, 4 * plan_->costs().longest_m(), plan_->within(), result.counters);
    }
    if (result.status != PlanStatus::no_route || request_.goal.tolerance_m == 0) {
      return result;
    }
    if (!plan_->within()) {
      to_goal_ = result;
      const kit::Lattice lattice = plan_->lattice();
      const double longest_m = plan_->costs().longest_m();
      return plan_on(lattice, longest_m, true, result.counters);
    }
    result.proved = result.proved && to_goal_.proved;
    result.message = to_goal_.message;
    return result;
  }

  const kit::SearchParams& params_;
  Request request_;
  kit::SearchSettings settings_;
  Pools& pools_;
  std::unique_ptr<Plan> plan_;
  PlanResult to_goal_;  ///< why no leg leads to the goal itself, for a plan within its tolerance
};

class DStarSession final : public Session {
 public:
  DStarSession(const kit::SearchParams& params, const Request& request, Pools& pools)
      : replanner_(params, request, pools), result_(replanner_.plan()) {}

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change> changes,
                              const Budget& budget) override {
    result_ = replanner_.update(state, goal, std::move(world), changes, budget);
    return result_;
  }

  Replanner replanner_;
  PlanResult result_;
};
}  // namespace altiplan::dstar_lite
