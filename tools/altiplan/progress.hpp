// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace altiplan::cli {

/// One line on stderr, overwritten in place and cut to the terminal's width; shown only on a
/// terminal.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& line);
  void clear();

 private:
  bool is_shown_;
  bool is_drawn_ = false;
};

/// Overwrites a progress line by what is printed next: "" if stderr is no terminal.
std::string over_progress();

/// What a command is doing, shown on a terminal once it has taken a second.
class Activity {
 public:
  /// The line after so many seconds.
  using Line = std::function<std::string(double seconds)>;

  explicit Activity(const std::string& what = "");
  /// Something else begins: "reading the world", shown with its seconds.
  void begin(const std::string& what);
  void begin(Line line);
  /// Clears the line; nothing is shown any more.
  void end() { thread_ = {}; }

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  Line line_;  ///< empty: nothing
  Clock::time_point began_;
  std::jthread thread_;  ///< last: ended before what it uses
};

/// The result of the work, of which the terminal shows what it is.
template <class Work>
auto busy(const std::string& what, const Work& work) {
  const Activity activity(what);
  return work();
}
}  // namespace altiplan::cli
