// SPDX-License-Identifier: Apache-2.0
#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <string_view>

namespace altiplan::cli {
namespace {

bool is_colored(std::FILE* to) {
  const auto value = [](const char* name) {
    const char* found = std::getenv(name);
    return std::string_view(found == nullptr ? "" : found);
  };
  return isatty(fileno(to)) == 1 && value("NO_COLOR").empty() && value("TERM") != "dumb";
}
}  // namespace

std::size_t terminal_columns(int descriptor) {
  winsize size{};
  return isatty(descriptor) == 1 && ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::string painted(std::FILE* to, Color color, const std::string& text) {
  static constexpr const char* kCodes[] = {"", "32", "31", "33", "1"};
  return color == Color::none || text.empty() || !is_colored(to)
             ? text
             : std::string("\033[") + kCodes[int(color)] + "m" + text + "\033[0m";
}

Color color_of(const std::string& status) {
  static const std::set<std::string> kGood{"accepted", "solved", "holds", "better"};
  static const std::set<std::string> kOpen{"timed_out", "cancelled", "undecided",
                                           "unclear",   "no data",   "skipped"};
  static const std::set<std::string> kNone{"same", "within tolerance", ""};
  return kGood.contains(status)   ? Color::good
         : kOpen.contains(status) ? Color::open
         : kNone.contains(status) ? Color::none
                                  : Color::bad;
}
}  // namespace altiplan::cli
