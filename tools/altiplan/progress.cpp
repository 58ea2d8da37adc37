// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <unistd.h>

#include "commands.hpp"
#include "host/base/utf8.hpp"
#include "terminal.hpp"

namespace altiplan::cli {
namespace {

/// Not through a stream, whose lock a process may inherit that is forked meanwhile.
void write_out(const std::string& text) {
  static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));
}

/// The first characters of the text, with an ellipsis if it has more; 0: all.
std::string cut(const std::string& text, std::size_t max_width) {
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++count) {
    const std::size_t last = end;
    end += host::utf8_length(std::string_view(text).substr(end));
    if (max_width > 0 && count + 1 == max_width && end < text.size()) {
      return text.substr(0, last) + "…";
    }
  }
  return text;
}
}  // namespace

ProgressLine::ProgressLine() : is_shown_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const std::string& line) {
  if (is_shown_) {
    write_out("\r\033[K" + cut(host::printable(line), terminal_columns(STDERR_FILENO)));
    is_drawn_ = true;
  }
}

void ProgressLine::clear() {
  if (is_drawn_) {
    write_out("\r\033[K");
    is_drawn_ = false;
  }
}

std::string over_progress() { return isatty(STDERR_FILENO) == 1 ? "\r\033[K" : ""; }

Activity::Activity(const std::string& what) {
  if (!what.empty()) {
    begin(what);
  }
  if (isatty(STDERR_FILENO) == 1) {
    thread_ = std::jthread([this](const std::stop_token& stop) { show(stop); });
  }
}

void Activity::begin(const std::string& what) {
  begin([what](double seconds) {
    return what + (seconds < 1 ? "" : ": " + fixed(seconds, 0) + " s");
  });
}

void Activity::begin(Line line) {
  const std::lock_guard lock(mutex_);
  line_ = std::move(line);
  began_ = Clock::now();
}

void Activity::show(const std::stop_token& stop) {
  ProgressLine shown;
  const Clock::time_point first = Clock::now();
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, std::chrono::milliseconds(500), [] { return false; });
    const Clock::time_point now = Clock::now();
    if (line_ && now - first >= std::chrono::seconds(1) && !stop.stop_requested()) {
      shown.show(line_(std::chrono::duration<double>(now - began_).count()));
    }
  }
}
}  // namespace altiplan::cli
