// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::tune {

/// The input files of a tuning, by what depends on them.
class FileWatch {
 public:
  explicit FileWatch(const host::Json& files) {
    for (const auto& [file, hash] : files.items()) {
      stamps_.emplace_back(file, stamp(file));
    }
  }
  void expect_unchanged() const {
    for (const auto& [file, before] : stamps_) {
      if (stamp(file) != before) {
        throw Error("'" + file +
                    "' has changed since the tuning began; earlier runs are kept: restore the "
                    "file, or start over with --fresh");
      }
    }
  }

 private:
  static std::array<std::int64_t, 4> stamp(const std::string& file) {
    struct stat found {};
    if (::stat(file.c_str(), &found) != 0) {
      if (host::is_machine_fault(errno)) {
        throw host::MachineFault(host::unreadable(file, errno));
      }
      return {};
    }
    return {std::int64_t(found.st_size), std::int64_t(found.st_mtim.tv_sec),
            std::int64_t(found.st_mtim.tv_nsec), std::int64_t(found.st_ino)};
  }
  std::vector<std::pair<std::string, std::array<std::int64_t, 4>>> stamps_;
};
}  // namespace altiplan::tune
