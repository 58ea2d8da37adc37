// SPDX-License-Identifier: Apache-2.0
#include <altiplan/kit/lattice/move_rules.hpp>
#include <altiplan/kit/lattice/open_list.hpp>
#include <altiplan/kit/scratch.hpp>
#include <altiplan/planner.hpp>
#include <altiplan/plugin.hpp>

#include <bit>
#include <utility>

namespace {
using namespace altiplan;

struct Params {
  Vec3 cell_m{50, 50, 10};

  void describe(Fields& f) {
    f("cell_m", cell_m).unit("m").at_least(0.001).doc("cell edge length, unless a layer sets it");
  }
};

struct Node {
  double g;              // metres from the start
  std::uint32_t parent;  // the previous waypoint of the route
  std::uint16_t stamp;   // used by NodeStore
  bool closed;
};

struct Search {
  const Request& request;
  const kit::Lattice& lattice;
  kit::NodeStore<Node>& nodes;
  kit::MoveRules rules{request, lattice, kit::MoveCheck::cells, kit::CornerRule::free_box};
  kit::OpenList open{};
  kit::Lattice::Link first = lattice.nearest(request.start.position);
  kit::Lattice::Link last = lattice.nearest(request.goal.position);
  std::uint32_t start = lattice.index(first.cell);
  std::uint32_t goal = std::uint32_t(lattice.size());  // beyond the cells: not a cell centre
  std::int64_t expanded = 0;
  Polyline route{};

  PlanStatus run() {
    nodes.reset(lattice.size() + 1);
    open.clear(1e-6);  // values of f that differ by less than a micrometre are ties
    nodes.at(start, {0, start, 0, false});
    open.push(c(start, goal), 0, start);
    BudgetWatch watch(request.budget);
    const std::size_t max_open = request.budget.max_memory_bytes - lattice.size() * sizeof(Node);
    while (!open.empty()) {
      const std::uint32_t s = open.pop().node;
      if (request.goal.reached_at(place(s))) {
        route = route_to(s);
        return PlanStatus::solved;
      }
      if (watch.spent(std::uint64_t(expanded)) || open.bytes() > max_open) {
        return watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
      }
      if (!std::exchange(nodes[s].closed, true)) {
        ++expanded;
        expand(s);
      }
    }
    return PlanStatus::no_route;
  }

  void expand(std::uint32_t s) {
    const Cell cell = lattice.cell(s);
    for (auto steps = rules.candidates(cell, kit::kHere); steps != 0; steps &= steps - 1) {
      update_vertex(s, std::uint32_t(s + lattice.stride(std::countr_zero(steps))));
    }
    if (cell == last.cell) {
      update_vertex(s, goal);
    }
  }

  // Path 2 of the paper, straight from the parent of s; if that is blocked, path 1 via s.
  void update_vertex(std::uint32_t s, std::uint32_t next) {
    Node& node = nodes.at(next, {kInfinity, 0, 0, false});
    if (node.closed) {
      return;
    }
    for (const std::uint32_t from : {nodes[s].parent, s}) {
      const double g = nodes[from].g + c(from, next);
      if (g < node.g && g <= request.limits.max_route_length && line_of_sight(from, next)) {
        node.g = g;
        node.parent = from;
        open.push(g + c(next, goal), g, next);
        return;
      }
    }
  }

  bool line_of_sight(std::uint32_t a, std::uint32_t b) {
    const Polyline flown = route_to(a);
    const auto before = approach(flown, flown.size() - 1, request.before_start());
    return b == goal || (a == start && first.length > 0)  // not a cell centre
               ? rules.any_leg_ok(before, place(a), place(b))
               : rules.sees(before, lattice.cell(a), lattice.cell(b));
  }

  Polyline route_to(std::uint32_t s) const {
    Polyline route = {place(s)};
    for (; s != start; s = nodes[s].parent) {
      route.insert(route.begin(), place(nodes[s].parent));
    }
    return route;
  }

  Vec3 place(std::uint32_t s) const {
    return s == start  ? request.start.position
           : s == goal ? request.goal.position
                       : lattice.position(lattice.cell(s));
  }
  double c(std::uint32_t a, std::uint32_t b) const { return (place(b) - place(a)).norm(); }
};

class BasicTheta final : public Planner {
 public:
  explicit BasicTheta(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const kit::Lattice lattice(request, params_.cell_m, kit::Neighbourhood::all,
                               {request.budget.max_memory_bytes, sizeof(Node) + 1});
    const auto nodes = nodes_.take();
    Search search{request, lattice, *nodes};
    const PlanStatus status = search.run();
    const bool none = status == PlanStatus::no_route;
    return {.status = status,
            .message = none ? "refused moves: " + search.rules.refusals() : "",
            .route = std::move(search.route),
            .counters = {{"expanded", search.expanded}},
            .budget_hit = status == PlanStatus::timed_out,
            .proved = none && !search.rules.parent_mattered() &&
                      request.limits.max_route_length == kInfinity};
  }
  Traits do_traits() const override { return {.complete = true}; }

  Params params_;
  mutable kit::ScratchPool<kit::NodeStore<Node>> nodes_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "basic_theta", BasicTheta, Params, "Theta* on cells, built with the kit")
