// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace altiplan::study {

/// A control group (cgroup v2) for each worker, where the system has delegated one with the memory
/// controller to this process alone (`systemd-run --user --scope -p Delegate=yes altiplan study
/// …`).
///
/// It is a second line: what a worker may take is judged by its process tree, and the group bounds
/// what it can take between two looks. As a group with children may hold no process, this one moves
/// into a child too, and back in the end.
class ControlGroups {
 public:
  /// None where the system has not delegated any, or does not let them be made.
  static std::optional<std::filesystem::path> delegated();

  /// `workers` groups, each with that bound of memory. Throws Error where they cannot be made.
  ControlGroups(const std::filesystem::path& own, std::size_t workers, double memory_mb);
  ~ControlGroups();
  ControlGroups(const ControlGroups&) = delete;
  ControlGroups& operator=(const ControlGroups&) = delete;

  /// The file through which a process enters a worker's group by writing "0" to it.
  std::string entrance(std::size_t worker) const;

 private:
  void leave();

  std::filesystem::path own_;
  std::vector<std::filesystem::path> workers_;
};
}  // namespace altiplan::study
