// SPDX-License-Identifier: Apache-2.0
// Safe-interval path planning on a lattice, among moving obstacles.
//
// Citation: M. Phillips, M. Likhachev: SIPP: Safe Interval Path Planning for Dynamic Environments.
//   IEEE International Conference on Robotics and Automation 2011,
//   doi:10.1109/ICRA.2011.5980306.
// Guarantees: complete, and optimal in the time of arrival, on its lattice, for a vehicle of one
//   speed that may wait anywhere among spheres in uniform straight motion and zones that are closed
//   at times (to a millisecond); exact in time: safe
//   intervals and departures are roots of quadratics, not steps of a clock.
// Complexity: O(n m) time for n states and m moving obstacles; a cell has at most m + 1 states.
// Deviations: time is continuous; a leg may be safe at both its ends and not between, so departures
//   have safe intervals of their own (unsafe_departures); straight links join start and goal to the
//   lattice; the goal need only be safe on arrival.
// Symbols: g earliest arrival in a safe interval, h time of the shortest path on an empty lattice,
//   f = g + h.
#include <string>
#include <variant>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "sipp_search.hpp"

namespace {

using namespace altiplan;

struct Params : kit::SearchParams {
  void describe(Fields& f) {
    kit::describe_cell(f, search.cell_m);
    describe_memory(f);
  }
};

/// What of the request the search cannot take into account; "" if nothing.
std::string beyond_search(const Request& request) {
  if (request.vehicle.wing) {
    return "plans waits, which an aeroplane cannot fly: use hybrid_astar";
  }
  if (!request.wind.is_calm()) {
    return "plans in still air: remove the wind";
  }
  if (!request.vehicle.speed_near.empty()) {
    return "plans at one speed: remove speed_near";
  }
  if (request.limits.turns() || request.judges_pairs()) {
    return "cannot satisfy limits on turns, or what judges a leg by the one before it (constraints "
           "and the vehicle's body): use astar";
  }
  if (request.limits.max_route_length < kInfinity) {
    return "cannot satisfy a limit on the route's length: use astar";
  }
  for (const MovingObstacle& obstacle : request.world->moving()) {
    if (obstacle.planned && !std::holds_alternative<Sphere>(obstacle.shape)) {
      return "plans among moving spheres, and '" + obstacle.id +
             "' is none: give a sphere about it";
    }
  }
  return "";
}

PlanResult refused(const std::string& why, Reason reason = Reason::none) {
  PlanResult result;
  result.status = PlanStatus::invalid_problem;
  result.reason = reason;
  result.message = why;
  return result;
}

/// The obstacles that routes are planned against, each grown by what the vehicle keeps off them.
std::vector<sipp::Mover> movers_of(const Request& request) {
  const double needed = std::max(request.limits.min_clearance, request.vehicle.reach_m());
  std::vector<sipp::Mover> movers;
  for (const MovingObstacle& obstacle : request.world->moving()) {
    if (obstacle.planned) {
      const auto& sphere = std::get<Sphere>(obstacle.shape);
      movers.push_back({sphere.centre - obstacle.since_s * obstacle.velocity, obstacle.velocity,
                        sphere.radius + needed});
    }
  }
  return movers;
}

/// What is closed at times.
std::vector<sipp::Closure> closures_of(const World& world) {
  constexpr double kMargin = 1e-3;  // seconds
  std::vector<sipp::Closure> closures;
  for (const Layer& layer : world.layers()) {
    if (const auto* hours = dynamic_cast<const kit::Hours*>(layer.environment.get())) {
      for (const kit::Hours::Part& part : hours->parts()) {
        sipp::Closure closure{part.layer.get(), {}};
        for (const auto& times : part.closed) {
          closure.closed.push_back({times[0] - kMargin, times[1] + kMargin});
        }
        closures.push_back(std::move(closure));
      }
    }
  }
  return closures;
}

class Sipp final : public Planner {
 public:
  explicit Sipp(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    if (const std::string why = beyond_search(request); !why.empty()) {
      return refused("sipp " + why);
    }
    const Vec3& start = request.start.position;
    if (const MovingObstacle* met =
            meets_moving(Leg::straight(start, start), request.start.time_s, request)) {
      return refused("the start lies too near to the moving obstacle '" + met->id +
                         "' at the time of the start",
                     Reason::start);
    }
    const std::vector<sipp::Closure> closures = closures_of(*request.world);
    if (closures.empty()) {
      return search(request, closures);
    }
    Request at_all_times = request;
    at_all_times.world =
        std::make_shared<const World>(kit::between(*request.world, kInfinity, -kInfinity));
    return search(at_all_times, closures);
  }

  PlanResult search(const Request& request, const std::vector<sipp::Closure>& closures) const {
    const kit::SearchSettings settings = params_.settings(request);
    constexpr std::size_t kBytes = sizeof(std::uint32_t);
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), kBytes});
    if (auto over = kit::beyond_budget(lattice, kBytes, request.budget)) {
      return *std::move(over);
    }
    const std::vector<sipp::Mover> movers = movers_of(request);
    return sipp::Search(request, settings, lattice, movers, closures).run();
  }

  Traits do_traits() const override {
    Traits traits;
    traits.complete = true;
    traits.optimal = true;
    return traits;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "sipp", Sipp, Params,
                "safe-interval path planning: the earliest arrival among moving obstacles, with "
                "waits")
