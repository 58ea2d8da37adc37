// SPDX-License-Identifier: Apache-2.0
// Tasks broken on purpose, one thing each. The sound one passes three places in their order.
#include <algorithm>

#include "altiplan/flown_route.hpp"
#include "altiplan/request.hpp"
#include "altiplan/shape.hpp"
#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

enum class Flaw { none, slower, bound_too_high, wrong_time, through_its_island, counts };

double nothing() { return 0; }

/// A ball.
class Island final : public Environment {
 public:
  explicit Island(const Vec3& centre) : ball_(Sphere{centre, 10}) {}

 private:
  Box do_bounds() const override { return altiplan::bounds(ball_); }
  double do_clearance(const Vec3& p) const override { return signed_distance(ball_, p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return leg_distance(ball_, a, b) < r - kLengthTolerance || leg_depth(ball_, a, b) > 1e-6;
  }
  Shape ball_;
};

template <Flaw kFlaw, Does kDoes = does_nothing, double (*kOther)() = nothing>
class SpoiltTask final : public Task {
 public:
  template <class Params>
  SpoiltTask(const Params&, const Site&) {}

 private:
  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    kDoes();
    static std::atomic<int> calls = 0;
    const double drift = kFlaw == Flaw::counts ? 1e-3 * ++calls : 1e-3 * kOther();
    TaskOrder order;
    order.status = PlanStatus::solved;
    order.passes = {{{{0, 0, 100}}}, {{{300 + drift, 0, 100}}}, {{{300, 400, 100}}}};
    if (kFlaw == Flaw::slower && request.budget.max_iterations > 10) {
      order.passes.push_back({{{0, 0, 100}}});
    }
    Polyline flown{order.first(ends)};
    for (const Pass& pass : order.passes) {
      flown.push_back(pass.points[0]);
    }
    flown.push_back(order.last(ends));
    order.time_s = flown_time(Route(without_repeats(flown)), request);
    order.bound_s = kFlaw == Flaw::bound_too_high ? order.time_s : 0;
    order.time_s *= kFlaw == Flaw::wrong_time ? 1.001 : 1;
    if (kFlaw == Flaw::bound_too_high) {  // the other way round is faster
      std::swap(order.passes[1], order.passes[0]);
      order.time_s = order.bound_s =
          flown_time(Route{{300, 0, 100}, {0, 0, 100}, {300, 400, 100}}, request);
    }
    return order;
  }
  Box do_bounds() const override { return {{0, 0, 100}, {400, 400, 100}}; }
  std::shared_ptr<const Environment> do_obstacles() const override {
    return kFlaw == Flaw::through_its_island ? std::make_shared<Island>(Vec3(150, 0, 100))
                                             : nullptr;
  }
};
using Sound = SpoiltTask<Flaw::none>;
template <Does kDoes>
using DoesWhat = SpoiltTask<Flaw::none, kDoes>;
using ByAddress = SpoiltTask<Flaw::none, does_nothing, by_address>;
}  // namespace

ALTIPLAN_PLUGIN(Task, "sound", Sound, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Task, "slower_with_time", SpoiltTask<Flaw::slower>, NoParams,
                "takes longer with a larger budget")
ALTIPLAN_PLUGIN(Task, "bound_of_its_order", SpoiltTask<Flaw::bound_too_high>, NoParams,
                "its bound is the time of its own order")
ALTIPLAN_PLUGIN(Task, "wrong_time", SpoiltTask<Flaw::wrong_time>, NoParams,
                "its time is a thousandth too long")
ALTIPLAN_PLUGIN(Task, "through_its_island", SpoiltTask<Flaw::through_its_island>, NoParams,
                "joins passes through what it keeps out of")
ALTIPLAN_PLUGIN(Task, "counts_calls", SpoiltTask<Flaw::counts>, NoParams,
                "its answer depends on how often it was asked")
ALTIPLAN_BAD_ENTRIES(Task, Sound, NoParams)
ALTIPLAN_BAD_PROCESSES(Task, DoesWhat<changes_locale>, DoesWhat<prints>, DoesWhat<writes_file>,
                       DoesWhat<leaks>, ByAddress, NoParams)
