// SPDX-License-Identifier: Apache-2.0
// altiplan-sampling: times what sampling planners are made of beside plain ways of doing it. A row
// is timed only after its answers have been compared.
#include <iostream>

#include "rows.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  try {
    altiplan::bench::add_point_rows();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "altiplan-sampling: " << error.what() << '\n';
    return 1;
  }
  benchmark::Shutdown();
  return 0;
}
