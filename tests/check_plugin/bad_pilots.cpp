// SPDX-License-Identifier: Apache-2.0
// Pilots broken on purpose, one thing each.
#include <algorithm>

#include "altiplan/world.hpp"
#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

enum class Flaw {
  none,
  own_mind,
  fast,
  fast_by_word,
  late,
  no_time,
  allocates,
  counts,
  sees_far,
  short_of_goal,
  hovers,
  through,
  into_the_goal,
  old_world,
  climbs,
  throws
};

double same() { return 0; }

/// Straight to the goal, stuck where that is not free; with a flaw.
template <Flaw kFlaw, double (*kOther)()>
class Straight final : public Pilot {
 public:
  explicit Straight(const Request& request) : request_(request), mind_(request.start) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    static std::atomic<int> steps = 0;
    ++steps;
    const State from = kFlaw == Flaw::own_mind ? mind_ : seen.state;
    const Vec3 way = seen.goal.position - from.position;
    if (seen.goal.reached_at(from.position)) {
      return {{seen.state.time_s + seen.max_dt_s, from.position, Vec3::Zero()},
              PilotStep::Outcome::arrived,
              "there"};
    }
    if (kFlaw == Flaw::throws && seen.world != request_.world.get()) {
      throw std::runtime_error("another world");
    }
    double speed = request_.vehicle.speed_mps;
    speed *= kFlaw == Flaw::fast ? 1.01 : 1;
    speed *= kFlaw == Flaw::counts && steps % 5 == 0 ? 0.9 : 1;
    speed *= kFlaw == Flaw::sees_far && seen.world->clearance(from.position) < kInfinity ? 0.9 : 1;
    speed *= 1 - kOther();
    const double run = std::min(way.norm(), speed * seen.max_dt_s);
    Vec3 to = run == way.norm() ? seen.goal.position : Vec3(from.position + run * way.normalized());
    const World& world = kFlaw == Flaw::old_world ? *request_.world : *seen.world;
    const bool careless = kFlaw == Flaw::into_the_goal && world.clearance(seen.goal.position) < 0;
    if (kFlaw != Flaw::through && !careless &&
        world.blocked(from.position, to, request_.vehicle.radius_m)) {
      return {seen.state, PilotStep::Outcome::stuck, "blocked"};
    }
    if (kFlaw == Flaw::allocates) {
      kept_.assign(std::size_t(steps % 7 + 1), 0.0);
      kept_.shrink_to_fit();
    }
    to.z() += kFlaw == Flaw::climbs && request_.level_m ? 1e-3 : 0;
    const double dt = kFlaw == Flaw::no_time ? 0
                      : kFlaw == Flaw::late  ? 1.1 * seen.max_dt_s
                                             : std::max(run / speed, 1e-9);
    PilotStep step{{seen.state.time_s + dt, to, speed * way.normalized()},
                   PilotStep::Outcome::flying,
                   "straight on"};
    step.next.velocity *= kFlaw == Flaw::fast_by_word ? 2 : 1;
    if (kFlaw == Flaw::hovers) {
      step.next.position = from.position;
    }
    if (kFlaw == Flaw::short_of_goal && way.norm() < 0.1 * request_.volume.max.x()) {
      step.outcome = PilotStep::Outcome::arrived;
    }
    mind_ = step.next;
    return step;
  }
  double do_reach_m() const override { return 100; }

  Request request_;
  State mind_;
  std::vector<double> kept_;
};

Traits as_it_is() { return {}; }

template <Flaw kFlaw, Traits (*kTraits)() = as_it_is, Does kDoes = does_nothing,
          double (*kOther)() = same>
class StraightOn final : public LocalPlanner {
 public:
  template <class Params>
  explicit StraightOn(const Params&) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    kDoes();
    return std::make_unique<Straight<kFlaw, kOther>>(request);
  }
  Traits do_traits() const override { return kTraits(); }
};
using Sound = StraightOn<Flaw::none>;
template <Does kDoes>
using DoesWhat = StraightOn<Flaw::none, as_it_is, kDoes>;
using ByAddress = StraightOn<Flaw::none, as_it_is, does_nothing, by_address>;

// What is not promised is not asked for.
Traits avoids_nothing() {
  Traits traits;
  traits.avoids_obstacles = false;
  return traits;
}
using ThroughByItsWord = StraightOn<Flaw::through, avoids_nothing>;
using FastByItsWord = StraightOn<Flaw::fast, avoids_nothing>;
Traits on_the_plane() {
  Traits traits;
  traits.spatial = false;
  return traits;
}
using OnTheLevel = StraightOn<Flaw::none, on_the_plane>;
using ClimbsOnTheLevel = StraightOn<Flaw::climbs, on_the_plane>;
using ThroughOnTheLevel = StraightOn<Flaw::through, on_the_plane>;
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "sound", Sound, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(LocalPlanner, "through_by_its_word", ThroughByItsWord, NoParams,
                "flies through obstacles, as its traits say: nothing is wrong with it")
ALTIPLAN_PLUGIN(LocalPlanner, "on_the_level", OnTheLevel, NoParams,
                "flies on a level alone, as its traits say: nothing is wrong with it")
ALTIPLAN_PLUGIN(LocalPlanner, "own_mind", StraightOn<Flaw::own_mind>, NoParams,
                "continues from where it wanted to be")
ALTIPLAN_PLUGIN(LocalPlanner, "fast", StraightOn<Flaw::fast>, NoParams,
                "flies 1 % faster than the vehicle can")
ALTIPLAN_PLUGIN(LocalPlanner, "fast_by_word", StraightOn<Flaw::fast_by_word>, NoParams,
                "says a velocity that is not the vehicle's")
ALTIPLAN_PLUGIN(LocalPlanner, "late", StraightOn<Flaw::late>, NoParams,
                "takes steps longer than it may")
ALTIPLAN_PLUGIN(LocalPlanner, "no_time", StraightOn<Flaw::no_time>, NoParams,
                "takes steps that last no time")
ALTIPLAN_PLUGIN(LocalPlanner, "allocates", StraightOn<Flaw::allocates>, NoParams,
                "allocates memory in its steps")
ALTIPLAN_PLUGIN(LocalPlanner, "counts", StraightOn<Flaw::counts>, NoParams,
                "every fifth step of all its pilots is a shorter one")
ALTIPLAN_PLUGIN(LocalPlanner, "sees_far", StraightOn<Flaw::sees_far>, NoParams,
                "is moved by what lies beyond its reach")
ALTIPLAN_PLUGIN(LocalPlanner, "short_of_goal", StraightOn<Flaw::short_of_goal>, NoParams,
                "says arrived before it is there")
ALTIPLAN_PLUGIN(LocalPlanner, "hovers", StraightOn<Flaw::hovers>, NoParams,
                "stays where it is, with nothing in the way")
ALTIPLAN_PLUGIN(LocalPlanner, "through", StraightOn<Flaw::through>, NoParams,
                "flies through obstacles")
ALTIPLAN_PLUGIN(LocalPlanner, "into_the_goal", StraightOn<Flaw::into_the_goal>, NoParams,
                "arrives at a goal inside an obstacle")
ALTIPLAN_PLUGIN(LocalPlanner, "old_world", StraightOn<Flaw::old_world>, NoParams,
                "looks at the world as it was at first")
ALTIPLAN_PLUGIN(LocalPlanner, "climbs", StraightOn<Flaw::climbs>, NoParams,
                "leaves its level in level flight")
ALTIPLAN_PLUGIN(LocalPlanner, "throws_at_change", StraightOn<Flaw::throws>, NoParams,
                "throws where the world is another one")
ALTIPLAN_PLUGIN(LocalPlanner, "fast_by_its_word", FastByItsWord, NoParams,
                "avoids nothing by its traits, and flies faster than the vehicle can")
ALTIPLAN_PLUGIN(LocalPlanner, "climbs_on_the_level", ClimbsOnTheLevel, NoParams,
                "flies on a level alone by its traits, and leaves it")
ALTIPLAN_PLUGIN(LocalPlanner, "through_on_the_level", ThroughOnTheLevel, NoParams,
                "flies on a level alone by its traits, and through obstacles")
ALTIPLAN_BAD_ENTRIES(LocalPlanner, Sound, NoParams)
ALTIPLAN_BAD_PROCESSES(LocalPlanner, DoesWhat<changes_locale>, DoesWhat<prints>,
                       DoesWhat<writes_file>, DoesWhat<leaks>, ByAddress, NoParams)
