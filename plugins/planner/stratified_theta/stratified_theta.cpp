// SPDX-License-Identifier: Apache-2.0
// Stratified Lazy Theta*: a route on a coarse level of the space, refined level by level.
//
// Citation: paper 003, spatial stratification in cities (SS-LT*). The search of a level: A. Nash,
//   S. Koenig, C. Tovey: Lazy Theta*. AAAI 2010, doi:10.1609/aaai.v24i1.7566.
// Guarantees: every leg satisfies every constraint. Not complete, except for angle_rule: complete.
// Complexity: O(n) per level for the share of certain blocks in the n cells of the space; then O(k
//   log k) in the nodes k of a level's set.
// Deviations: the set of a level holds the chain of nodes along the route, not its bends alone; if
//   a whole level has no route, the next one is planned on whole; if a refined one has none, the
//   route is kept; angles are checked against the leg that is flown (angle_rule: route_consistent).
// Symbols: l_min first level, p_max share that has to be certain, d_limit length of a path that is
//   tried straight, h heuristic 1.1^(level - l_min) d, eq. (6).
#include <cmath>
#include <optional>

#include "altiplan/kit/any_angle/any_angle_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "corridor.hpp"
#include "levels.hpp"

namespace {

using namespace altiplan;
using kit::AnyAngleSearch;
using stratified::Blocks;
using stratified::Level;
using SearchResult = AnyAngleSearch::Result;

enum class Refine { successors, corridor };

struct Params : kit::AnyAngleParams {
  Params() { angle_rule = Angles::route_consistent; }

  double p_max = 0.25;
  double d_limit_m = 140;
  int start_levels = 1;
  Refine refine = Refine::successors;

  void describe(Fields& f) {
    AnyAngleParams::describe(f);
    f("p_max", p_max)
        .range(0, 1)
        .doc(
            "planning starts at the lowest level where more than this share of the blocks is "
            "fully free or fully blocked, eq. (5)");
    f("d_limit_m", d_limit_m)
        .unit("m")
        .at_least(0)
        .doc("maximum distance to the goal at which a straight leg is tried first");
    f("start_levels", start_levels)
        .range(1, 30)
        .doc("number of start levels from that one on; the shortest route is kept");
    f("refine", refine, {{"successors", Refine::successors}, {"corridor", Refine::corridor}})
        .doc(
            "refine a route level by level in the nodes along it and their neighbours, or at "
            "once in the cells around a path over blocks of 8 cells, which needs no levels");
  }
};

class StratifiedTheta final : public kit::AnyAnglePlanner {
 public:
  explicit StratifiedTheta(const Params& params)
      : AnyAnglePlanner(params, kBytesPerCell), params_(params) {}

 private:
  /// For the sets' bits; memory of their searches is counted as they run.
  static constexpr std::size_t kBytesPerCell = 1;

  SearchResult search(Task& task) const override {
    if (auto found = straight(task)) {
      return *std::move(found);
    }
    if (params_.refine == Refine::corridor) {
      return in_corridor(task);
    }
    const VoxelGrid& occupancy = *task.rules.grid();
    BudgetWatch watch(task.request.budget);
    const int minimum = stratified::min_level(occupancy, params_.p_max, &watch);
    if (watch.spent(task.settings.before.expanded)) {
      SearchResult none;
      none.status = watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
      none.budget_hit = true;
      return none;
    }
    const int finest = stratified::finest_level(occupancy.spec().counts);
    task.memory.reset(*Level(finest, occupancy).nodes().grid);
    SearchResult best;
    for (int level = minimum; level <= std::min(finest, minimum + params_.start_levels - 1);
         ++level) {
      SearchResult found = from_level(task, level, finest);
      task.settings.before = found.progress;
      const bool cut_short = found.budget_hit;
      if (best.status != PlanStatus::solved ||
          (found.status == PlanStatus::solved && length(found.route) < length(best.route))) {
        best = std::move(found);
      }
      if (cut_short) {
        best.budget_hit = true;
        break;
      }
    }
    best.progress = task.settings.before;
    best.more = {{"start_level", minimum}};
    return best;
  }

  std::optional<SearchResult> straight(Task& task) const {
    const Vec3& start = task.request.start.position;
    const Vec3& goal = task.request.goal.position;
    const double d = (goal - start).norm();
    if (d == 0 || d > std::min(params_.d_limit_m, task.request.limits.max_route_length) ||
        !task.rules.any_leg_ok(task.request.before_start(), start, goal)) {
      return std::nullopt;
    }
    SearchResult found;
    found.status = PlanStatus::solved;
    found.route = {start, goal};
    found.at_goal = true;
    return found;
  }

  /// The main loop: a route on the first level that has one, then on each finer level among the
  /// nodes around it.
  static SearchResult from_level(Task& task, int first, int finest) {
    const VoxelGrid& occupancy = *task.rules.grid();
    SearchResult found;
    found.progress = task.settings.before;
    for (int number = first; number <= finest; ++number) {
      Level level(number, occupancy);
      if (found.status == PlanStatus::solved) {
        const Level coarse(number - 1, occupancy);
        for (const Cell& key : chain(coarse, found.route, occupancy.spec())) {
          level.add_around(coarse.place(key));
        }
      } else {
        level.add_all();
      }
      task.settings.weight_h = std::pow(1.1, number - first);
      task.settings.before = found.progress;
      SearchResult finer = run(task, level.nodes());
      found.progress = finer.progress;
      const bool cut_short = finer.budget_hit;
      if (finer.status == PlanStatus::solved || found.status != PlanStatus::solved) {
        found = std::move(finer);
      }
      if (cut_short) {
        found.budget_hit = true;
        break;
      }
    }
    return found;
  }

  /// Searches the cells around a path over blocks; wider if they hold no route.
  static SearchResult in_corridor(Task& task) {
    const VoxelGrid& occupancy = *task.rules.grid();
    const Blocks blocks(occupancy);
    const std::vector<Cell> way = blocks.way(task.lattice.nearest(task.request.start.position).cell,
                                             task.lattice.nearest(task.request.goal.position).cell);
    if (way.empty()) {  // only another end within the tolerance may remain
      return run(task, kit::AnyAngleNodes::every_cell(occupancy));
    }
    for (int around = 1;; around *= 2) {
      const VoxelGrid cells = blocks.corridor(way, around);
      SearchResult found = run(task, kit::AnyAngleNodes::every_cell(cells));
      if (found.status != PlanStatus::no_route || around >= blocks.longest_axis()) {
        return found;
      }
      task.settings.before = found.progress;
    }
  }

  static SearchResult run(Task& task, const kit::AnyAngleNodes& nodes) {
    return AnyAngleSearch(task.request, task.lattice, task.rules, nodes, task.settings, task.memory)
        .run();
  }

  bool looks_everywhere() const override { return false; }
  Traits do_traits() const override {
    return {.complete = params_.angle_rule == kit::AnyAngleParams::Angles::complete};
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "stratified_theta", StratifiedTheta, Params,
                "Stratified Lazy Theta* (SS-LT*): plans a coarse route and refines it level by "
                "level")
