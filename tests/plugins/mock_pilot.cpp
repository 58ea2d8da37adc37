// SPDX-License-Identifier: Apache-2.0
// A pilot written against the public headers alone: straight to the goal, stuck where that is not
// free.
#include <algorithm>

#include "altiplan/local_planner.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double look_m = 100;
  void describe(Fields& f) {
    f("look_m", look_m).unit("m").greater_than(0).doc("how far ahead the way must be free");
  }
};

class Straight final : public Pilot {
 public:
  Straight(const Params& params, const Request& request)
      : look_m_(params.look_m),
        vehicle_(request.vehicle),
        clearance_(std::max(request.limits.min_clearance, request.vehicle.radius_m)) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    ++steps_;
    const Vec3& here = seen.state.position;
    const Vec3 way = seen.goal.position - here;
    const double left = way.norm();
    if (seen.goal.reached_at(here)) {
      return {{seen.state.time_s + seen.max_dt_s, here, Vec3::Zero()},
              PilotStep::Outcome::arrived,
              "at the goal"};
    }
    const double speed = vehicle_.speed_at(seen.world->clearance(here));
    const double run = std::min({left, speed * seen.max_dt_s, look_m_});
    const Vec3 heading = way / left;
    // Of what is farther than look_m the pilot does not know; a step is no longer than that.
    if (seen.world->blocked(here, here + heading * std::max(0.0, run), clearance_)) {
      return {seen.state, PilotStep::Outcome::stuck, "something is in the way"};
    }
    const bool arrives = run == left;
    return {{seen.state.time_s + run / speed, arrives ? seen.goal.position : here + heading * run,
             heading * speed},
            arrives ? PilotStep::Outcome::arrived : PilotStep::Outcome::flying,
            "straight to the goal"};
  }
  double do_reach_m() const override { return look_m_ + clearance_; }
  Counters do_counters() const override { return {{"steps", steps_}}; }

  double look_m_;
  Vehicle vehicle_;
  double clearance_;
  std::int64_t steps_ = 0;
};

class StraightOn final : public LocalPlanner {
 public:
  explicit StraightOn(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return std::make_unique<Straight>(params_, request);
  }
  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "straight_on", StraightOn, Params,
                "straight to the goal, stuck where that is not free")
