// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace altiplan::host {

/// What of this process belongs to the program and not to its plugins: stdout, the working folder,
/// the locale, the rounding mode, and what happens when the process ends. One at a time.
///
/// While it lives, what is written to stdout is kept apart and goes to stderr; the way the process
/// ends (a fatal signal, exit) is caught and answered with the crash report.
class ProcessGuard {
 public:
  ProcessGuard();
  /// Gives stdout back.
  ~ProcessGuard();
  ProcessGuard(const ProcessGuard&) = delete;
  ProcessGuard& operator=(const ProcessGuard&) = delete;

  /// Puts back what was changed since the last call and names it ("changed the locale, …"); ""
  /// where all is as it was.
  std::string restore();
  /// Passes on to stderr what was written to stdout since the last call; whether there was
  /// anything.
  bool pass_on_output();

  /// Where the result goes while plugins may still write to stdout; -1 where it is closed.
  int true_stdout() const;
  /// What was written to stdout and is not yet passed on, MiB; it is memory that the process holds.
  double kept_mb() const;

  /// What to say when the process ends before its time; kCause in it stands for what ended it.
  struct CrashReport {
    static constexpr char kCause = '\1';
    std::string for_user;  ///< on stderr
    std::string result;    ///< on stdout and in `file`; "" where none is wanted
    bool on_stdout = false;
    std::string file;  ///< absolute; "" where none is wanted
    int exit_code = 4;
  };
  void set_crash_report(CrashReport words);
  /// The same moment puts this file in its place as far as it is written; absolute names.
  void keep_as_it_is(std::string beside, std::string place);
};
}  // namespace altiplan::host
