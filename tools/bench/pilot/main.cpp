// SPDX-License-Identifier: Apache-2.0
// altiplan-pilot: the time of each step of a pilot among 20 obstacles, over hills and over nothing.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "host/config/config.hpp"
#include "worlds.hpp"

namespace altiplan::bench {
namespace {

struct Times {
  std::vector<double> thread_us;
  std::vector<double> wall_us;
};

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}

double wall_us() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Takes the time of each step of another.
class TimedPilot final : public Pilot {
 public:
  TimedPilot(std::unique_ptr<Pilot> pilot, Times& times)
      : pilot_(std::move(pilot)), times_(times) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    const double wall = wall_us();
    const double thread = thread_us();
    const PilotStep step = pilot_->step(seen);
    times_.thread_us.push_back(thread_us() - thread);
    times_.wall_us.push_back(wall_us() - wall);
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

void print(const char* clock, std::vector<double>& us) {
  std::sort(us.begin(), us.end());
  const auto at = [&](double share) { return us[std::size_t(share * double(us.size() - 1))]; };
  std::printf("  %-6s p50 %6.1f us, p99 %6.1f us, p99.9 %6.1f us, max %7.1f us\n", clock, at(0.5),
              at(0.99), at(0.999), at(1));
}

void time_steps(bool over_hills, int flights, host::Registry& registry) {
  Value parameters;
  parameters.kind = Value::Kind::map;
  Value influence;
  influence.text = "1000";
  parameters.entries.push_back({"influence_m", {}, influence});
  Times times;
  const TimedPlanner planner(
      host::plugin(registry, "local_planner", "apf").local_planner(&parameters), times);
  int arrived = 0;
  for (int seed = 1; seed <= flights; ++seed) {
    host::FlightSetup setup = crowded_flight(std::uint64_t(seed), over_hills, registry);
    setup.pilot = &planner;
    setup.pilot_name = "apf";
    const host::FlightResult result = host::fly(setup);
    if (result.status == Status::failed) {
      throw Error("flight " + std::to_string(seed) + ": " + result.message);
    }
    arrived += result.status == Status::solved;
  }
  std::printf("%s: %zu steps of %d flights, %d arrived\n", over_hills ? "hills" : "no ground",
              times.wall_us.size(), flights, arrived);
  print("thread", times.thread_us);
  print("wall", times.wall_us);
}
}  // namespace
}  // namespace altiplan::bench

int main(int argc, char** argv) {
  CLI::App app("Times the steps of the potential field among 20 obstacles.", "altiplan-pilot");
  int flights = 50;
  app.add_option("--flights", flights, "flights over each ground")->check(CLI::Range(1, 10000));
  std::string ground = "both";
  app.add_option("--ground", ground, "hills, none or both")
      ->check(CLI::IsMember({"hills", "none", "both"}));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    altiplan::host::Registry registry(altiplan::host::Registry::search_path({}));
    for (const bool hills : {false, true}) {
      if (ground == "both" || hills == (ground == "hills")) {
        altiplan::bench::time_steps(hills, flights, registry);
      }
    }
  } catch (const std::exception& error) {
    std::cerr << "altiplan-pilot: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
