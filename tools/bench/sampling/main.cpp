// SPDX-License-Identifier: Apache-2.0
// altiplan-sampling: times what sampling planners are made of and those planners, beside plain ways
// of doing it and beside OMPL. A row is timed only after its answers have been compared or judged.
#include <iostream>

#include "rows.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  try {
    altiplan::bench::add_point_rows();
    altiplan::bench::add_connect_rows();
    altiplan::bench::add_star_rows();
    altiplan::bench::add_tree_rows();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "altiplan-sampling: " << error.what() << '\n';
    return 1;
  }
  benchmark::Shutdown();
  return 0;
}
