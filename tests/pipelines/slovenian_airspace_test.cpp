// SPDX-License-Identifier: Apache-2.0
// A day in Slovenian airspace as published: over generated hills, from the west of the control zone
// of Ljubljana to its north-east, around it and below the terminal area, whose floor follows the
// ground.
#include <gtest/gtest.h>

#include "altiplan/geometry.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::testing::slovenian_airspace_test {
namespace {

host::Json flown(const TempFolder& folder, const std::string& data, const std::string& planner,
                 const std::string& height = "120") {
  folder.write("s.yaml",
               "altiplan: 1\nstart_time: 2023-05-25T10:00:00Z\n"
               "frame: {origin_lonlat: [14.2, 45.95]}\nenvironment:\n"
               "  - hills: {base_m: 280, cap_m: 900, count: 12, seed: 4, extent_m: 50000}\n"
               "  - zones: {file: " +
                   data +
                   "/openair_slovenia.txt}\n"
                   "volume: {min_m: [0, 0, 250], max_m: [50000, 48000, 1500]}\n"
                   "vehicle: {radius_m: 5}\n"
                   "constraints: [{clearance: {min_m: 5}}, {ground_clearance: {min_m: 20}}]\n"
                   "start: {at_lonlat: [14.22, 46.13], above_ground_m: " +
                   height +
                   "}\ngoal: {at_lonlat: [14.8, 46.27], above_ground_m: 120, tolerance_m: 200}\n");
  return run_file(folder.write("p.yaml", "altiplan: 1\nscenario: s.yaml\nsteps:\n  - plan: " +
                                             planner + "\n  - smooth: prune\n"))
      .json;
}

TEST(SlovenianAirspace, TwoPlannersGoAroundAndBelow) {
  ALTIPLAN_DATA_OR_SKIP(data, "airspace");
  const TempFolder folder;
  for (const char* planner : {"astar\n    with: {cell_m: [500, 500, 40]}", "rrt_connect"}) {
    const host::Json json = flown(folder, data.string(), planner);
    EXPECT_EQ(json.at("status"), "solved") << planner;
    EXPECT_GE(json.at("metrics").at("min_clearance_m"), 5);
    EXPECT_GT(json.at("metrics").at("length_m"), 55000);  // 47.4 km as the crow flies
  }
  // The terminal area begins 1000 ft above ground.
  const host::Json high = flown(folder, data.string(), "rrt_connect", "310");
  EXPECT_EQ(high.at("status"), "invalid_problem");
  EXPECT_NE(high.dump().find("zones"), std::string::npos);
}
}  // namespace
}  // namespace altiplan::testing::slovenian_airspace_test
