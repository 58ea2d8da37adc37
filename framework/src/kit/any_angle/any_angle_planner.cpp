// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/any_angle/any_angle_planner.hpp"

#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/kit/totals.hpp"
#include "costed_theta.hpp"

namespace altiplan::kit {
namespace {

/// True if a leg between two cells may be refused for other reasons than what lies below and beside
/// it: then a cell may be unreachable from one parent alone.
bool legs_differ(const Request& request) {
  const Limits& limits = request.limits;
  return limits.turns() || request.judges_pairs() || limits.max_slope() < kPi / 2 ||
         limits.min_leg > 0 || limits.max_leg < kInfinity || limits.max_route_length < kInfinity;
}

PlanResult result_of(AnyAngleSearch::Result found, const Request& request, const Lattice& lattice,
                     const MoveRules& rules) {
  PlanResult result;
  if (found.status == PlanStatus::solved) {
    result = solved(std::move(found.route), found.progress, lattice, rules);
  } else {
    result.status = found.status;
    result.message = explanation(found.status, found.progress, request, lattice, rules);
    result.counters = counters(found.progress, lattice, rules);
  }
  result.budget_hit = found.budget_hit;
  result.counters.insert(result.counters.end(), found.more.begin(), found.more.end());
  return result;
}
}  // namespace

PlanResult AnyAnglePlanner::do_plan(const Request& request) const {
  const Lattice lattice(request, params_.cell_m, Neighbourhood::all,
                        {params_.max_bytes(), bytes_per_cell_});
  if (auto refused = beyond_budget(lattice, bytes_per_cell_, request.budget)) {
    return *std::move(refused);
  }
  if (!BrickIndex(lattice.spec().counts).fits()) {
    throw ParameterError("cell_m",
                         "the axes of the lattice, each rounded up to a power of two, come "
                         "to more than 2^31 cells: choose larger cells or a smaller volume");
  }
  MoveRules rules(request, lattice, MoveCheck::cells, CornerRule::free_box);
  PlanResult result;
  {
    const auto memory = memory_.take();
    Task task{request, lattice, rules, *memory, {}};
    task.settings.angles = params_.angles();
    task.settings.max_bytes = std::min(params_.max_bytes(), request.budget.max_memory_bytes);
    result = result_of(search(task), request, lattice, rules);
  }
  if (result.status == PlanStatus::solved &&
      params_.angle_rule == AnyAngleParams::Angles::printed) {
    if (const CheckResult judged = check(result.route, request); !judged.ok()) {
      result.status = result.budget_hit ? PlanStatus::timed_out : PlanStatus::no_route;
      result.route = {};
      result.message =
          "the angle rule as printed gave an invalid route: " + judged.violations.front().message;
      result.counters.push_back({"routes_refused", 1});
    }
    return result;
  }
  if (result.status != PlanStatus::no_route) {
    return result;
  }
  result.proved = looks_everywhere() && !legs_differ(request);
  const bool again = params_.angle_rule == AnyAngleParams::Angles::complete && !result.proved;
  return again ? by_heading(request, result) : result;
}

PlanResult AnyAnglePlanner::by_heading(const Request& request, const PlanResult& found) const {
  SearchSettings settings;
  settings.cell_m = params_.cell_m;
  settings.corner = CornerRule::any;  // a step that touches edges satisfies the constraints too
  settings.moves = MoveCheck::cells;
  settings.max_bytes = std::min(params_.max_bytes(), request.budget.max_memory_bytes);
  const Request rest = after(request, found.counters);
  const Lattice lattice(rest, settings.cell_m, settings.neighbours, {});
  const auto memory = heading_memory_.take();
  PlanResult second = HeadingSearch(rest, settings, lattice, kInfinity, *memory).run().result;
  add(second.counters, found.counters);
  second.message += ", after the search by straight legs between cells found no route";
  return second;
}

PlanResult EveryCellPlanner::do_plan(const Request& request) const {
  const bool adds_up = !resources_of(request).empty();
  if (!request.objective && !adds_up) {
    return AnyAnglePlanner::do_plan(request);
  }
  SearchSettings settings;
  settings.cell_m = params().cell_m;
  settings.max_bytes = std::min(params().max_bytes(), request.budget.max_memory_bytes);
  const Lattice lattice(request, settings.cell_m, settings.neighbours,
                        {params().max_bytes(), sizeof(CostedTheta::Node)});
  if (auto refused = beyond_budget(lattice, sizeof(CostedTheta::Node), request.budget)) {
    return *std::move(refused);
  }
  OpenList open;
  PlanResult result = CostedTheta(request, settings, lattice, sight_, open).run().result;
  // The search by heading knows no limits on totals.
  const bool again = result.status == PlanStatus::no_route && !adds_up &&
                     params().angle_rule == AnyAngleParams::Angles::complete;
  return again ? by_heading(request, result) : result;
}

AnyAngleSearch::Result EveryCellPlanner::search(Task& task) const {
  task.settings.sight = sight_;
  const AnyAngleNodes nodes = AnyAngleNodes::every_cell(*task.rules.grid());
  return AnyAngleSearch(task.request, task.lattice, task.rules, nodes, task.settings, task.memory)
      .run();
}
}  // namespace altiplan::kit
