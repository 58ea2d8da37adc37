// SPDX-License-Identifier: Apache-2.0
// Objectives broken on purpose, one thing each. The sound one is the length.
#include "altiplan/request.hpp"
#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

enum class Flaw {
  none,
  mean,
  negative,
  too_high,
  near_box,
  from_itself,
  by_place,
  by_heading,
  by_time,
  flat,
  dear,
  counts
};

double same() { return 0; }

template <Flaw kFlaw, Does kDoes = does_nothing, double (*kOther)() = same>
class SpoiltObjective final : public Objective {
 public:
  template <class Params>
  SpoiltObjective(const Params&, const Site&) {}

 private:
  double do_cost(const Leg& leg, double time_s, const Request& request) const override {
    kDoes();
    const double length = leg.length();
    const double half = (request.volume.min.x() + request.volume.max.x()) / 2;
    static std::atomic<int> calls = 0;
    switch (kFlaw) {
      case Flaw::mean:  // by its ends: a step in the middle of a leg counts half
        return length * (1 + (leg.from.x() > half) + (leg.to.x() > half));
      case Flaw::negative:
        return leg.to.x() > half ? -length : length;
      case Flaw::by_place:
        return length * std::max(1.0, leg.at(0.5).z() / 1e4 + 1);
      case Flaw::by_heading:
        return leg.turns() ? length : length + std::max(0.0, leg.to.z() - leg.from.z());
      case Flaw::by_time:
        return length * (1 + time_s / 1e5);
      case Flaw::counts:
        return length * (1 + 1e-12 * ++calls);
      default:
        return length * (1 + 1e-6 * kOther());
    }
  }
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    const double length = (to - from).norm();
    switch (kFlaw) {
      case Flaw::too_high:
        return 1.01 * length;
      case Flaw::near_box:  // consistent from far away alone
        return length < 100 ? 0 : length;
      case Flaw::from_itself:
        return std::max(length, 1.0);
      case Flaw::negative:
        return 0;
      default:
        return length;
    }
  }
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    return {kFlaw == Flaw::flat ? (route[route.size() - 1] - route[0]).norm()
                                : legs_cost(route, request)};
  }
  double do_min_cost(const Request& request) const override {
    const double bound = Objective::bound(request.start.position, request.goal.position, request);
    return kFlaw == Flaw::dear ? 2 * bound : bound;
  }
  std::string do_unit() const override { return "m"; }
  Traits do_traits() const override { return {.place = kFlaw == Flaw::mean}; }
};
using Sound = SpoiltObjective<Flaw::none>;
template <Does kDoes>
using DoesWhat = SpoiltObjective<Flaw::none, kDoes>;
using ByAddress = SpoiltObjective<Flaw::none, does_nothing, by_address>;
}  // namespace

ALTIPLAN_PLUGIN(Objective, "sound", Sound, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Objective, "mean_of_ends", SpoiltObjective<Flaw::mean>, NoParams,
                "prices a leg by its ends alone")
ALTIPLAN_PLUGIN(Objective, "negative", SpoiltObjective<Flaw::negative>, NoParams,
                "pays for flying in the east")
ALTIPLAN_PLUGIN(Objective, "bound_too_high", SpoiltObjective<Flaw::too_high>, NoParams,
                "its bound is a hundredth too high")
ALTIPLAN_PLUGIN(Objective, "forgets_what_is_near", SpoiltObjective<Flaw::near_box>, NoParams,
                "its bound is 0 within 100 m")
ALTIPLAN_PLUGIN(Objective, "bound_to_itself", SpoiltObjective<Flaw::from_itself>, NoParams,
                "its bound from a place to itself is a metre")
ALTIPLAN_PLUGIN(Objective, "hides_the_place", SpoiltObjective<Flaw::by_place>, NoParams,
                "denies that it depends on the place")
ALTIPLAN_PLUGIN(Objective, "hides_the_heading", SpoiltObjective<Flaw::by_heading>, NoParams,
                "denies that climbing costs more than sinking")
ALTIPLAN_PLUGIN(Objective, "hides_the_time", SpoiltObjective<Flaw::by_time>, NoParams,
                "denies that it depends on the time")
ALTIPLAN_PLUGIN(Objective, "straight", SpoiltObjective<Flaw::flat>, NoParams,
                "a route costs as if it led straight to its end")
ALTIPLAN_PLUGIN(Objective, "twice_the_bound", SpoiltObjective<Flaw::dear>, NoParams,
                "its bound of whole routes is twice that between places")
ALTIPLAN_PLUGIN(Objective, "counts_calls", SpoiltObjective<Flaw::counts>, NoParams,
                "its answer depends on how often it was asked")
ALTIPLAN_BAD_ENTRIES(Objective, Sound, NoParams)
ALTIPLAN_BAD_PROCESSES(Objective, DoesWhat<changes_locale>, DoesWhat<prints>, DoesWhat<writes_file>,
                       DoesWhat<leaks>, ByAddress, NoParams)
