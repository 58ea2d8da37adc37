// SPDX-License-Identifier: Apache-2.0
// The time of each step of a pilot among 20 obstacles, with and without hills.
#include <string>
#include <vector>

#include "measuring.hpp"
#include "subcommand.hpp"
#include "worlds.hpp"

namespace altiplan::bench {
namespace {

struct Times {
  std::vector<double> thread_us;
  std::vector<double> wall_us;
};

/// Measures the time of each step of another pilot.
class TimedPilot final : public Pilot {
 public:
  TimedPilot(std::unique_ptr<Pilot> pilot, Times& times)
      : pilot_(std::move(pilot)), times_(times) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    const double wall = wall_s();
    const double thread = thread_s();
    const PilotStep step = pilot_->step(seen);
    times_.thread_us.push_back(1e6 * (thread_s() - thread));
    times_.wall_us.push_back(1e6 * (wall_s() - wall));
    return step;
  }
  double do_reach_m() const override { return pilot_->reach_m(); }
  Counters do_counters() const override { return pilot_->counters(); }

  std::unique_ptr<Pilot> pilot_;
  Times& times_;
};

class TimedPlanner final : public LocalPlanner {
 public:
  TimedPlanner(std::unique_ptr<LocalPlanner> planner, Times& times)
      : planner_(std::move(planner)), times_(times) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return std::make_unique<TimedPilot>(planner_->begin(request), times_);
  }

  std::unique_ptr<LocalPlanner> planner_;
  Times& times_;
};

void add_times(Json& figures, host::Registry& registry, bool over_hills, int flights) {
  const Chosen apf = chosen(registry, "local_planner", "apf {influence_m: 1000}");
  Times times;
  const TimedPlanner planner(apf.entry.local_planner(&apf.parameters), times);
  int arrived = 0;
  for (int seed = 1; seed <= flights; ++seed) {
    host::FlightSetup setup = crowded_flight(std::uint64_t(seed), over_hills, registry);
    setup.pilot = &planner;
    setup.pilot_name = "apf";
    const host::FlightResult result = host::fly(setup);
    if (result.status == host::RunStatus::failed) {
      throw Error("flight " + std::to_string(seed) + ": " + result.message);
    }
    arrived += result.status == host::RunStatus::solved;
  }
  for (const auto& [clock, us] :
       {std::pair("thread", &times.thread_us), {"wall", &times.wall_us}}) {
    figures["steps"].push_back({{"ground", over_hills ? "hills" : "none"},
                                {"clock", clock},
                                {"p50_us", median(*us)},
                                {"p99_us", quantile(*us, 0.99)},
                                {"p99.9_us", quantile(*us, 0.999)},
                                {"max_us", quantile(*us, 1)},
                                {"steps", us->size()},
                                {"flights", flights},
                                {"arrived", arrived}});
  }
}
}  // namespace

void add_pilot(Subcommands& all) {
  struct Arguments {
    int flights = 50;
    std::string ground = "both";
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = all.add(
      "pilot", "time the steps of the potential field among 20 obstacles", [=](const Given& given) {
        Json figures;
        for (const bool hills : {false, true}) {
          if (arguments->ground == "both" || hills == (arguments->ground == "hills")) {
            add_times(figures, *given.registry, hills, arguments->flights);
          }
        }
        return figures;
      });
  command.add_option("--flights", arguments->flights, "number of flights over each ground")
      ->check(CLI::Range(1, 10000));
  command.add_option("--ground", arguments->ground, "ground: hills, none or both")
      ->check(CLI::IsMember({"hills", "none", "both"}));
}
}  // namespace altiplan::bench
