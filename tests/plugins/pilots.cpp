// SPDX-License-Identifier: Apache-2.0
// A pilot and a smoother that do as they are told, well or badly.
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

#include "altiplan/local_planner.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {
using namespace altiplan;

struct PilotParams {
  std::string does = "straight";
  void describe(Fields& f) {
    f("does", does)
        .one_of({"straight", "stuck", "hovers", "lies", "throws", "throws_int", "nan", "no_pilot",
                 "never_stops"})
        .doc("what it does");
  }
};

class ToldPilot final : public Pilot {
 public:
  ToldPilot(std::string does, double speed) : does_(std::move(does)), speed_(speed) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    PilotStep step;
    step.next = seen.state;
    step.next.time_s += seen.max_dt_s;
    if (does_ == "throws") {
      throw std::runtime_error("lost the stick");
    }
    if (does_ == "throws_int") {
      throw 42;
    }
    while (does_ == "never_stops") {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (does_ == "stuck") {
      step.outcome = PilotStep::Outcome::stuck;
      step.why = "no way is open";
    } else if (does_ == "nan") {
      step.next.position.x() = std::numeric_limits<double>::quiet_NaN();
    } else if (does_ == "lies") {
      step.outcome = PilotStep::Outcome::arrived;
    } else if (does_ == "straight") {
      const Vec3 way = seen.goal.position - seen.state.position;
      const double run = speed_ * seen.max_dt_s;
      step.next.position = way.norm() <= run ? seen.goal.position
                                             : Vec3(seen.state.position + way.normalized() * run);
    }
    return step;
  }
  double do_reach_m() const override { return 200; }
  std::string does_;
  double speed_;
};

class ToldLocalPlanner final : public LocalPlanner {
 public:
  explicit ToldLocalPlanner(const PilotParams& params) : params_(params) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return params_.does == "no_pilot"
               ? nullptr
               : std::make_unique<ToldPilot>(params_.does, request.vehicle.speed_mps);
  }
  PilotParams params_;
};

struct SmootherParams {
  std::string does = "nothing";
  Vec3 past_m{0, 0, 0};
  void describe(Fields& f) {
    f("does", does).one_of({"nothing", "past", "cuts", "moves_end", "never_stops"}).doc("what");
    f("past_m", past_m).unit("m").doc("of past: the one waypoint between");
  }
};

class ToldSmoother final : public Smoother {
 public:
  explicit ToldSmoother(const SmootherParams& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request&) const override {
    while (params_.does == "never_stops") {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = route;
    if (params_.does == "past") {
      result.route = {route.front(), params_.past_m, route.back()};
    } else if (params_.does == "cuts") {
      result.route = {route.front(), route.back()};
    } else if (params_.does == "moves_end") {
      result.route.edit().back().x() += 5;
    }
    return result;
  }
  SmootherParams params_;
};
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "told_pilot", ToldLocalPlanner, PilotParams, "flies as it is told")
ALTIPLAN_PLUGIN(Smoother, "told_smoother", ToldSmoother, SmootherParams, "smooths as it is told")
