// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace altiplan::host {

/// Guards the process state that plugins must not change: stdout, the working folder, the locale,
/// the rounding mode, and how the process ends. One instance at a time.
///
/// During its lifetime, output to stdout is captured and goes to stderr; a fatal signal or exit()
/// is caught and answered with the crash report.
class ProcessGuard {
 public:
  ProcessGuard();
  /// Restores stdout.
  ~ProcessGuard();
  ProcessGuard(const ProcessGuard&) = delete;
  ProcessGuard& operator=(const ProcessGuard&) = delete;

  /// Restores what was changed since the last call and names it ("changed the locale, …"); "" if
  /// nothing was changed.
  std::string restore();
  /// Copies to stderr what was written to stdout since the last call; true if there was anything.
  bool pass_on_output();

  /// The descriptor for results while stdout is captured; -1 if stdout is closed.
  int true_stdout() const;
  /// Captured output not yet passed on, MiB; it is in memory of the process.
  double kept_mb() const;

  /// The report printed if the process ends prematurely; kCause in it is replaced by the cause.
  struct CrashReport {
    static constexpr char kCause = '\1';
    std::string for_user;  ///< on stderr
    std::string result;    ///< on stdout and in `file`; "" if not wanted
    bool on_stdout = false;
    std::string file;  ///< absolute; "" if not wanted
    int exit_code = 4;
  };
  void set_crash_report(CrashReport words);
  /// With the crash report, this unfinished file is also moved to its place; absolute names.
  void keep_as_it_is(std::string beside, std::string place);
};
}  // namespace altiplan::host
