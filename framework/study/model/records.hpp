// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace altiplan::study {

/// What a store and a table of runs have in common.
struct RunFacts {
  std::int64_t id = 0;  ///< given by the store; not kept by `merge`
  std::string key;
  int repetition = 0;
  std::int64_t seed = 0;
  std::string outcome;  ///< a status of a run, or crashed, out_of_memory, bad_output, refused
  std::string message;
  int place = 0;  ///< how many runs the process had done before (--reuse)
};

/// A run as the store holds it; the tables are in docs/reference/study-database.md.
struct StoredRun : RunFacts {
  std::string scenario;  ///< name of the variant
  std::string pipeline;
  double wall_time_s = 0;  ///< of the run in its process
  double cpu_time_s = 0;
  double peak_memory_mb = 0;
  std::int64_t session = 0;  ///< which call of `study` ran it
  std::string result;        ///< result.json, "" where there is none; compressed in the file
  std::string trace;         ///< likewise
  /// What claims may name: metrics, flight.…, steps.ID.…; numbers only, sorted by name.
  std::vector<std::pair<std::string, double>> values;
};

/// How people name a run, on the command line too: "PIPELINE SCENARIO #REPETITION".
std::string run_name(const std::string& pipeline, const std::string& scenario, int repetition);
std::string run_name(const StoredRun& run);

/// A variant as stored, with all that it takes to run it again.
struct StoredVariant {
  std::string name;
  std::string of;
  std::string file;
  std::vector<std::string> set;
};

/// One call of `study`: who ran what, where.
struct StoredSession {
  std::int64_t id = 0;
  std::string started;  ///< UTC, 2026-11-21T18:00:00Z
  std::string command;
  std::string version;
  std::string host;
  std::string system;
  std::string cpu;
  int cores = 0;
  double memory_mb = 0;
  int jobs = 0;
  int reuse = 1;
  std::string limits;  ///< how limits were kept: "cgroup v2", "process tree, every 20 ms"
};
}  // namespace altiplan::study
