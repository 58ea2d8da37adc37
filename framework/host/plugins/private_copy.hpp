// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "altiplan/kit/formats/descriptor.hpp"

namespace altiplan::host {

/// A copy of a file in memory that nobody can change any more. Libraries are mapped from such
/// copies: who writes over a library in place (`cp`) writes into each process that has it mapped.
/// Processes that are forked from this one share the pages. (Where a file of that size may not be
/// written, RLIMIT_FSIZE, the file itself is mapped.)
class PrivateCopy {
 public:
  /// Throws Error where the file cannot be read, or there is no memory for it.
  explicit PrivateCopy(const std::filesystem::path& file);

  /// Names the copy as long as this process lives, for its debugger too.
  std::filesystem::path path() const;
  /// One that this process has not asked for before: glibc takes a path that it knows for the
  /// library that it has loaded from there.
  std::filesystem::path path_to_load();

 private:
  kit::Descriptor descriptor_{-1};
};
}  // namespace altiplan::host
