// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace altiplan::cli {

inline constexpr int kDone = 0;
inline constexpr int kNoRoute = 1;
inline constexpr int kUsage = 2;
inline constexpr int kBadFile = 3;
inline constexpr int kBadPlugin = 4;
inline constexpr int kInternal = 5;
inline constexpr int kInterrupted = 130;

/// The action's exit code, or that of the exception that it threw, reported on stderr. A failed
/// write to stdout is an error too; if the reader has closed it, SIGPIPE ends the process.
int guarded(const char* program, const std::function<int()>& action);
}  // namespace altiplan::cli
