// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gdal {

/// Copies of files in memory under names that GDAL opens. GDAL does not report why a file cannot be
/// read, treats an unreadable one as damaged, and its reader of ESRI ASCII grids then never ends.
class MemoryFiles {
 public:
  /// Throws altiplan::formats::InputError if one cannot be read. The paths are absolute.
  explicit MemoryFiles(const std::vector<std::filesystem::path>& files);
  ~MemoryFiles();
  MemoryFiles(const MemoryFiles&) = delete;
  MemoryFiles& operator=(const MemoryFiles&) = delete;

  std::string name_of(const std::filesystem::path& file) const { return prefix_ + file.string(); }

 private:
  std::string prefix_;
  std::vector<std::string> names_;
  std::vector<std::string> contents_;
};

/// True for an ESRI ASCII grid, whatever its name: GDAL too goes by the first word.
bool is_text_grid(const std::filesystem::path& file);

/// A GDAL message with the files' own names.
std::string with_own_names(std::string message);
}  // namespace gdal
