// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>

#include "altiplan/error.hpp"

namespace altiplan::formats {

/// A file that cannot be read; the message is "FILE: why".
class ALTIPLAN_API InputError : public Error {
 public:
  InputError(const std::string& file, const std::string& why)
      : Error(file + ": " + why), why_(why) {}
  ~InputError() override;
  /// The reason without the file, for messages that name the file otherwise.
  const std::string& why() const { return why_; }

 private:
  std::string why_;
};

/// "; did you mean 'b.tif'?" of the files, or folders, beside one that does not exist; "" if none
/// has a similar name.
ALTIPLAN_API std::string nearest_beside(const std::string& missing, bool is_folder);

/// Why a name cannot be read as a file: "there is no such file", with the nearest name, "is a
/// folder, expected a file"; "" for a regular file that may be opened. Never blocks: reading a
/// pipe, a socket or a device may never end, so these and links to them are refused.
ALTIPLAN_API std::string why_unreadable(const std::string& file);

/// A regular file as a stream of bytes. Opening it, and reading from it, throws InputError.
class ALTIPLAN_API InputFile : public std::istream {
 public:
  explicit InputFile(const std::string& file);
  ~InputFile() override;

 private:
  std::unique_ptr<std::streambuf> buffer_;
};

/// The name's extension in small letters, ".kml" of AREA.KML.
ALTIPLAN_API std::string ending_of(const std::string& file);

/// Content of the file; throws InputError if it is not a regular file, cannot be read, or is
/// larger.
ALTIPLAN_API std::string read_file(const std::string& file, std::uintmax_t max_bytes = 64'000'000);
}  // namespace altiplan::formats
