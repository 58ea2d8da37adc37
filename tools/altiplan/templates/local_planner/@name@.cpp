// SPDX-License-Identifier: Apache-2.0
#include <altiplan/check.hpp>
#include <altiplan/local_planner.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params {
  double look_ahead_m = 200;

  void describe(Fields& f) {  // the only place that lists them
    f("look_ahead_m", look_ahead_m)
        .unit("m")
        .greater_than(0)
        .doc("distance ahead that must be free");
  }
};

/// One flight: holds the pilot's whole state.
class StraightPilot final : public Pilot {
 public:
  StraightPilot(const Params& params, const Request& request)
      : params_(params), request_(request) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    // Uses the world as sensed now; the request's world is the one before take-off. Not owned: a
    // step must not allocate.
    request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), seen.world);
    const Vec3 here = seen.state.position;
    PilotStep step;
    step.next = seen.state;
    if (!leg_ok(std::nullopt, here, toward(seen, params_.look_ahead_m), request_)) {
      step.outcome = PilotStep::Outcome::stuck;
      step.why = "the path ahead is blocked";
      return step;
    }
    const double speed = request_.vehicle.speed_mps;
    const double dt = std::min(seen.max_dt_s, params_.look_ahead_m / speed);
    step.next.position = toward(seen, speed * dt);
    step.next.velocity = (step.next.position - here) / dt;
    step.next.time_s += dt;
    if (seen.goal.reached_at(step.next.position)) {
      step.outcome = PilotStep::Outcome::arrived;
    }
    return step;
  }

  /// The point that many metres toward the target, or the target if it is nearer.
  static Vec3 toward(const Observation& seen, double metres) {
    const Vec3 offset = seen.local_target - seen.state.position;
    const double left = offset.norm();
    return left > metres ? Vec3(seen.state.position + metres / left * offset) : seen.local_target;
  }

  double do_reach_m() const override {
    return params_.look_ahead_m + request_.limits.min_clearance;
  }

  Params params_;
  Request request_;
};

class StraightFlight final : public LocalPlanner {
 public:
  explicit StraightFlight(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return std::make_unique<StraightPilot>(params_, request);
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "@name@", StraightFlight, Params,
                "Straight to the target, stuck if the path is blocked")
