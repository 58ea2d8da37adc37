// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>

#include "altiplan/error.hpp"

namespace altiplan::kit {

/// A file that cannot be read; the message is "FILE: why".
class ALTIPLAN_API InputError : public Error {
 public:
  InputError(const std::string& file, const std::string& why)
      : Error(file + ": " + why), why_(why) {}
  ~InputError() override;
  /// Without the file, for messages that name the place in another way.
  const std::string& why() const { return why_; }

 private:
  std::string why_;
};

/// What keeps a name from being read as a file: "there is no such file", "is a folder, expected a
/// file"; "" where it is a regular file that may be opened. Nothing is waited for: reading a pipe,
/// a socket or a device may never end, so none of them is input, nor is what links to one.
ALTIPLAN_API std::string why_unreadable(const std::string& file);

/// A regular file as a stream of bytes. Opening it, and whatever reads from it, throws InputError.
class ALTIPLAN_API InputFile : public std::istream {
 public:
  explicit InputFile(const std::string& file);
  ~InputFile() override;

 private:
  std::unique_ptr<std::streambuf> buffer_;
};

/// The whole file; throws InputError where it is not a regular file, cannot be read, or is larger.
ALTIPLAN_API std::string read_file(const std::string& file, std::uintmax_t max_bytes = 64'000'000);
}  // namespace altiplan::kit
