// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace altiplan::study {

/// A control group (cgroup v2) for each worker, if the system has delegated one with the memory
/// controller to this process alone (`systemd-run --user --scope -p Delegate=yes altiplan study
/// …`).
///
/// A second line of defence: the limits of a worker are checked on its process tree, and the group
/// bounds its memory between two checks. A group with children must not contain processes, so this
/// process moves into a child too, and back at the end.
class ControlGroups {
 public:
  /// Null if the system has not delegated any, or refuses to create them.
  static std::optional<std::filesystem::path> delegated();

  /// `workers` groups, each with that memory bound. Throws Error if they cannot be created.
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
