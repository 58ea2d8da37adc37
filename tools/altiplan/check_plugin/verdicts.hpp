// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/base/json.hpp"
#include "runner.hpp"

namespace altiplan::cli {

/// The checked library and the command that repeats a test of it.
struct CheckedLibrary {
  std::string file;   ///< as the user named it
  std::string build;  ///< GNU build id
  std::uint64_t seed = 1;
  double time_s = 0;
  std::string command;  ///< runs one test; the name of the test is appended
};

/// The command that reproduces the verdict, in the same process where that is possible.
std::string reproduce(const CheckedLibrary& library, const Verdict& verdict);

/// One verdict as printed for the user.
std::string verdict_text(const CheckedLibrary& library, const Verdict& verdict);
/// Numbers of passed, failed and skipped tests, time (s) and peak memory (MB).
std::string summary_text(const CheckedLibrary& library, const std::vector<Verdict>& verdicts);
/// docs/reference/check-plugin.md
nlohmann::ordered_json verdicts_json(const CheckedLibrary& library,
                                     const std::vector<Verdict>& verdicts);
/// JUnit XML: one suite per plugin, one case per test.
std::string verdicts_junit(const CheckedLibrary& library, const std::vector<Verdict>& verdicts);
}  // namespace altiplan::cli
