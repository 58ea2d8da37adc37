// SPDX-License-Identifier: Apache-2.0
// altiplan-ants: what a step of an ant, an iteration and the set-up of the colonies take, by the
// number of cells, and on two threads.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <vector>

#include "altiplan/error.hpp"
#include "colony.hpp"
#include "guarded.hpp"
#include "topology.hpp"

namespace altiplan::bench {
namespace {

struct Arguments {
  std::string scenario;
  std::vector<std::string> planners;
  std::vector<double> cells{8, 4, 2, 1, 0.5};
  int iterations = 50;
  int passes = 5;
};

template <class Item, class Figure>
double median(const std::vector<Item>& items, const Figure& figure) {
  std::vector<double> values;
  for (const Item& item : items) {
    values.push_back(figure(item));
  }
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double cell_count(const Request& request, double cell_m) {
  const Vec3 size = request.volume.max - request.volume.min;
  return size.x() * size.y() / (cell_m * cell_m);
}

void print(const Setting& setting, const std::vector<Pass>& passes, const Request& request) {
  const auto of = [&](const auto& figure) { return median(passes, figure); };
  const double others = setting.iterations - 1;
  const double set_up = of([](const Pass& p) { return p.set_up_ms(p.first); });
  std::printf("%-24s", setting.planner.c_str());
  if (setting.cell_m > 0) {
    const double cells = cell_count(request, setting.cell_m);
    std::printf(" %6g %8.0f %8.1f", setting.cell_m, cells, 1e6 * set_up / cells);
  } else {
    std::printf(" %6s %8s %8s", "-", "-", "-");
  }
  std::printf(" %8.2f %8.2f %9.0f %8.1f %8.3f %9.2f %9.2f %5.0f %9.2f\n", set_up,
              of([](const Pass& p) { return p.set_up_ms(p.again); }),
              of([&](const Pass& p) { return (p.again.steps - p.single.steps) / others; }),
              of([](const Pass& p) { return p.step_ns(); }),
              of([&](const Pass& p) { return p.iterations_ms(&Time::processor_ms) / others; }),
              of([](const Pass& p) { return p.first.time.processor_ms; }),
              of([](const Pass& p) { return p.again.time.processor_ms; }),
              of([](const Pass& p) { return p.again.alive; }),
              of([](const Pass& p) { return p.again.length; }));
}

/// All settings in turn, pass by pass, so that what else the machine does meets all of them.
void time_steps(host::Registry& registry, const Arguments& arguments,
                const std::vector<Setting>& settings) {
  std::vector<std::vector<Pass>> passes(settings.size());
  for (int pass = 0; pass < arguments.passes; ++pass) {
    for (std::size_t n = 0; n < settings.size(); ++n) {
      passes[n].push_back(plan_once(registry, settings[n], problem_of(arguments.scenario), pass));
    }
  }
  std::printf("%-24s %6s %8s %8s %8s %8s %9s %8s %8s %9s %9s %5s %9s\n", "planner", "cell m",
              "cells", "ns/cell", "set-up", "again", "steps", "ns/step", "ms/iter", "first ms",
              "again ms", "alive", "length");
  for (std::size_t n = 0; n < settings.size(); ++n) {
    print(settings[n], passes[n], problem_of(arguments.scenario));
  }
}

/// Wall times of the same plan, the least of all passes: another program that takes a processor
/// for a while meets two threads harder than one. Two plans at once have nothing to wait for but
/// the machine.
struct Threads {
  double one_ms = kInfinity;
  double two_ms = kInfinity;
  double one_single_ms = kInfinity;  ///< a single iteration
  double two_single_ms = kInfinity;
  double two_plans_ms = kInfinity;

  void add(const Colony& colony, Request request) {
    const auto keep = [](double& least, const Time& time) {
      least = std::min(least, time.wall_ms);
    };
    keep(one_ms, colony.all(request).time);
    keep(one_single_ms, colony.single(request).time);
    keep(two_plans_ms, colony.at_once(request, 2));
    request.threads = 2;
    keep(two_ms, colony.all(request).time);
    keep(two_single_ms, colony.single(request).time);
  }
  double efficiency() const { return one_ms / (2 * two_ms); }
  double efficiency_of_iterations() const {
    return (one_ms - one_single_ms) / (2 * (two_ms - two_single_ms));
  }
};

void time_threads(host::Registry& registry, const Arguments& arguments,
                  const std::vector<Setting>& settings) {
  const Request request = problem_of(arguments.scenario);
  std::printf("\n%s\n%-24s %9s %9s %11s %11s %11s\n", topology().c_str(), "planner", "1: ms",
              "2: ms", "efficiency", "of a plan", "two plans");
  for (const Setting& setting : settings) {
    const Colony colony(registry, setting);
    Threads least;
    for (int pass = 0; pass < 3 * arguments.passes; ++pass) {
      least.add(colony, request);
    }
    std::printf("%-24s %9.2f %9.2f %11.2f %11.2f %11.2f\n", setting.planner.c_str(), least.one_ms,
                least.two_ms, least.efficiency_of_iterations(), least.efficiency(),
                least.one_ms / least.two_plans_ms);
  }
}

/// The colonies of paper 004 that there are, in its cells.
std::vector<Setting> paper_colonies(const host::Registry& registry, int iterations) {
  std::vector<Setting> found;
  const std::vector<std::string> offered = registry.names("planner");
  for (const Setting& colony :
       {Setting{"ant_colony", 4, iterations}, Setting{"improved_ant_colony", 1, iterations}}) {
    if (std::find(offered.begin(), offered.end(), colony.planner) != offered.end()) {
      found.push_back(colony);
    }
  }
  if (found.empty()) {
    throw Error("the plugins offer no colony");
  }
  return found;
}

void time_all(const Arguments& arguments) {
  host::Registry registry(host::Registry::search_path({}));
  std::vector<Setting> colonies;
  for (const std::string& planner : arguments.planners) {
    colonies.push_back({planner, 0, arguments.iterations});
  }
  if (colonies.empty()) {
    colonies = paper_colonies(registry, arguments.iterations);
  }
  std::vector<Setting> by_cells;
  for (const Setting& colony : colonies) {
    for (const double cell_m : arguments.cells) {
      by_cells.push_back({colony.planner, cell_m, arguments.iterations});
    }
  }
  time_steps(registry, arguments, colonies);
  time_threads(registry, arguments, colonies);
  if (!by_cells.empty()) {
    std::printf("\n");
    time_steps(registry, arguments, by_cells);
  }
}

int run(int argc, char** argv) {
  CLI::App app("Times ant colonies.", "altiplan-ants");
  Arguments arguments;
  app.add_option("scenario", arguments.scenario, "in level flight, without a mission of its own")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--planner", arguments.planners,
                 "name and parameters in YAML: 'ant_colony {ants: 50}'; again for more. By default "
                 "the colonies that there are")
      ->type_name("TEXT");
  app.add_option("--iterations", arguments.iterations, "of a plan")->check(CLI::Range(2, 100'000));
  app.add_option("--cells", arguments.cells, "edges of a cell to grow by, in metres; 0 for none");
  app.add_option("--passes", arguments.passes, "each with its own seed; printed are medians")
      ->check(CLI::Range(1, 1000));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? cli::kDone : cli::kUsage;
  }
  std::erase(arguments.cells, 0.0);
  return cli::guarded("altiplan-ants", [&] {
    time_all(arguments);
    return cli::kDone;
  });
}
}  // namespace
}  // namespace altiplan::bench

int main(int argc, char** argv) { return altiplan::bench::run(argc, argv); }
