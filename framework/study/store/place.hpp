// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "host/base/unfinished.hpp"

namespace altiplan::study {

/// "altp", in a database's header: by it `file`, and this program, tell a store from others.
constexpr std::int64_t kApplicationId = 0x616c7470;

/// The file that a name means, absolute and without symbolic links, whether it is there or not: one
/// store has one lock by whatever name it is called.
std::filesystem::path place_of(const std::filesystem::path& file);
/// The folder of the calls that work on a store; who holds its lock may write the store.
std::filesystem::path work_folder_of(const std::filesystem::path& store);

/// Throws Error where the name is that of a folder, a pipe or a device.
void expect_regular_or_absent(const std::filesystem::path& file);

/// Removes a store, a link's target in place of the link. Throws Error, saying what it is, where
/// the file is neither a store nor empty.
void remove_store(const std::filesystem::path& file);
/// Throws Error where the file is neither absent, nor empty, nor a database, or is a store: what
/// another command writes would take its place.
void expect_replaceable(const std::filesystem::path& file);
/// Removes the journal of a database that was removed without it: SQLite would write it into the
/// next database of that name. Throws Error where it is another file with such a name.
void remove_journal(const std::filesystem::path& database);

/// A database that is written beside its place, under a name that nobody else has, and takes the
/// place when it is whole. Removed where it is not.
class NewDatabase {
 public:
  explicit NewDatabase(const std::filesystem::path& place);

  const std::filesystem::path& file() const { return file_; }
  /// To be called when the database is closed.
  void put_in_place();

 private:
  std::filesystem::path place_;
  std::filesystem::path file_;
  std::optional<host::Unfinished> unfinished_;
};
}  // namespace altiplan::study
