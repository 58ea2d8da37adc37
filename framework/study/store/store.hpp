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

#include "study/model/records.hpp"

namespace altiplan::study {

enum class StoreMode { read, write };

class StoreDatabase;

/// The results of a study in one SQLite file. One writer, in atomic batches. Every function throws
/// Error naming the file: not a store, of a later version, damaged, disk full.
class Store {
 public:
  Store(const std::filesystem::path& file, StoreMode mode);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The study of the store: "name", "text" (the file), "path", "seed". Empty when new.
  std::map<std::string, std::string> study() const;
  void set_study(const std::map<std::string, std::string>& study);
  void add_variants(const std::vector<StoredVariant>& scenarios,
                    const std::vector<StoredVariant>& pipelines);
  std::vector<StoredVariant> scenarios() const;
  std::vector<StoredVariant> pipelines() const;

  std::int64_t add_session(const StoredSession& session);  ///< its id
  std::vector<StoredSession> sessions() const;

  /// Adds runs; skips those whose key is already stored.
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
  /// The trace of a run, "" if there is none.
  std::string trace(std::int64_t id) const;
  /// Removes the runs with these keys.
  void remove(const std::vector<std::string>& keys);

  const std::filesystem::path& file() const;

 private:
  std::unique_ptr<StoreDatabase> database_;
};
}  // namespace altiplan::study
