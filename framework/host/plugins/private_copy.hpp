// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "altiplan/formats/descriptor.hpp"

namespace altiplan::host {

/// An immutable copy of a file in memory. Libraries are mapped from such copies, since overwriting
/// a library in place (`cp`) changes it in every process that has it mapped. Forked processes share
/// the pages. (If RLIMIT_FSIZE forbids a file of that size, the file itself is mapped.)
class PrivateCopy {
 public:
  /// Throws Error if the file cannot be read, or there is no memory for it.
  explicit PrivateCopy(const std::filesystem::path& file);

  /// A path to the copy, valid as long as this process lives, for its debugger too.
  std::filesystem::path path() const;
  /// A path not used before in this process: glibc identifies a known path with the library already
  /// loaded from it.
  std::filesystem::path path_to_load();

 private:
  formats::Descriptor descriptor_{-1};
};
}  // namespace altiplan::host
