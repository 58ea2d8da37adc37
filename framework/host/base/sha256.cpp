// SPDX-License-Identifier: Apache-2.0
#include "host/base/sha256.hpp"

#include <sha2.h>

#include <map>
#include <mutex>
#include <tuple>

#include "altiplan/kit/input_file.hpp"

namespace altiplan::host {

std::string sha256(const std::filesystem::path& file) {
  // A result is written down before each call of a plugin, and large files take seconds.
  using State = std::tuple<std::filesystem::path, std::uintmax_t, std::filesystem::file_time_type>;
  static std::mutex mutex;
  static std::map<State, std::string> known;
  std::error_code size_error;
  std::error_code time_error;
  const State state{std::filesystem::absolute(file, size_error),
                    std::filesystem::file_size(file, size_error),
                    std::filesystem::last_write_time(file, time_error)};
  const bool is_settled = !size_error && !time_error;
  const std::lock_guard lock(mutex);
  if (const auto found = known.find(state); is_settled && found != known.end()) {
    return found->second;
  }
  if (!kit::why_unreadable(file.string()).empty()) {
    return "";
  }
  char text[SHA256_DIGEST_STRING_LENGTH];
  const std::string sum = SHA256File(file.c_str(), text) == nullptr ? "" : text;
  if (is_settled && !sum.empty()) {
    known[state] = sum;
  }
  return sum;
}

std::string sha256_of(std::string_view bytes) {
  char text[SHA256_DIGEST_STRING_LENGTH];
  SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), text);
  return text;
}
}  // namespace altiplan::host
