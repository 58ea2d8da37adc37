// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/store/sqlite.hpp"
#include "study/store/store.hpp"
#include "study/store/store_lock.hpp"

namespace altiplan::study {

/// The database of a store, and the reading of its rows. Throws Error naming the file if it is not
/// a store or has invalid content.
class StoreDatabase {
 public:
  StoreDatabase(const std::filesystem::path& file, StoreMode mode);

  /// Call within a transaction.
  void add_variants(const char* table, const std::vector<StoredVariant>& variants) const;
  std::vector<StoredVariant> variants(const char* table) const;

  /// Runs without results, traces and values; `rest` follows the FROM of the query.
  Statement outlines(const std::string& rest) const;
  StoredRun outline(const Statement& row) const;  ///< from a row of `outlines`
  Statement values_of_run() const;
  /// `values` are values_of_run().
  void read_values(StoredRun& run, Statement& values) const;
  /// The next row of `outlines` as a complete run.
  std::optional<StoredRun> whole_run(Statement& row) const;

  const Sqlite sqlite;

 private:
  const std::unique_ptr<const StoreLock> lock_;  ///< of a writer
  /// Rejects a file of a few bytes, which SQLite would accept as a new database.
  bool is_new() const;
  void create() const;
  /// Detects truncated files and those of other programs before any work.
  void expect_store() const;
  /// Rejects triggers, and views in place of tables: they would change or invent rows.
  void expect_tables() const;
  std::string unpacked(const StoredRun& run, const char* what, std::string_view bytes) const;
  [[noreturn]] void fail_damaged(const std::string& why) const;
};
}  // namespace altiplan::study
