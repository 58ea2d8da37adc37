// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "altiplan/formats/descriptor.hpp"

namespace altiplan::study {

/// Allows one writer of a store, whatever name it is opened by: the lock is on the file itself, at
/// bytes beyond its content and SQLite's locks, and is released with the process. Closing it
/// releases SQLite's locks too, so never close it in a transaction.
class StoreLock {
 public:
  /// Throws Error with the owner's process id if another process has the lock.
  explicit StoreLock(const std::filesystem::path& file);

 private:
  formats::Descriptor descriptor_;
};
/// Throws Error if a process is writing the store. No store may be open in this process.
void expect_no_writer(const std::filesystem::path& file);
}  // namespace altiplan::study
