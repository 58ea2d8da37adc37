// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

namespace altiplan::bench {

/// "2 processors on 2 cores", as the system reports; under a hypervisor this may be wrong.
inline std::string topology() {
  std::set<std::string> cores;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/devices/system/cpu", none)) {
    std::ifstream file(entry.path() / "topology/thread_siblings_list");
    std::string siblings;
    if (file >> siblings) {
      cores.insert(siblings);
    }
  }
  return std::to_string(std::thread::hardware_concurrency()) + " processors on " +
         std::to_string(cores.size()) + " cores";
}
}  // namespace altiplan::bench
