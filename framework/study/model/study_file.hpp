// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/params.hpp"

namespace altiplan::study {

// A study file as written: field for field, nothing resolved yet.

struct ScenarioChoice {
  std::string id;  ///< default: the file's stem
  Path file;
  std::optional<Path> from;  ///< a published set, whose scenarios vary the file
  int every = 1;             ///< of the set the first, and each so many after it
  Value set;                 ///< keys of the scenario over their values: one, a list, or FROM..TO
  void describe(Fields& f);
};

struct PipelineChoice {
  std::string id;
  Path file;
  Value set;  ///< keys of the pipeline, as above
  void describe(Fields& f);
};

/// Limits of a run. The first two apply to each plan step, the others end the run.
struct StudyBudget {
  std::optional<double> time_s;
  std::optional<std::int64_t> iterations;
  double wall_s = 600;
  std::optional<double> cpu_s;
  double memory_mb = 4096;
  void describe(Fields& f);
};

enum class Better { lower, higher };

/// A quantity that the report compares: a value of runs, or an objective of the study's own.
struct MetricChoice {
  std::string name;  ///< "length_m", "flight.length_m", "steps.route.counters.expanded"
  std::optional<std::string> better = std::nullopt;
  std::string plugin = "";  ///< an objective, whose value has this name or the given id; else ""
  Value parameters{};
  void describe(Fields& f);
};

struct ClaimEntry {
  std::string id;
  std::string that;  ///< "median(fusion.flight.length_m / astar.length_m)"
  std::string is;    ///< "<= 0.95"
  double confidence = 0.95;
  void describe(Fields& f);
};

struct StudyFile {
  int altiplan = 0;
  std::string name;
  std::vector<ScenarioChoice> scenarios;
  std::vector<PipelineChoice> pipelines;
  int repetitions = 1;
  std::int64_t seed = 0;
  StudyBudget budget;
  std::vector<MetricChoice> metrics;
  std::vector<ClaimEntry> claims;
  void describe(Fields& f);
};
}  // namespace altiplan::study
