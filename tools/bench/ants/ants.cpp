// SPDX-License-Identifier: Apache-2.0
// Times of an ant's step, an iteration and the set-up of the colonies, against the number of cells,
// and on two threads.
#include <algorithm>
#include <vector>

#include "colony.hpp"
#include "subcommand.hpp"
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
double median_of(const std::vector<Item>& items, const Figure& figure) {
  std::vector<double> values;
  for (const Item& item : items) {
    values.push_back(figure(item));
  }
  return bench::median(values);
}

double cell_count(const Request& request, double cell_m) {
  const Vec3 size = request.volume.max - request.volume.min;
  return size.x() * size.y() / (cell_m * cell_m);
}

Json row_of(const Setting& setting, const std::vector<Pass>& passes, const Request& request) {
  const auto of = [&](const auto& figure) { return median_of(passes, figure); };
  const double others = setting.iterations - 1;
  const double set_up = of([](const Pass& p) { return p.set_up_ms(p.first); });
  Json row;
  row["planner"] = setting.planner;
  if (setting.cell_m > 0) {
    const double cells = cell_count(request, setting.cell_m);
    row["cell_m"] = setting.cell_m;
    row["cells"] = cells;
    row["ns_per_cell"] = 1e6 * set_up / cells;
  }
  row["set_up_ms"] = set_up;
  row["again_set_up_ms"] = of([](const Pass& p) { return p.set_up_ms(p.again); });
  row["steps"] = of([&](const Pass& p) { return (p.again.steps - p.single.steps) / others; });
  row["ns_per_step"] = of([](const Pass& p) { return p.step_ns(); });
  row["ms_per_iteration"] =
      of([&](const Pass& p) { return p.iterations_ms(&Time::processor_ms) / others; });
  row["first_ms"] = of([](const Pass& p) { return p.first.time.processor_ms; });
  row["again_ms"] = of([](const Pass& p) { return p.again.time.processor_ms; });
  row["alive"] = of([](const Pass& p) { return p.again.alive; });
  row["length"] = of([](const Pass& p) { return p.again.length; });
  return row;
}

/// Interleaves all settings, pass by pass, so that machine load affects all of them alike.
Json time_steps(host::Registry& registry, const Arguments& arguments,
                const std::vector<Setting>& settings) {
  std::vector<std::vector<Pass>> passes(settings.size());
  for (int pass = 0; pass < arguments.passes; ++pass) {
    for (std::size_t n = 0; n < settings.size(); ++n) {
      passes[n].push_back(plan_once(registry, settings[n], problem_of(arguments.scenario), pass));
    }
  }
  Json rows = Json::array();
  for (std::size_t n = 0; n < settings.size(); ++n) {
    rows.push_back(row_of(settings[n], passes[n], problem_of(arguments.scenario)));
  }
  return rows;
}

/// Wall times of the same plan, the minimum of all passes, since another program on a processor
/// slows down two threads more than one. Two parallel plans are independent except for the machine.
struct Threads {
  double one_ms = kInfinity;
  double two_ms = kInfinity;
  double one_single_ms = kInfinity;  ///< a single iteration
  double two_single_ms = kInfinity;
  double two_plans_ms = kInfinity;

  void add(const Colony& colony, Request request) {
    const auto keep = [](double& minimum, const Time& time) {
      minimum = std::min(minimum, time.wall_ms);
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

Json time_threads(host::Registry& registry, const Arguments& arguments,
                  const std::vector<Setting>& settings) {
  const Request request = problem_of(arguments.scenario);
  Json rows = Json::array();
  for (const Setting& setting : settings) {
    const Colony colony(registry, setting);
    Threads minimum;
    for (int pass = 0; pass < 3 * arguments.passes; ++pass) {
      minimum.add(colony, request);
    }
    rows.push_back({{"planner", setting.planner},
                    {"one_ms", minimum.one_ms},
                    {"two_ms", minimum.two_ms},
                    {"efficiency", minimum.efficiency_of_iterations()},
                    {"of_a_plan", minimum.efficiency()},
                    {"two_plans", minimum.one_ms / minimum.two_plans_ms}});
  }
  return rows;
}

/// The available colonies of paper 004, in its cells.
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

Json time_all(host::Registry& registry, const Arguments& arguments) {
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
      if (cell_m != 0) {
        by_cells.push_back({colony.planner, cell_m, arguments.iterations});
      }
    }
  }
  Json figures;
  figures["machine"] = topology();
  figures["steps"] = time_steps(registry, arguments, colonies);
  figures["threads"] = time_threads(registry, arguments, colonies);
  if (!by_cells.empty()) {
    figures["by_cells"] = time_steps(registry, arguments, by_cells);
  }
  return figures;
}
}  // namespace

void add_ants(Subcommands& all) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("ants", "time steps, iterations and set-up of ant colonies",
              [=](const Given& given) { return time_all(*given.registry, *arguments); });
  command
      .add_option("scenario", arguments->scenario,
                  "scenario file in level flight, without a mission")
      ->required()
      ->check(CLI::ExistingFile);
  command
      .add_option("--planner", arguments->planners,
                  "planner plugin and its parameters in YAML: 'ant_colony {ants: 50}'; repeatable "
                  "(default: all available colonies)")
      ->type_name("TEXT");
  command.add_option("--iterations", arguments->iterations, "iterations per plan")
      ->check(CLI::Range(2, 100'000));
  command.add_option("--cells", arguments->cells, "further cell sizes to plan with (m, 0: none)");
  command
      .add_option("--passes", arguments->passes,
                  "number of passes, each with its own seed; medians are printed")
      ->check(CLI::Range(1, 1000));
}
}  // namespace altiplan::bench
