// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "guarded_run.hpp"
#include "host/first_route/first_route.hpp"

namespace altiplan::cli {

/// The files of a try, written to that folder and run; the result is written beside them. Throws
/// Error without the place in the files, which the user has not written.
host::RunResult run_in(const std::filesystem::path& folder, const host::FirstFiles& files,
                       const host::Overrides& overrides, Interrupt& interrupt);

/// A try of a wish that has ended without a route.
struct FailedTry {
  host::RouteWish wish;
  host::Overrides overrides;
  std::filesystem::path folder;  ///< with its scenario and pipeline
  int attempt = 0;
};

/// Why there is no route, as far as a run without the zones, or without the limit above, tells:
/// sentences. The runs leave no files.
std::vector<std::string> reasons_of(const FailedTry& failed, Interrupt& interrupt);
}  // namespace altiplan::cli
