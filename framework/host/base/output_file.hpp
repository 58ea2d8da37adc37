// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/unfinished.hpp"

namespace altiplan::host {

/// A file that is replaced atomically: written beside its destination under a unique name, flushed
/// to disk, then renamed. The old file stays until then, and for good if something fails or the
/// program is interrupted. Its permissions are kept.
class OutputFile {
 public:
  /// Throws Error if the destination cannot be written, as output_problem defines it.
  explicit OutputFile(std::filesystem::path place);
  /// Removes the temporary file unless it was put in place.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Throws Error with the system's reason.
  void write(std::string_view text);
  void put_in_place();

  /// The temporary name and the final one, both absolute.
  const std::filesystem::path& beside() const { return beside_; }
  const std::filesystem::path& absolute_place() const { return absolute_place_; }

 private:
  [[noreturn]] void fail(int error);

  std::filesystem::path place_;  ///< as given, for messages
  std::filesystem::path absolute_place_;
  std::filesystem::path beside_;
  int descriptor_ = -1;
  std::optional<Unfinished> unfinished_;
};

/// Writes the whole text, or throws Error and leaves the old file.
void write_file(const std::filesystem::path& file, const std::string& text);

/// The reason why a path cannot be written: it is a folder, a pipe, a socket, a device, a symbolic
/// link (its target may be anything: the user names the file itself), or a file or folder without
/// write permission; "" if it can be written.
std::string output_problem(const std::filesystem::path& place);

/// A unique name in the same folder.
std::filesystem::path name_beside(const std::filesystem::path& place);
}  // namespace altiplan::host
