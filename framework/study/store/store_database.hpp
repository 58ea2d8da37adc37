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

/// The database of a store, and how its rows are read. Throws Error, naming the file, where it is
/// no store or holds what no store does.
class StoreDatabase {
 public:
  StoreDatabase(const std::filesystem::path& file, StoreMode mode);

  /// To be called within a transaction.
  void add_variants(const char* table, const std::vector<StoredVariant>& variants) const;
  std::vector<StoredVariant> variants(const char* table) const;

  /// Runs without results, traces and values; `rest` follows the FROM of the query.
  Statement outlines(const std::string& rest) const;
  StoredRun outline(const Statement& row) const;  ///< of a row of `outlines`
  Statement values_of_run() const;
  /// `values` are values_of_run().
  void read_values(StoredRun& run, Statement& values) const;
  /// The next row of `outlines`, with all that is stored of it.
  std::optional<StoredRun> whole_run(Statement& row) const;

  const Sqlite sqlite;

 private:
  const std::unique_ptr<const StoreLock> lock_;  ///< of a writer
  /// SQLite takes a file of a few bytes for a new database too.
  bool is_new() const;
  void create() const;
  /// A file that was cut off or is another program's is found here, and not in the middle.
  void expect_store() const;
  /// A trigger would act, and a view in a table's place give rows, that no run has left.
  void expect_tables() const;
  std::string unpacked(const StoredRun& run, const char* what, std::string_view bytes) const;
  [[noreturn]] void fail_damaged(const std::string& why) const;
};
}  // namespace altiplan::study
