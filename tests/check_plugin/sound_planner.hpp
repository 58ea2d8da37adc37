// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "altiplan/kit/lattice/heading_search.hpp"
#include "misdeeds.hpp"

namespace altiplan::bad {

/// How the sound planner searches.
struct How {
  Vec3 cell_m{50, 50, 50};
  kit::Neighbourhood neighbours = kit::Neighbourhood::all;
  double weight_h = 0.5;  ///< above 0.5 it is greedy
};

/// A* over cells and headings: nothing is wrong with it.
class Sound {
 public:
  PlanResult plan(const Request& request, const How& how = {}) const {
    kit::SearchSettings settings;
    settings.cell_m = how.cell_m;
    settings.neighbours = how.neighbours;
    settings.weight_h = how.weight_h;
    settings.weight_g = 1 - how.weight_h;
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {settings.max_bytes, sizeof(kit::HeadingCell)});
    const auto memory = memory_.take();
    return kit::HeadingSearch(request, settings, lattice, kInfinity, *memory).run().result;
  }

 private:
  mutable kit::ScratchPool<kit::HeadingMemory> memory_;
};

inline PlanResult plain(const Sound& sound, const Request& request) { return sound.plan(request); }

inline Traits promises_nothing() { return {}; }

/// The sound planner, its answers spoilt by the one function, its traits told by the other.
template <PlanResult (*kPlan)(const Sound&, const Request&), Traits (*kTraits)() = promises_nothing>
class SpoiltPlanner final : public Planner {
 public:
  template <class Params>
  explicit SpoiltPlanner(const Params&) {}

 private:
  PlanResult do_plan(const Request& request) const override { return kPlan(sound_, request); }
  Traits do_traits() const override { return kTraits(); }
  Sound sound_;
};

/// Does it before each plan.
template <Does kDoes>
PlanResult after(const Sound& sound, const Request& request) {
  kDoes();
  return sound.plan(request);
}
/// Does it where the goal is a ball: in few tests.
template <Does kDoes>
PlanResult at_a_wide_goal(const Sound& sound, const Request& request) {
  if (request.goal.tolerance_m > 0) {
    kDoes();
  }
  return sound.plan(request);
}
}  // namespace altiplan::bad
