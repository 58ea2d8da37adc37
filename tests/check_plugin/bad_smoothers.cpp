// SPDX-License-Identifier: Apache-2.0
// Smoothers broken on purpose, one thing each. The sound one leaves every route as it is.
#include "altiplan/route.hpp"
#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

PlanResult solved(Polyline route) {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.route = std::move(route);
  return result;
}
PlanResult plain(const Polyline& route, const Request&) { return solved(route); }

template <PlanResult (*kSmooth)(const Polyline&, const Request&)>
class SpoiltSmoother final : public Smoother {
 public:
  template <class Params>
  explicit SpoiltSmoother(const Params&) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    return kSmooth(route, request);
  }
};
using Sound = SpoiltSmoother<plain>;

/// Its memory is made by the first route, and looked for when it is destroyed.
class Unused final : public Smoother {
 public:
  explicit Unused(const NoParams&) {}
  ~Unused() override {
    if (!used_) {
      crashes();
    }
  }

 private:
  PlanResult do_smooth(const Polyline& route, const Request&) const override {
    used_ = true;
    return solved(route);
  }
  mutable std::atomic<bool> used_ = false;
};

PlanResult moves_the_end(const Polyline& route, const Request& request) {
  Polyline moved = route;
  if (request.limits.max_climb < 0.4) {
    moved.back().x() += 1e-9;
  }
  return solved(moved);
}
PlanResult cuts_through(const Polyline& route, const Request& request) {
  return request.limits.max_leg < kInfinity ? solved({route.front(), route.back()}) : solved(route);
}
PlanResult sharpens(const Polyline& route, const Request& request) {
  Polyline sharper = route;
  if (request.limits.max_turn_horizontal < 2 && !request.limits.min_ground_clearance &&
      route.size() > 8) {
    sharper[1] = route[2] + (route[0] - route[2]) * 1e-3;
  }
  return solved(sharper);
}
PlanResult digs(const Polyline& route, const Request& request) {
  Polyline lower = route;
  if (request.limits.min_ground_clearance && route.size() > 2) {
    lower[1].z() -= 1;
  }
  return solved(lower);
}
PlanResult forgets_heading(const Polyline& route, const Request& request) {
  Polyline turned = route;
  if (request.before_start() && route.size() > 3) {
    turned[1] = route[0] - 1e-3 * request.start.velocity;
  }
  return solved(turned);
}
PlanResult throws_at_repeats(const Polyline& route, const Request&) {
  if (route.size() > 3 && without_repeats(route).size() < route.size()) {
    throw std::runtime_error("division by zero");
  }
  return solved(route);
}
PlanResult gives_up(const Polyline& route, const Request& request) {
  if (request.budget.max_iterations < 100) {
    throw std::runtime_error("no time");
  }
  return solved(route);
}
PlanResult returns_what_it_had(const Polyline& route, const Request& request) {
  return request.budget.stop.stop_requested() ? solved({route.front()}) : solved(route);
}
PlanResult counts_calls(const Polyline& route, const Request&) {
  static std::atomic<std::int64_t> calls = 0;
  PlanResult result = solved(route);
  result.counters = {{"calls", ++calls}};
  return result;
}
PlanResult counts_threads(const Polyline& route, const Request& request) {
  PlanResult result = solved(route);
  result.counters = {{"threads", request.threads}};
  return result;
}
PlanResult works_in_its_input(const Polyline& route, const Request&) {
  PlanResult result = solved(route);
  if (route.size() > 2) {
    const_cast<Polyline&>(route)[1].z() += 1;
  }
  return result;
}
PlanResult late(const Polyline& route, const Request& request) {
  if (request.budget.deadline) {
    std::this_thread::sleep_until(*request.budget.deadline + std::chrono::milliseconds(70));
  }
  return solved(route);
}
template <Does kDoes>
PlanResult after(const Polyline& route, const Request&) {
  kDoes();
  return solved(route);
}
template <double (*kOther)()>
PlanResult noting(const Polyline& route, const Request&) {
  PlanResult result = solved(route);
  result.counters = {{"noted", std::int64_t(1e18 * kOther())}};
  return result;
}
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "sound", Sound, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Smoother, "moves_the_end", SpoiltSmoother<moves_the_end>, NoParams,
                "moves the end by 1e-9 m where climb is limited")
ALTIPLAN_PLUGIN(Smoother, "cuts_through", SpoiltSmoother<cuts_through>, NoParams,
                "goes straight from end to end where legs are limited")
ALTIPLAN_PLUGIN(Smoother, "sharpens", SpoiltSmoother<sharpens>, NoParams,
                "sharpens a corner of unsound routes where turns are limited")
ALTIPLAN_PLUGIN(Smoother, "digs", SpoiltSmoother<digs>, NoParams, "goes 1 m lower over ground")
ALTIPLAN_PLUGIN(Smoother, "forgets_heading", SpoiltSmoother<forgets_heading>, NoParams,
                "does not look where the vehicle comes from")
ALTIPLAN_PLUGIN(Smoother, "throws_at_repeats", SpoiltSmoother<throws_at_repeats>, NoParams,
                "throws where a point comes twice")
ALTIPLAN_PLUGIN(Smoother, "gives_up", SpoiltSmoother<gives_up>, NoParams,
                "throws where there are few iterations")
ALTIPLAN_PLUGIN(Smoother, "returns_what_it_had", SpoiltSmoother<returns_what_it_had>, NoParams,
                "returns half a route where it is stopped")
ALTIPLAN_PLUGIN(Smoother, "counts_calls", SpoiltSmoother<counts_calls>, NoParams,
                "its answer depends on how often it was asked")
ALTIPLAN_PLUGIN(Smoother, "counts_threads", SpoiltSmoother<counts_threads>, NoParams,
                "its answer depends on the number of threads")
ALTIPLAN_PLUGIN(Smoother, "works_in_its_input", SpoiltSmoother<works_in_its_input>, NoParams,
                "changes the route that it was given")
ALTIPLAN_PLUGIN(Smoother, "crashes_unused", Unused, NoParams,
                "crashes where it goes unused, with no route to smooth")
ALTIPLAN_PLUGIN(Smoother, "late", SpoiltSmoother<late>, NoParams, "ends 70 ms after its deadline")
ALTIPLAN_PLUGIN(Smoother, "two__words", Sound, NoParams, "its name is not in snake_case")
ALTIPLAN_BAD_ENTRIES(Smoother, Sound, NoParams)
ALTIPLAN_BAD_PLUGIN(Smoother, "thrower", thrower_entry, Sound, Bounded<NoParams>,
                    "throws a number where parameters are wrong")
ALTIPLAN_BAD_PLUGIN(Smoother, "throws_at_keys", throwing_entry, Sound, Bounded<NoParams>,
                    "throws where it reads a parameter that it does not know")
ALTIPLAN_BAD_PROCESSES(Smoother, SpoiltSmoother<after<changes_locale>>,
                       SpoiltSmoother<after<prints>>, SpoiltSmoother<after<writes_file>>,
                       SpoiltSmoother<after<leaks>>, SpoiltSmoother<noting<by_address>>, NoParams)
