// SPDX-License-Identifier: Apache-2.0
#include "host/base/sha256.hpp"

#include <fcntl.h>
#include <sha2.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <map>
#include <mutex>
#include <tuple>

#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::host {
namespace {

/// "" if the file cannot be read.
std::string sum_of(const std::filesystem::path& file) {
  const int from = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  int error = from < 0 ? errno : 0;
  SHA2_CTX context;
  SHA256Init(&context);
  std::array<std::uint8_t, 65536> bytes;
  for (ssize_t got = 1; error == 0 && got != 0;) {
    got = ::read(from, bytes.data(), bytes.size());
    error = got < 0 && errno != EINTR ? errno : 0;
    SHA256Update(&context, bytes.data(), std::size_t(got > 0 ? got : 0));
  }
  if (from >= 0) {
    ::close(from);
  }
  if (is_machine_fault(error)) {
    throw MachineFault(unreadable(file, error));
  }
  char text[SHA256_DIGEST_STRING_LENGTH];
  return error == 0 ? SHA256End(&context, text) : "";
}
}  // namespace

std::string sha256(const std::filesystem::path& file) {
  // Sums are cached: a result is written before each plugin call, and large files take seconds.
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
  if (!std::filesystem::is_regular_file(status_of(file))) {
    return "";
  }
  const std::string sum = sum_of(file);
  if (is_settled && !sum.empty()) {
    known[state] = sum;
  }
  return sum;
}

std::string sha256_of_present(const std::filesystem::path& file) {
  std::string sum = sha256(file);
  if (sum.empty() && !is_folder(file)) {
    if (const std::string why = formats::why_unreadable(file.string()); !why.empty()) {
      throw MachineFault(file.string() + ": " + why);
    }
    sum = sha256(file);  // the fault may have passed
    if (sum.empty()) {
      throw MachineFault(file.string() + ": cannot be read");
    }
  }
  return sum;
}

std::string sha256_of(std::string_view bytes) {
  char text[SHA256_DIGEST_STRING_LENGTH];
  SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), text);
  return text;
}
}  // namespace altiplan::host
