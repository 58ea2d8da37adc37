// SPDX-License-Identifier: Apache-2.0
// Time and memory of astar with exact moves over ground: with a ground clearance alone, within
// limits on turns and climbs too, to goals that are shut in, and on a fine lattice. Each pass plans
// every problem with a new planner, and once more with the same.
#include <malloc.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "measuring.hpp"
#include "problems.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

/// Resident memory that the program takes at most beyond what it had before, as Linux counts it.
class PeakMemory {
 public:
  PeakMemory() {
    malloc_trim(0);
    std::ofstream refs("/proc/self/clear_refs");
    refs << 5 << std::flush;  // the peak is what is resident now
    is_known_ = refs.good();
    before_kb_ = status_kb("VmRSS:");
  }
  /// NaN if the system does not say.
  double mb() const { return is_known_ ? (status_kb("VmHWM:") - before_kb_) / 1024 : NAN; }

 private:
  static double status_kb(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
      if (word == key) {
        double kb = NAN;
        status >> kb;
        return kb;
      }
    }
    return NAN;
  }
  bool is_known_ = false;
  double before_kb_ = 0;
};

struct Answer {
  double ms = 0;
  double length = 0;  ///< metres; infinite: proved that there is no route
  double expanded = 0;
  double cells = 0;
};

/// Throws WrongAnswer if the judge rejects the route, or a shut goal is not proved to be; Error if
/// there is no route on the ground that was chosen.
Answer answer(const Planner& planner, const TerrainProblem& problem) {
  const double began = thread_s();
  const PlanResult result = planner.plan(problem.request);
  const double ms = 1e3 * (thread_s() - began);
  if (problem.is_shut_in && (result.status != PlanStatus::no_route || !result.proved)) {
    throw WrongAnswer(problem.name +
                      ": expected a proof that there is no route: " + result.message);
  }
  if (!problem.is_shut_in && result.status != PlanStatus::solved) {
    throw Error(problem.name + ": expected ground with a route: " + result.message);
  }
  const double length = judged_length(result, problem.request, problem.name);
  return {ms, length, counter(result, "expanded"), counter(result, "lattice_cells")};
}

struct Row {
  std::vector<double> cold_ms;
  std::vector<double> warm_ms;
  std::vector<double> memory_mb;
  Answer first;

  /// Throws WrongAnswer unless it is that of the first pass.
  void require_same(const Answer& other, const std::string& name) const {
    const bool is_same = other.length == first.length && other.expanded == first.expanded;
    if (!is_same) {
      throw WrongAnswer(name + ": " + std::to_string(other.length) + " m after " +
                        std::to_string(other.expanded) + " expansions, before " +
                        std::to_string(first.length) + " m after " +
                        std::to_string(first.expanded));
    }
  }

  void time(host::Registry& registry, const TerrainProblem& problem) {
    const PeakMemory memory;
    const std::shared_ptr<const Planner> astar = planner(registry, problem.planner);
    const Answer cold = answer(*astar, problem);
    memory_mb.push_back(memory.mb());
    const Answer warm = answer(*astar, problem);
    first = cold_ms.empty() ? cold : first;
    require_same(cold, problem.name);
    require_same(warm, problem.name);
    cold_ms.push_back(cold.ms);
    warm_ms.push_back(warm.ms);
  }

  Json figures(const std::string& name) const {
    return {{"problem", name},
            {"cells", std::size_t(first.cells)},
            {"expanded", std::size_t(first.expanded)},
            {"share", first.expanded / first.cells},
            {"length_km", first.length / 1000},
            {"cold_ms", median(cold_ms)},
            {"cold_best_ms", quantile(cold_ms, 0)},
            {"warm_ms", median(warm_ms)},
            {"warm_best_ms", quantile(warm_ms, 0)},
            {"expansions_per_s", 1e3 * first.expanded / median(warm_ms)},
            {"memory_mb", median(memory_mb)}};
  }
};

/// Throws WrongAnswer if a limit made a route shorter.
void require_longer(const std::vector<TerrainProblem>& problems, const std::vector<Row>& rows) {
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (std::size_t other = 0; other < rows.size(); ++other) {
      const double without = rows[other].first.length;
      if (problems[n].without == problems[other].name &&
          rows[n].first.length < without * (1 - 1e-6)) {
        throw WrongAnswer(problems[n].name + ": " + std::to_string(rows[n].first.length) +
                          " m, with fewer limits " + std::to_string(without) + " m");
      }
    }
  }
}

Json time_all(host::Registry& registry, const TerrainKind& kind, int passes) {
  const std::vector<TerrainProblem> problems = terrain_problems(registry, kind);
  std::vector<Row> rows(problems.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t n = 0; n < rows.size(); ++n) {
      rows[n].time(registry, problems[n]);
    }
    require_longer(problems, rows);
  }
  Json figures{{"terrain", kind.file.empty() ? "ridges" : kind.file}, {"passes", passes}};
  for (std::size_t n = 0; n < rows.size(); ++n) {
    figures["plans"].push_back(rows[n].figures(problems[n].name));
  }
  return figures;
}
}  // namespace

void add_terrain(Subcommands& all) {
  struct Arguments {
    TerrainKind kind;
    int passes = 3;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = all.add(
      "terrain", "time astar with exact moves over ground, within limits", [=](const Given& given) {
        return time_all(*given.registry, arguments->kind, arguments->passes);
      });
  TerrainKind& kind = arguments->kind;
  command
      .add_option("--terrain", kind.file,
                  "elevation model, as for the layer terrain (default: generated ridges)")
      ->type_name("FILE");
  command.add_option("--seed", kind.seed, "of the generated ridges")->capture_default_str();
  command
      .add_option("--ceiling", kind.ceiling,
                  "share of the ground that may be flown over at the ceiling")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command.add_option("--cells", kind.cells, "cells along the longer side")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  command.add_option("--fine-cells", kind.fine_cells, "the same of the fine lattice")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  command.add_option("--passes", arguments->passes, "cold and warm plans of each problem")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}
}  // namespace altiplan::bench
