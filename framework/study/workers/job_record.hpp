// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "study/workers/work_folder.hpp"

namespace altiplan::study {

/// A record as a worker's file holds it: a head with a magic word, lengths and measurements, the
/// key, the payload, and a CRC-32 over all of it. Numbers are in this machine's order: the file
/// does not leave it.
std::string record_text(const Ended& ended);

enum class RecordState { whole, cut_off, garbled };
/// Takes the first record off the text. `ended` is set, and the text shortened, where it is whole.
RecordState take_record(std::string_view& text, Ended& ended);

/// Appends to a file, which is made where there is none. 0, or the error's number.
int append_file(const std::string& file, std::string_view text);

/// What could be read of a file.
struct ReadText {
  std::string text;
  int error = 0;  ///< why that was not all; EINVAL for what is no regular file
};
/// A file's text from that offset on: "" where it ends before.
ReadText read_from(const std::string& file, std::size_t offset, std::size_t at_most);
}  // namespace altiplan::study
