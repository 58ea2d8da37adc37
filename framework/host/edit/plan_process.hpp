// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/edit/plan_task.hpp"

namespace altiplan::host {

/// Plans tasks that arrive at a socket, each in a process of its own, forked from this one with all
/// plugins loaded: a plugin that ends its process, or never returns, takes no other task with it. A
/// newer task of a pipeline ends the older one. Returns when the other end is closed. To be called
/// where no other thread works.
void plan_at(int socket, const std::vector<EditedPipeline>& pipelines);

/// The other end, for any number of threads.
class PlanLine {
 public:
  /// Takes the socket over.
  explicit PlanLine(int socket);
  ~PlanLine();
  PlanLine(const PlanLine&) = delete;
  PlanLine& operator=(const PlanLine&) = delete;

  /// Hands a task over and returns its number.
  std::uint64_t begin(PlanTask task);
  /// Waits for the answer; nothing if a newer task has ended this one.
  std::optional<std::string> finish(std::uint64_t number);

 private:
  void receive();

  int socket_;
  std::mutex sending_;
  std::uint64_t last_ = 0;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable arrived_;
  bool is_open_ = true;
  std::map<std::uint64_t, std::optional<std::string>> answers_;
  std::jthread receiver_;  // last: starts when everything else is constructed
};
}  // namespace altiplan::host
