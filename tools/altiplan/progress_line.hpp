// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

namespace altiplan::cli {

/// One line on stderr, overwritten in place; shown only on a terminal.
class ProgressLine {
 public:
  ProgressLine() : is_shown_(isatty(2) == 1) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& line) {
    if (is_shown_) {
      std::fprintf(stderr, "\r\033[K%s", line.c_str());
      is_drawn_ = true;
    }
  }
  void clear() {
    if (is_drawn_) {
      std::fputs("\r\033[K", stderr);
      is_drawn_ = false;
    }
  }

 private:
  bool is_shown_;
  bool is_drawn_ = false;
};
}  // namespace altiplan::cli
