// SPDX-License-Identifier: Apache-2.0
// altiplan-queries: times what planners ask the world most, beside the plain way of doing it and
// beside OMPL and FCL. All ask the same; a row is timed only after its answers have been compared.
#include <iostream>

#include "rows.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  try {
    altiplan::bench::add_cell_rows();
    altiplan::bench::add_terrain_rows();
    altiplan::bench::add_shape_rows(200);
    altiplan::bench::add_shape_rows(10000);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "altiplan-queries: " << error.what() << '\n';
    return 1;
  }
  benchmark::Shutdown();
  return 0;
}
