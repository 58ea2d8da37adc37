// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "guarded_run.hpp"

namespace altiplan::cli {

// Missions and autopilots are left out.
decltype(host::RunOptions::judge_returns) returns_judge() { return {}; }
}  // namespace altiplan::cli

// What tools/run builds first: `altiplan run` alone, in a third of the time.
int main(int argc, char** argv) {
  return altiplan::cli::run_program(argc, argv, altiplan::cli::add_run);
}
