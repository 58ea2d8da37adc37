// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "host/base/unfinished.hpp"

namespace altiplan::study {

/// "altp" in the database header: identifies a store to `file` and to this program.
constexpr std::int64_t kApplicationId = 0x616c7470;

/// The file of a name, absolute and without symbolic links, whether it exists or not: a store has
/// one lock, whatever name it is opened by.
std::filesystem::path place_of(const std::filesystem::path& file);
/// The work folder of the processes that write a store; the owner of its lock may write the store.
std::filesystem::path work_folder_of(const std::filesystem::path& store);

/// Throws Error if the name is a folder, a pipe or a device.
void expect_regular_or_absent(const std::filesystem::path& file);

/// Removes a store, for a link its target. Throws Error with the kind of file if it is neither a
/// store nor empty.
void remove_store(const std::filesystem::path& file);
/// Throws Error unless another command may replace the file: it must be absent, empty or a database
/// that is not a store.
void expect_replaceable(const std::filesystem::path& file);
/// Removes the leftover journal of a removed database: SQLite would apply it to the next database
/// of that name. Throws Error if a file with that name is not a journal.
void remove_journal(const std::filesystem::path& database);

/// A database written under a unique name beside its destination and renamed to it once complete;
/// removed otherwise.
class NewDatabase {
 public:
  explicit NewDatabase(const std::filesystem::path& place);

  const std::filesystem::path& file() const { return file_; }
  /// Call when the database is closed.
  void put_in_place();

 private:
  std::filesystem::path place_;
  std::filesystem::path file_;
  std::optional<host::Unfinished> unfinished_;
};
}  // namespace altiplan::study
