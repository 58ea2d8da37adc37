// SPDX-License-Identifier: Apache-2.0
// Time of a velocity field step among 12, 80 and 10,000 threats. A step takes less time than
// reading a clock, so blocks of steps are timed.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

using Threats = std::vector<Cylinder>;

/// Table 1 of paper 001.
const Threats kTable1{{25592, 35739, 1013}, {7665, 17002, 4399},  {7694, 52501, 4599},
                      {11904, 42995, 8801}, {29989, 2801, 2150},  {29182, 23941, 2398},
                      {19889, 13092, 8925}, {17900, 25944, 6700}, {30996, 9401, 5197},
                      {7093, 32608, 1376},  {38581, 7291, 4932},  {12690, 31697, 4901}};

Threats random_threats(std::size_t count, double side, double min_radius, double max_radius) {
  RandomStream random = RandomStream(1).sub("field");
  Threats threats;
  for (std::size_t i = 0; i < count; ++i) {
    threats.push_back(
        {random.uniform(0, side), random.uniform(0, side), random.uniform(min_radius, max_radius)});
  }
  return threats;
}

/// On a jittered lattice, about 20 of them within 2 km of any point.
Threats crowd() {
  constexpr int kSide = 100;
  constexpr double kApart = 870;
  RandomStream random = RandomStream(1).sub("crowd");
  Threats threats;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double x = column + random.uniform(-0.4, 0.4);
      const double y = row + random.uniform(-0.4, 0.4);
      threats.push_back({kApart * x, kApart * y, random.uniform(100, 300)});
    }
  }
  return threats;
}

struct Row {
  const char* name;
  Threats threats;
  double goal;  ///< along both axes
};

Request request_of(const Row& row) {
  Request request;
  const std::vector<Shape> shapes(row.threats.begin(), row.threats.end());
  request.world = std::make_shared<const World>(
      World().with({"threats", "shape", std::make_shared<kit::ShapeLayer>(shapes), true}));
  request.start.position = {0, 0, 1000};
  request.goal = {{row.goal, row.goal, 1000}, 15};
  request.level_m = 1000;
  request.vehicle.speed_mps = 30;
  return request;
}

struct Times {
  std::vector<double> us;  ///< time of a step, one entry per block
  double in_reach = 0;     ///< threats in effect, summed over `looked`
  std::size_t looked = 0;
  std::size_t steps = 0;
};

/// Flies once, in blocks.
void fly(const LocalPlanner& planner, const Row& row, const Request& request, int max_steps,
         Times& times) {
  constexpr int kBlock = 16;
  const auto pilot = planner.begin(request);
  Observation seen;
  seen.state = request.start;
  seen.local_target = request.goal.position;
  seen.goal = request.goal;
  seen.world = request.world.get();
  for (int done = 0; done < max_steps; done += kBlock) {
    const double began = wall_s();
    for (int i = 0; i < kBlock; ++i) {
      const PilotStep step = pilot->step(seen);
      if (step.outcome != PilotStep::Outcome::flying) {
        return;
      }
      seen.state = step.next;
    }
    times.us.push_back(1e6 * (wall_s() - began) / kBlock);
    times.steps += kBlock;
    const Vec3& p = seen.state.position;
    times.in_reach +=
        double(std::count_if(row.threats.begin(), row.threats.end(), [&](const Cylinder& threat) {
          return std::hypot(p.x() - threat.x, p.y() - threat.y) <= threat.radius + pilot->reach_m();
        }));
    ++times.looked;
  }
}

/// Interleaves the rows, so that machine load affects all of them alike.
Json time_rows(host::Registry& registry, const std::string& variant, int passes) {
  const Chosen field =
      chosen(registry, "local_planner", "velocity_field {variant: " + variant + "}");
  const auto planner = field.entry.local_planner(&field.parameters);
  const std::vector<Row> rows{{"table 1", kTable1, 50e3},
                              {"random", random_threats(80, 90e3, 1000, 5000), 90e3},
                              {"crowd", crowd(), 86e3}};
  std::vector<Request> requests;
  for (const Row& row : rows) {
    requests.push_back(request_of(row));
  }
  std::vector<Times> times(rows.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      fly(*planner, rows[i], requests[i], 4000, times[i]);
    }
  }
  Json figures;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    figures["steps"].push_back({{"world", rows[i].name},
                                {"threats", rows[i].threats.size()},
                                {"in_reach", times[i].in_reach / double(times[i].looked)},
                                {"p50_us", median(times[i].us)},
                                {"p99_us", quantile(times[i].us, 0.99)},
                                {"max_us", quantile(times[i].us, 1)},
                                {"steps", times[i].steps}});
  }
  return figures;
}
}  // namespace

void add_field(Subcommands& all) {
  struct Arguments {
    int passes = 20;
    std::string variant = "paper";
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("field", "time the steps of the velocity field, through Pilot::step",
              [=](const Given& given) {
                return time_rows(*given.registry, arguments->variant, arguments->passes);
              });
  command.add_option("--passes", arguments->passes, "number of flights in each world")
      ->check(CLI::Range(1, 10000));
  command.add_option("--variant", arguments->variant, "variant of velocity_field");
}
}  // namespace altiplan::bench
