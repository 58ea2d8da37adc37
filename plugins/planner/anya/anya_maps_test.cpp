// SPDX-License-Identifier: Apache-2.0
// Lengths of anya on published maps, compared with the published octile ones and other planners'.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::anya_maps_test {
namespace {

using testing::make_planner;

struct Scenario {
  Cell start;
  Cell goal;
  double octile;  ///< the shortest over the grid, no corner cut, rounded to 2 decimals or more
};

/// Every n-th of the scenarios of a map; rows are counted from the north there.
std::vector<Scenario> every(std::size_t n, const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<Scenario> all;
  std::string line;
  for (std::size_t number = 0; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string bucket;
    std::string map;
    int width = 0;
    int height = 0;
    Scenario s{};
    if (words >> bucket >> map >> width >> height >> s.start[0] >> s.start[1] >> s.goal[0] >>
            s.goal[1] >> s.octile &&
        number % n == 0) {
      s.start[1] = height - 1 - s.start[1];
      s.goal[1] = height - 1 - s.goal[1];
      all.push_back(s);
    }
  }
  return all;
}

class PublishedMap {
 public:
  explicit PublishedMap(const std::filesystem::path& file) {
    world_ = std::make_shared<const World>(testing::world_of(
        testing::make_environment("grid_map", "{file: '" + file.string() + "'}"), "map"));
    spec_ = world_->native_grid().value();
  }
  Request request(const Scenario& scenario) const {
    Request request;
    request.world = world_;
    request.volume = spec_.box();
    request.start.position = spec_.centre(scenario.start);
    request.goal = {spec_.centre(scenario.goal), 0};
    request.level_m = request.start.position.z();
    return request;
  }

 private:
  std::shared_ptr<const World> world_;
  GridSpec spec_;
};

TEST(AnyaMaps, NeverLongerThanTheGridThetaStarOrASmoothedRoute) {
  ALTIPLAN_DATA_OR_SKIP(folder, "grid2d");
  const auto any = make_planner("anya", "{corner: any}");
  const auto one_free = make_planner("anya", "{corner: one_free}");
  const auto theta_star = make_planner("theta_star");
  const auto jps = make_planner("jps", "{corner: any}");
  const auto prune = testing::make_smoother("prune");
  int planned = 0;
  int shorter = 0;
  for (const auto& [name, n] :
       std::vector<std::pair<std::string, std::size_t>>{{"arena", 4},
                                                        {"Berlin_0_256", 30},
                                                        {"brc202d", 120},
                                                        {"AR0603SR", 60},
                                                        {"Paris_1_512", 160},
                                                        {"32room_000", 160},
                                                        {"random512-20-0", 200},
                                                        {"maze512-8-0", 700},
                                                        {"BigGameHunters", 180}}) {
    const PublishedMap map(folder / (name + ".map"));
    for (const Scenario& scenario : every(n, folder / (name + ".map.scen"))) {
      SCOPED_TRACE(name + ", octile length " + std::to_string(scenario.octile));
      const Request request = map.request(scenario);
      const PlanResult closed = one_free->plan(request);
      const PlanResult open = any->plan(request);
      ASSERT_EQ(closed.status, PlanStatus::solved) << closed.message;
      ASSERT_EQ(open.status, PlanStatus::solved) << open.message;
      EXPECT_TRUE(check(closed.route, request).ok());
      EXPECT_TRUE(check(open.route, request).ok());
      const double way = length(closed.route);
      EXPECT_LE(way, scenario.octile + 0.006);
      EXPECT_LE(length(open.route), way * (1 + 1e-12));
      EXPECT_LE(way, length(theta_star->plan(request).route) * (1 + 1e-9));
      const Route smoothed = prune->smooth(jps->plan(request).route, request).route;
      ASSERT_FALSE(smoothed.empty());
      EXPECT_LE(length(open.route), length(smoothed) * (1 + 1e-9));
      ++planned;
      shorter += length(open.route) < length(smoothed) - 1e-6;
    }
  }
  EXPECT_GT(planned, 150);
  EXPECT_GT(shorter, planned / 3);
}
}  // namespace
}  // namespace altiplan::anya_maps_test
