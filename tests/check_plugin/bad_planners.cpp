// SPDX-License-Identifier: Apache-2.0
// Planners that violate one clause of the contract each: routes, statuses, budgets, traits.
#include <algorithm>
#include <chrono>
#include <ctime>

#include "sound_planner.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

PlanResult begins_beside(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.goal.tolerance_m > 0 && result.status == PlanStatus::solved) {
    result.route.edit().front().x() += 1e-3;
  }
  return result;
}
PlanResult ends_beside(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.start.position.y() > 1e6 && result.status == PlanStatus::solved) {
    result.route.edit().back().x() += 1e-3;
  }
  return result;
}

Polyline straight(const Request& request) {
  return {request.start.position, request.goal.position};
}

PlanResult cuts_through(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.level_m && result.status == PlanStatus::solved) {
    result.route = straight(request);
  }
  return result;
}
PlanResult cuts_through_far_off(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.start.position.y() > 1e6 && result.status == PlanStatus::solved) {
    result.route = straight(request);
  }
  return result;
}
PlanResult makes_nan(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.level_m && result.route.size() > 4) {
    result.route.edit()[2].y() = 0 / (result.route[2].z() - *request.level_m);
  }
  return result;
}
PlanResult counts_obstacles(const Sound& sound, const Request& request) {
  const Box volume = request.volume;
  if ((volume.max - volume.min).maxCoeff() > 5000) {
    throw std::length_error("too many obstacles");
  }
  return sound.plan(request);
}

PlanResult throws_under_a_limit(const Sound& sound, const Request& request) {
  if (request.limits.max_climb < 1) {
    throw 42;
  }
  return sound.plan(request);
}
PlanResult solves_without_a_route(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.goal.tolerance_m > 0) {
    result.route.edit().clear();
  }
  return result;
}
PlanResult says_timed_out(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (request.goal.tolerance_m > 0 && result.status == PlanStatus::solved) {
    result.status = PlanStatus::timed_out;
  }
  return result;
}
PlanResult gives_no_reason(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (result.status == PlanStatus::no_route) {
    result.message.clear();
  }
  return result;
}
PlanResult says_not_reached(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (result.status == PlanStatus::no_route) {
    result.status = static_cast<PlanStatus>(7);
  }
  return result;
}
PlanResult proves_too_much(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (result.route.size() > 9) {
    result = {};
    result.status = PlanStatus::no_route;
    result.message = "there is none";
    result.proved = true;
  }
  return result;
}

PlanResult takes_none_for_all(const Sound& sound, const Request& request) {
  Request told = request;
  if (told.budget.max_iterations == 0) {
    told.budget.max_iterations = ~std::uint64_t{0};
  }
  return sound.plan(told);
}
PlanResult ignores_iterations(const Sound& sound, const Request& request) {
  Request told = request;
  told.budget.max_iterations = ~std::uint64_t{0};
  return sound.plan(told);
}
PlanResult takes_one_more(const Sound& sound, const Request& request) {
  Request told = request;
  told.budget.max_iterations += told.budget.max_iterations > 0;
  return sound.plan(told);
}
PlanResult forgets_that_time_ended(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  result.budget_hit = false;
  return result;
}
PlanResult counts_nothing(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  result.counters.clear();
  return result;
}

PlanResult deaf(const Sound& sound, const Request& request) {
  Request told = request;
  told.budget.stop = {};
  return sound.plan(told, {{25, 25, 25}});
}
PlanResult deaf_at_first(const Sound& sound, const Request& request) {
  return request.budget.stop.stop_requested() ? deaf(sound, request) : sound.plan(request);
}
PlanResult deaf_later(const Sound& sound, const Request& request) {
  return request.budget.stop.stop_requested() || request.trace != nullptr ? sound.plan(request)
                                                                          : deaf(sound, request);
}
PlanResult deaf_while_traced(const Sound& sound, const Request& request) {
  return request.trace != nullptr ? deaf(sound, request) : sound.plan(request);
}

/// Beyond the 50 ms that are allowed, by as little as shows.
constexpr auto kLate = std::chrono::milliseconds(70);

double thread_seconds() {
  timespec used{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return double(used.tv_sec) + 1e-9 * double(used.tv_nsec);
}

/// Works until it has had the time allowed and kLate of a processor: on a busy machine, waiting for
/// one is not its fault.
PlanResult late(const Sound& sound, const Request& request) {
  const double began = thread_seconds();
  std::chrono::duration<double> allowed = kLate;
  if (request.budget.deadline) {
    allowed +=
        std::max(*request.budget.deadline - Budget::Clock::now(), Budget::Clock::duration(0));
  }
  const PlanResult result = sound.plan(request);
  while (result.status == PlanStatus::timed_out && thread_seconds() - began < allowed.count()) {
  }
  return result;
}
PlanResult stops_late(const Sound& sound, const Request& request) {
  Request told = request;
  if (told.budget.stop.stop_possible() && told.budget.max_iterations > 1'000'000) {
    told.budget.stop = {};
    told.budget.deadline = Budget::Clock::now() + 3 * kLate;
  }
  return sound.plan(told);
}

PlanResult noting(PlanResult result, std::int64_t value) {
  result.counters.push_back({"noted", value});
  return result;
}
PlanResult tires(const Sound& sound, const Request& request) {
  static std::atomic<std::int64_t> calls = 0;
  return noting(sound.plan(request), ++calls / 50);
}
PlanResult counts_threads(const Sound& sound, const Request& request) {
  return noting(sound.plan(request), request.threads);
}
PlanResult remembers(const Sound& sound, const Request& request) {
  static std::atomic<double> last = 0;
  const double before = last.exchange(request.start.position.x());
  return noting(sound.plan(request), before != request.start.position.x());
}
PlanResult knows_its_thread(const Sound& sound, const Request& request) {
  static const std::thread::id kFirst = std::this_thread::get_id();
  return noting(sound.plan(request), std::this_thread::get_id() == kFirst);
}
PlanResult writes_into_its_request(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  const_cast<Request&>(request).limits.min_clearance += 1;
  return result;
}

Traits complete() {
  Traits traits;
  traits.complete = true;
  return traits;
}
PlanResult gives_up_early(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (result.route.size() > 9) {
    result = {};
    result.status = PlanStatus::no_route;
    result.message = "the route would be long";
  }
  return result;
}
using GivesUpEarly = SpoiltPlanner<gives_up_early, complete>;
PlanResult calls_it_a_matter_of_time(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  if (result.status == PlanStatus::no_route) {
    result.status = PlanStatus::timed_out;
    result.budget_hit = request.budget.max_iterations < 50'000;
    result.proved = false;
  }
  return result;
}
using CallsItAMatterOfTime = SpoiltPlanner<calls_it_a_matter_of_time, complete>;
Traits complete_and_optimal() {
  Traits traits = complete();
  traits.optimal = true;
  return traits;
}
using SoundOne = SpoiltPlanner<plain, complete_and_optimal>;
PlanResult greedy(const Sound& sound, const Request& request) {
  return sound.plan(request, {{50, 50, 50}, kit::Neighbourhood::all, 0.95});
}
using Greedy = SpoiltPlanner<greedy, complete_and_optimal>;
Traits any_angle() {
  Traits traits;
  traits.any_angle = true;
  return traits;
}
PlanResult along_the_axes(const Sound& sound, const Request& request) {
  return sound.plan(request, {{50, 50, 50}, kit::Neighbourhood::faces});
}
using AlongTheAxes = SpoiltPlanner<along_the_axes, any_angle>;
Traits anytime() {
  Traits traits;
  traits.anytime = true;
  return traits;
}
/// There and back at first, with more iterations than it takes.
PlanResult longer_with_more(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  const std::uint64_t most = request.budget.max_iterations;
  if (result.status == PlanStatus::solved && most < 50'000 &&
      most >= 2 * std::uint64_t(result.counters[0].value)) {
    const auto middle = result.route.begin() + 1;
    const Vec3 again = *middle;
    result.route.edit().insert(middle, {again, result.route.front()});
  }
  return result;
}
using LongerWithMore = SpoiltPlanner<longer_with_more, anytime>;
Traits incremental() {
  Traits traits;
  traits.incremental = true;
  return traits;
}
using PlansAfresh = SpoiltPlanner<plain, incremental>;

/// Its memory is made by the first question, and looked for when it is destroyed.
class Unused final : public Planner {
 public:
  explicit Unused(const NoParams&) {}
  ~Unused() override {
    if (!used_) {
      crashes();
    }
  }

 private:
  PlanResult do_plan(const Request& request) const override {
    used_ = true;
    return sound_.plan(request);
  }
  Traits do_traits() const override {
    used_ = true;
    return {};
  }
  Sound sound_;
  mutable std::atomic<bool> used_ = false;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "sound", SoundOne, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Planner, "keeps_scratch_files", SpoiltPlanner<after<writes_scratch_file>>, NoParams,
                "writes a file, in TMPDIR: nothing is wrong with it")
ALTIPLAN_PLUGIN(Planner, "begins_beside", SpoiltPlanner<begins_beside>, NoParams,
                "where the goal has a tolerance its route begins 1 mm beside the start")
ALTIPLAN_PLUGIN(Planner, "ends_beside", SpoiltPlanner<ends_beside>, NoParams,
                "far from the origin its route ends 1 mm beside the goal")
ALTIPLAN_PLUGIN(Planner, "cuts_through", SpoiltPlanner<cuts_through>, NoParams,
                "in level flight it goes straight through what is in the way")
ALTIPLAN_PLUGIN(Planner, "cuts_through_far_off", SpoiltPlanner<cuts_through_far_off>, NoParams,
                "far from the origin it goes straight through what is in the way")
ALTIPLAN_PLUGIN(Planner, "makes_nan", SpoiltPlanner<makes_nan>, NoParams,
                "a coordinate of a route in level flight is no number")
ALTIPLAN_PLUGIN(Planner, "counts_obstacles", SpoiltPlanner<counts_obstacles>, NoParams,
                "throws where there are too many obstacles for it")
ALTIPLAN_PLUGIN(Planner, "throws_under_a_limit", SpoiltPlanner<throws_under_a_limit>, NoParams,
                "throws a number where climb is limited")
ALTIPLAN_PLUGIN(Planner, "solves_without_a_route", SpoiltPlanner<solves_without_a_route>, NoParams,
                "says solved and returns no route, where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "says_timed_out", SpoiltPlanner<says_timed_out>, NoParams,
                "returns a route and says timed_out, where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "gives_no_reason", SpoiltPlanner<gives_no_reason>, NoParams,
                "gives no reason for finding no route")
ALTIPLAN_PLUGIN(Planner, "says_not_reached", SpoiltPlanner<says_not_reached>, NoParams,
                "uses a status of flights in place of no_route")
ALTIPLAN_PLUGIN(Planner, "proves_too_much", SpoiltPlanner<proves_too_much>, NoParams,
                "says to have proved that there is no route where it would be long")
ALTIPLAN_PLUGIN(Planner, "takes_none_for_all", SpoiltPlanner<takes_none_for_all>, NoParams,
                "takes a budget of 0 iterations for no budget")
ALTIPLAN_PLUGIN(Planner, "ignores_iterations", SpoiltPlanner<ignores_iterations>, NoParams,
                "knows no budget of iterations")
ALTIPLAN_PLUGIN(Planner, "takes_one_more", SpoiltPlanner<takes_one_more>, NoParams,
                "uses one iteration more than it may")
ALTIPLAN_PLUGIN(Planner, "forgets_that_time_ended", SpoiltPlanner<forgets_that_time_ended>,
                NoParams, "says timed_out without budget_hit")
ALTIPLAN_PLUGIN(Planner, "counts_nothing", SpoiltPlanner<counts_nothing>, NoParams,
                "does not say how many nodes it expanded")
ALTIPLAN_PLUGIN(Planner, "deaf_at_first", SpoiltPlanner<deaf_at_first>, NoParams,
                "goes on where it is stopped before it begins")
ALTIPLAN_PLUGIN(Planner, "deaf_later", SpoiltPlanner<deaf_later>, NoParams,
                "goes on where it is stopped while it searches")
ALTIPLAN_PLUGIN(Planner, "deaf_while_traced", SpoiltPlanner<deaf_while_traced>, NoParams,
                "goes on where it is stopped while it writes a trace")
ALTIPLAN_PLUGIN(Planner, "late", SpoiltPlanner<late>, NoParams, "goes on 70 ms after its deadline")
ALTIPLAN_PLUGIN(Planner, "stops_late", SpoiltPlanner<stops_late>, NoParams,
                "does not heed the stop of another thread, but ends by itself after 210 ms")
ALTIPLAN_PLUGIN(Planner, "tires", SpoiltPlanner<tires>, NoParams,
                "answers otherwise from the fiftieth call on")
ALTIPLAN_PLUGIN(Planner, "counts_threads", SpoiltPlanner<counts_threads>, NoParams,
                "its answer depends on the number of threads")
ALTIPLAN_PLUGIN(Planner, "remembers", SpoiltPlanner<remembers>, NoParams,
                "its answer depends on the request before")
ALTIPLAN_PLUGIN(Planner, "knows_its_thread", SpoiltPlanner<knows_its_thread>, NoParams,
                "its answer depends on the thread that asks")
ALTIPLAN_PLUGIN(Planner, "writes_into_its_request", SpoiltPlanner<writes_into_its_request>,
                NoParams, "changes a limit of the request that it was given")
ALTIPLAN_PLUGIN(Planner, "gives_up_early", GivesUpEarly, NoParams,
                "says to be complete, and finds no long route")
ALTIPLAN_PLUGIN(Planner, "calls_it_a_matter_of_time", CallsItAMatterOfTime, NoParams,
                "says to be complete, and timed_out where it has looked everywhere")
ALTIPLAN_PLUGIN(Planner, "greedy", Greedy, NoParams, "says to be optimal, and is greedy")
ALTIPLAN_PLUGIN(Planner, "along_the_axes", AlongTheAxes, NoParams,
                "says to fly any angle, and flies along the axes")
ALTIPLAN_PLUGIN(Planner, "longer_with_more", LongerWithMore, NoParams,
                "says to be anytime, and goes back and forth where there is time")
ALTIPLAN_PLUGIN(Planner, "plans_afresh", PlansAfresh, NoParams,
                "says to be incremental, and plans afresh")
ALTIPLAN_PLUGIN(Planner, "crashes_unused", Unused, NoParams,
                "crashes where it goes unused, with no plan made")
