// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "study/workers/work_folder.hpp"

namespace altiplan::study {

/// A record in a worker's file: a head with a magic word, lengths and measurements, the key, the
/// payload, and a CRC-32 over all of it. Numbers are in this machine's byte order: the file does
/// not leave it.
std::string record_text(const Ended& ended);

enum class RecordState { whole, cut_off, garbled };
/// Takes the first record off the text. Sets `ended` and shortens the text if it is complete.
RecordState take_record(std::string_view& text, Ended& ended);

/// Appends to a file, creating it if needed. Returns 0 or errno.
int append_file(const std::string& file, std::string_view text);

/// The readable part of a file.
struct ReadText {
  std::string text;
  int error = 0;  ///< errno if that is not all; EINVAL if not a regular file
};
/// A file's text from that offset on; "" if it ends before.
ReadText read_from(const std::string& file, std::size_t offset, std::size_t at_most);
}  // namespace altiplan::study
