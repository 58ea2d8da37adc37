// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace altiplan::study {

/// The columns that a store and a table of runs share.
struct RunFacts {
  std::int64_t id = 0;  ///< given by the store; not kept by `merge`
  std::string key;
  int repetition = 0;
  std::int64_t seed = 0;
  std::string outcome;  ///< a status of a run, or crashed, out_of_memory, bad_output, refused
  std::string message;
  int place = 0;  ///< run index in the worker process (--reuse)
};

/// A run as stored; docs/study-database.md has the tables.
struct StoredRun : RunFacts {
  std::string scenario;  ///< name of the variant
  std::string pipeline;
  double wall_time_s = 0;  ///< of the run in its process
  double cpu_time_s = 0;
  double peak_memory_mb = 0;
  std::int64_t session = 0;  ///< id of the call of `study` that ran it
  std::string result;        ///< result.json, "" if there is none; compressed in the file
  std::string trace;         ///< likewise
  /// Values that claims may name: metrics, flight.…, steps.ID.…; numbers only, sorted by name.
  std::vector<std::pair<std::string, double>> values;
};

/// The name of a run in messages and on the command line: "PIPELINE SCENARIO #REPETITION".
std::string run_name(const std::string& pipeline, const std::string& scenario, int repetition);
std::string run_name(const StoredRun& run);

/// A variant as stored, complete for running it again.
struct StoredVariant {
  std::string name;
  std::string of;
  std::string file;
  std::vector<std::string> set;
};

/// One call of `study`: command, program version and host.
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
  std::string limits;  ///< how limits were enforced: "cgroup v2", "process tree, every 20 ms"
};
}  // namespace altiplan::study
