// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runner.hpp"

namespace altiplan::cli {

/// What was looked at, and how a test of it is seen again.
struct CheckedLibrary {
  std::string file;   ///< as the user named it
  std::string build;  ///< GNU build id
  std::uint64_t seed = 1;
  double time_s = 0;
  std::string command;  ///< that runs one test, up to its name
};

/// The call that shows the verdict again: in the process itself, where that can show it.
std::string reproduce(const CheckedLibrary& library, const Verdict& verdict);

/// One verdict in lines, as the user reads them.
std::string verdict_text(const CheckedLibrary& library, const Verdict& verdict);
/// How many passed, failed and had nothing to do.
std::string summary_text(const CheckedLibrary& library, const std::vector<Verdict>& verdicts);
/// docs/reference/check-plugin.md
nlohmann::ordered_json verdicts_json(const CheckedLibrary& library,
                                     const std::vector<Verdict>& verdicts);
/// As build servers read it: a suite for each plugin, a case for each test.
std::string verdicts_junit(const CheckedLibrary& library, const std::vector<Verdict>& verdicts);
}  // namespace altiplan::cli
