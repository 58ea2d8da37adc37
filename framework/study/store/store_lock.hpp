// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "altiplan/kit/formats/descriptor.hpp"

namespace altiplan::study {

/// The one writer of a store, by whatever name it is called: the lock is on the file itself, at
/// bytes that neither it nor SQLite's locks reach, and goes with the process. Closing it gives up
/// SQLite's locks too, so not in a transaction.
class StoreLock {
 public:
  /// Throws Error where another has it, with that one's process id.
  explicit StoreLock(const std::filesystem::path& file);

 private:
  kit::Descriptor descriptor_;
};
/// Throws Error where a process writes the store now. No store may be open in this process.
void expect_no_writer(const std::filesystem::path& file);
}  // namespace altiplan::study
