// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace altiplan::host {

/// A run as the store holds it; the tables are in docs/study-database.md.
struct StoredRun {
  std::int64_t id = 0;  ///< given by the store; not kept by `merge`
  std::string key;
  std::string scenario;  ///< name of the variant
  std::string pipeline;
  int repetition = 0;
  std::int64_t seed = 0;
  std::string outcome;  ///< a status of a run, or crashed, out_of_memory, bad_output, refused
  std::string message;
  double wall_time_s = 0;  ///< of the run in its process
  double cpu_time_s = 0;
  double peak_memory_mb = 0;
  int place = 0;             ///< how many runs the process had done before (--reuse)
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

enum class StoreMode { read, write };

class StoreDatabase;

/// The results of a study in one SQLite file. One writer, in batches; a batch is all there or not.
/// Every function throws Error naming the file: not a store, of a later version, damaged, disk
/// full.
class Store {
 public:
  Store(const std::filesystem::path& file, StoreMode mode);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The study that the store is of: "name", "text" (the file), "path", "seed". Empty when new.
  std::map<std::string, std::string> study() const;
  void set_study(const std::map<std::string, std::string>& study);
  void add_variants(const std::vector<StoredVariant>& scenarios,
                    const std::vector<StoredVariant>& pipelines);
  std::vector<StoredVariant> scenarios() const;
  std::vector<StoredVariant> pipelines() const;

  std::int64_t add_session(const StoredSession& session);  ///< its id
  std::vector<StoredSession> sessions() const;

  /// Adds runs; one whose key is there already is left out.
  void add(const std::vector<StoredRun>& runs);
  /// Keys of all runs.
  std::vector<std::string> keys() const;
  /// All runs, without results, traces and values, in the order of `runs`.
  std::vector<StoredRun> outlines() const;
  /// All runs, without results and traces, ordered by scenario, pipeline, repetition (variants in
  /// the order in which they were added).
  std::vector<StoredRun> runs() const;
  /// One run with its result and trace.
  std::optional<StoredRun> run(std::int64_t id) const;
  std::optional<StoredRun> run(std::string_view key) const;
  /// The trace of a run, "" where there is none.
  std::string trace(std::int64_t id) const;
  /// Removes the runs with these keys.
  void remove(const std::vector<std::string>& keys);

  const std::filesystem::path& file() const;

 private:
  std::unique_ptr<StoreDatabase> database_;
};
}  // namespace altiplan::host
