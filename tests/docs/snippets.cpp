// SPDX-License-Identifier: Apache-2.0
// Code shown in pages of docs/interfaces: interfaces_test.py writes the text between `// name {`
// and `// }` into the pages. Compiled, never run.
#include <altiplan/check.hpp>
#include <altiplan/constraint.hpp>
#include <altiplan/environment.hpp>
#include <altiplan/ground.hpp>
#include <altiplan/kit/lattice/open_list.hpp>
#include <altiplan/kit/sampling/leg_rules.hpp>
#include <altiplan/kit/sampling/leg_tree.hpp>
#include <altiplan/kit/sampling/point_grid.hpp>
#include <altiplan/kit/scratch.hpp>
#include <altiplan/local_planner.hpp>
#include <altiplan/planner.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/smoother.hpp>
#include <altiplan/tuner.hpp>

#include <algorithm>

namespace {
using namespace altiplan;

// parameters {
struct Params {
  double cell_m = 50;  // also int, bool, std::string, Vec3, Path, lists, structs with a describe
  std::optional<double> range_m;
  AutoNumber step_m;  // a number or the word auto, the default; step_m.value is a std::optional
  std::string order = "near";

  void describe(Fields& f) {
    f("cell_m", cell_m).unit("m").greater_than(0).doc("cell edge length");
    f("range_m", range_m).unit("m").at_least(1).doc("maximum leg length; default: no limit");
    f("step_m", step_m).unit("m").greater_than(0).doc("sample spacing; auto: half a cell");
    f("order", order).one_of({"near", "far"}).doc("search order");
    f.check(!range_m || *range_m >= cell_m, "range_m must be at least cell_m");
  }
};
// }

// ground {
/// Unbounded ground that rises by a tenth eastwards.
class Slope final : public Environment, public Ground {
 public:
  Slope() { info_.notes = {"a slope of 10 %"}; }

 private:
  static double above(const Vec3& p) { return p.z() - 0.1 * p.x(); }

  Box do_bounds() const override { return {}; }
  double do_clearance(const Vec3& p) const override { return above(p) / std::hypot(1, 0.1); }
  const LayerInfo& do_info() const override { return info_; }

  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double) const override { return 0.1 * x; }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(above(a), above(b));  // over a plane the minimum is at an end of the leg
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return std::max(above(a), above(b));
  }
  double do_slope(const Box&) const override { return 0.1; }

  LayerInfo info_;
};
// }

// rule {
class LittleClimbing final : public Constraint {
 private:
  AppliesTo do_applies_to() const override { return AppliesTo::route; }  // without it: both

  void do_tighten(Limits& limits, const Request&) const override {
    limits.max_climb = std::min(limits.max_climb, radians(10));  // never looser than before
  }

  std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
    double climbed = 0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      climbed += std::max(0.0, route[i + 1].z() - route[i].z());
      if (climbed > max_m_ + kLengthTolerance) {
        Violation broken;
        broken.at = i;  // the leg from waypoint i to the next
        broken.value = climbed;
        broken.limit = max_m_;
        broken.unit = "m";
        broken.message = "the route climbs more than " + std::to_string(max_m_) + " m in all";
        return {broken};
      }
    }
    return {};  // no violation
  }

  bool do_admits_all() const override { return true; }  // no call per leg

  double max_m_ = 500;
};
// }

// session {
/// Continues along the last route while the vehicle can rejoin it; else replans.
class JoiningSession final : public Session {
 public:
  JoiningSession(const Planner& planner, const Request& request)
      : planner_(planner), request_(request), result_(planner.plan(request)) {}

 private:
  const PlanResult& do_result() const override { return result_; }

  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change>,
                              const Budget& budget) override {
    request_.start = state;  // the rest of the request is unchanged
    request_.goal = goal;
    request_.world = std::move(world);
    request_.budget = budget;
    BudgetWatch watch(request_.budget);
    std::int64_t tried = 0;
    const Route last = result_.route;
    for (std::size_t at = last.size(); at-- > 1 && !watch.spent(std::uint64_t(tried));) {
      ++tried;
      Polyline joined = {state.position};
      joined.insert(joined.end(), last.begin() + std::ptrdiff_t(at), last.end());
      if (check(joined, request_).ok()) {
        result_ = PlanResult{};
        result_.status = PlanStatus::solved;
        result_.route = joined;
        result_.counters = {{"expanded", tried}};
        return result_;
      }
    }
    request_.budget.max_iterations -= std::min(budget.max_iterations, std::uint64_t(tried));
    result_ = planner_.plan(request_);
    return result_;  // the same object as do_result
  }

  const Planner& planner_;  // outlives its sessions
  Request request_;         // a copy: the caller's is temporary
  PlanResult result_;
};
// }

class Joining final : public Planner {
  // begin {
  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return std::make_unique<JoiningSession>(*this, request);
  }
  // }
  PlanResult do_plan(const Request&) const override { return {}; }
  Traits do_traits() const override { return {}; }
};

void expand() {}

void budget(const Request& request) {
  // budget {
  BudgetWatch watch(request.budget);
  std::uint64_t expanded = 0;
  while (!watch.spent(expanded)) {  // once per iteration, with the count so far
    expand();
    ++expanded;
  }
  // }
}

Vec3 random(const Request& request, std::uint64_t i) {
  // random {
  RandomStream draw = request.random.sub("sample", i);
  const Vec3 p = draw.in(request.volume);     // uniformly in a box
  const double share = draw.uniform();        // from 0 to below 1; uniform(low, high)
  const std::int64_t n = draw.integer(1, 6);  // both included
  const double height = draw.normal();        // mean 0, deviation 1
  // }
  return p * share * double(n) * height;
}

void trace(const Request& request, std::int64_t node, std::int64_t parent, const Vec3& p) {
  // trace {
  if (request.trace != nullptr) {
    TraceEvent event;
    event.kind = TraceEvent::Kind::added;  // expanded, removed, rewired, iteration
    event.node = node;
    event.parent = parent;  // -1: a root
    event.position = p;
    request.trace->add(event);
  }
  // }
}

bool cells(const Request& request, const Vec3& p) {
  // cells {
  GridSpec spec;
  spec.origin = request.volume.min;
  spec.cell = Vec3(50, 50, 10);
  spec.counts = {40, 40, 10};
  spec.inflation = request.limits.min_clearance;
  const std::shared_ptr<const VoxelGrid> grid = request.world->voxels(spec);
  const Cell cell = spec.cell_of(p);  // may lie outside of the grid
  const bool is_free = spec.holds(cell) && !grid->blocked(cell);
  // }
  return is_free;
}

std::size_t roadmap(const Request& request, const std::vector<Vec3>& samples) {
  // roadmap {
  kit::LegRules rules(request);  // for one search
  kit::PointGrid points;
  for (const Vec3& p : samples) {
    if (rules.point_ok(p)) {
      points.insert(p);  // returns its index: 0, 1, 2 …
    }
  }
  std::vector<std::uint32_t> near;
  points.within(request.start.position, 300, near);  // indices of all within 300 m
  for (const std::uint32_t n : near) {
    if (rules.ok(request.before_start(), request.start.position, points.point(n))) {
      // a leg that satisfies every constraint
    }
  }
  // }
  return points.size();
}

std::uint32_t open_list(double g, double h, std::uint32_t node) {
  // open_list {
  kit::OpenList open;
  open.clear(1e-6);                               // metres; f that differ by less are ties
  open.push(g + h, g, node);                      // again, if a better path to the node is found
  const kit::OpenList::Entry first = open.pop();  // minimum f; skip a node that was popped before
  // }
  return first.node;
}

class Planning {
 public:
  void plan() const {
    // pool {
    const auto tree = trees_.take();  // a unique_ptr that returns it at the end of the call
    tree->clear();
    // }
  }

 private:
  // pool_member {
  mutable kit::ScratchPool<kit::LegTree> trees_;  // a member of the planner
  // }
};
}  // namespace

// Not shown in the pages.
void use_the_snippets(const Request& request) {
  Params params;
  bind(params, nullptr);
  LittleClimbing().violations({}, request);
  Joining().begin(request);
  budget(request);
  trace(request, 0, -1, random(request, 0));
  cells(request, request.start.position);
  roadmap(request, {});
  open_list(0, 0, 0);
  Planning().plan();
}
