// SPDX-License-Identifier: Apache-2.0
//
// From every second of a route there is a way home: on along the route to its next waypoint, and
// from there straight, or over the lattice of kit::HomeField, whose legs keep the request's limits.
// On the first part nothing more is used than the route itself uses until that waypoint. So what is
// used until a waypoint, and the way home from there, decide for all seconds before it.
#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/energy.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/kit/lattice/home_field.hpp"
#include "altiplan/kit/lattice/lattice_params.hpp"
#include "altiplan/kit/stated_power.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/total_limit.hpp"

namespace altiplan::returnable {
namespace {

struct Home {
  Point at;
  void describe(Fields& f) { f.point(at).required().doc("where a way home may end"); }
};

struct Params {
  std::vector<Home> homes;
  Vec3 cell_m{50, 50, 10};
  std::optional<double> maximum_wh;
  kit::StatedPower power;

  void describe(Fields& f) {
    f("homes", homes).doc("places to come home to; default: the start");
    kit::describe_cell(f, cell_m);
    f("maximum_wh", maximum_wh)
        .unit("Wh")
        .greater_than(0)
        .doc("what may be used until home; default: what the vehicle's battery may give");
    power.describe(f);
  }
};

double available_wh(const Params& params, const Vehicle& vehicle) {
  const double wh = params.maximum_wh           ? *params.maximum_wh
                    : vehicle.energy == nullptr ? kInfinity
                                                : vehicle.energy->available_wh();
  if (wh == kInfinity) {
    throw Error(
        "the battery is not known: expected vehicle.energy.capacity_wh in the scenario, "
        "or maximum_wh");
  }
  return wh;
}

/// Throws Error for cells that do not fit the volume before a search asks for ways home.
void expect_cells(const Site& site, const Vec3& home, const Vec3& cell_m) {
  Request request;
  request.world = {std::shared_ptr<void>(), site.before};
  request.volume = site.volume;
  request.start.position = request.goal.position = home;
  try {
    const kit::Lattice lattice(request, cell_m, kit::Neighbourhood::all, kit::HomeField::kMemory);
  } catch (const ParameterError& error) {
    throw Error(error.key() + ": " + error.what());
  }
}

class FlightEnergy final : public Objective {
 public:
  explicit FlightEnergy(std::shared_ptr<const Power> power) : power_(std::move(power)) {}

 private:
  double do_cost(const Leg& leg, double, const Request& request) const override {
    return leg_energy(leg, 0, request, *power_);
  }
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    return {std::max(legs_cost(route, request), flown_energy(route, request, *power_))};
  }
  /// The way home bounds what a search may use, better than a way to the goal.
  double do_bound(const Vec3&, const Vec3&, const Request&) const override { return 0; }
  std::string do_unit() const override { return "Wh"; }
  Traits do_traits() const override { return {.place = true, .heading = true}; }

  std::shared_ptr<const Power> power_;
};

/// What a field of ways home depends on, of requests of one scenario.
struct Problem {
  Problem(const Request& request, std::vector<Vec3> ways_end)
      : homes(std::move(ways_end)),
        world(request.world),
        volume(request.volume),
        limits(request.limits) {
    for (const NamedConstraint& named : request.constraints) {
      constraints.push_back(named.constraint.get());
    }
  }

  bool is_of(const Request& request, const std::vector<Vec3>& ways_end) const {
    const Limits& a = limits;
    const Limits& b = request.limits;
    return homes == ways_end && world == request.world && volume.min == request.volume.min &&
           volume.max == request.volume.max && a.min_clearance == b.min_clearance &&
           a.min_ground_clearance == b.min_ground_clearance && a.max_climb == b.max_climb &&
           a.max_sink == b.max_sink &&
           std::equal(a.altitude.begin(), a.altitude.end(), b.altitude.begin(), b.altitude.end(),
                      [](const AltitudeBand& one, const AltitudeBand& two) {
                        return one.datum == two.datum && one.min == two.min && one.max == two.max;
                      }) &&
           std::equal(constraints.begin(), constraints.end(), request.constraints.begin(),
                      request.constraints.end(),
                      [](const Constraint* one, const NamedConstraint& two) {
                        return one == two.constraint.get();
                      });
  }

  std::vector<Vec3> homes;
  std::shared_ptr<const World> world;
  Box volume;
  Limits limits;
  std::vector<const Constraint*> constraints;
};

class Returnable final : public TotalLimit {
 public:
  Returnable(const Params& params, const Site& site)
      : Returnable(params, site, params.power.of(site.vehicle)) {}

 private:
  Returnable(const Params& params, const Site& site, std::shared_ptr<const Power> power)
      : TotalLimit(std::make_shared<FlightEnergy>(power), available_wh(params, site.vehicle)),
        power_(std::move(power)),
        cell_m_(params.cell_m) {
    if (!site.vehicle.speed_near.empty()) {
      throw Error("ways home are not known of a vehicle with speed_near");
    }
    for (const Home& home : params.homes) {
      homes_.push_back(site.resolve(home.at));
    }
    if (homes_.empty() && site.start) {
      homes_.push_back(*site.start);
    }
    if (!homes_.empty() && is_finite(site.volume.min) && is_finite(site.volume.max)) {
      expect_cells(site, homes_.front(), cell_m_);
    }
  }

  double do_left_at(const Vec3& p, const Request& request, double enough) const override {
    return field(request)->from(p, enough);
  }

  /// Searched once for each problem: of routes, of tracks, and of a world that has changed.
  std::shared_ptr<const kit::HomeField> field(const Request& request) const {
    constexpr std::size_t kKept = 4;
    const std::vector<Vec3> homes =
        homes_.empty() ? std::vector<Vec3>{request.start.position} : homes_;
    const std::lock_guard lock(mutex_);
    for (const auto& [of, field] : known_) {
      if (of.is_of(request, homes)) {
        return field;
      }
    }
    auto made = searched(request, homes);
    if (known_.size() == kKept) {
      known_.erase(known_.begin());
    }
    known_.emplace_back(Problem(request, homes), made);
    return made;
  }

  std::shared_ptr<const kit::HomeField> searched(const Request& request,
                                                 const std::vector<Vec3>& homes) const {
    try {
      return std::make_shared<const kit::HomeField>(request, homes, cell_m_,
                                                    kit::HomeField::energy(request, power_));
    } catch (const ParameterError& error) {  // the step that asks may have a cell_m too
      throw Error("the constraint 'returnable': " + error.key() + ": " + error.what());
    }
  }

  std::shared_ptr<const Power> power_;
  std::vector<Vec3> homes_;
  Vec3 cell_m_;
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<Problem, std::shared_ptr<const kit::HomeField>>> known_;
};
}  // namespace
}  // namespace altiplan::returnable

using altiplan::returnable::Params;
using altiplan::returnable::Returnable;
ALTIPLAN_PLUGIN(Constraint, "returnable", Returnable, Params,
                "Keeps a way home from every second within what the battery may give")
