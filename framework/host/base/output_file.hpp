// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/unfinished.hpp"

namespace altiplan::host {

/// A file that is written as a whole or not at all: beside its place, under a name that nobody else
/// has, on the disk before it takes the place. What was there stays until then, and for good where
/// something fails or the program is interrupted. Its permissions are kept.
class OutputFile {
 public:
  /// Throws Error where the place cannot be written, by the rules of output_problem.
  explicit OutputFile(std::filesystem::path place);
  /// Removes what has not taken its place.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Throws Error with the system's reason.
  void write(std::string_view text);
  void put_in_place();

  /// The name that it has meanwhile, and the one that it is to have, both absolute.
  const std::filesystem::path& beside() const { return beside_; }
  const std::filesystem::path& absolute_place() const { return absolute_place_; }

 private:
  [[noreturn]] void fail(int error);

  std::filesystem::path place_;  ///< as it was given, for messages
  std::filesystem::path absolute_place_;
  std::filesystem::path beside_;
  int descriptor_ = -1;
  std::optional<Unfinished> unfinished_;
};

/// Writes the whole text, or throws Error and leaves what was there.
void write_file(const std::filesystem::path& file, const std::string& text);

/// What keeps a place from being written, as a sentence: a folder, a pipe, a socket, a device, a
/// symbolic link (what it leads to may be anything: the file itself is to be named), or a file or
/// folder that may not be written; "" where nothing does.
std::string output_problem(const std::filesystem::path& place);

/// A name beside the place that nobody else has.
std::filesystem::path name_beside(const std::filesystem::path& place);
}  // namespace altiplan::host
