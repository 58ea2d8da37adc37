// SPDX-License-Identifier: Apache-2.0
// Both ant colonies, ant for ant, against the plain ones.
#include <gtest/gtest.h>

#include "reference/colonies.hpp"
#include "reference/plain_colonies.hpp"
#include "reference/random_levels.hpp"

namespace altiplan::colony_oracle_test {
namespace {

using reference::PlainColony;
using testing::counter;
using testing::plan_of;

struct Drawn {
  testing::Drawn world;
  std::string text;
};

/// A level of cells of 10 m, of a size and density drawn from the seed.
Drawn draw_level(std::uint64_t seed, int min_columns, int max_columns) {
  SplitMix64 random(seed);
  const int columns = random.integer(min_columns, max_columns);
  const int rows = random.integer(4, 24);
  std::string level = testing::random_levels(random, columns, rows, 1, 0.2).front();
  Drawn drawn{testing::draw({level}, 10), level};
  drawn.world.request.level_m = drawn.world.request.start.position.z();
  drawn.world.request.random = RandomStream(seed);
  return drawn;
}

/// The level, ends and random stream of the request.
void set_up(PlainColony& plain, const Drawn& drawn) {
  std::string row;
  for (const char c : drawn.text) {
    if (c == '\n') {
      plain.rows.insert(plain.rows.begin(), row);
      row.clear();
    } else {
      row += c;
    }
  }
  for (int y = 0; y < plain.height(); ++y) {
    for (int x = 0; x < plain.columns(); ++x) {
      const char c = plain.rows[std::size_t(y)][std::size_t(x)];
      if (c == 'S' || c == 'G') {
        (c == 'S' ? plain.start : plain.goal) = {x, y};
      }
    }
  }
  plain.random = drawn.world.request.random;
}

std::string settings_of(const PlainColony& plain) {
  return "ants: " + std::to_string(plain.ants) +
         ", iterations: " + std::to_string(plain.iterations) +
         ", deposit_q: " + std::to_string(plain.q) +
         ", initial_pheromone: " + std::to_string(plain.tau_0) +
         ", alpha: " + std::to_string(plain.alpha) + ", beta: " + std::to_string(plain.beta) +
         ", evaporation: " + std::to_string(plain.rho);
}

bool same(PlainColony& plain, const std::string& planner, const std::string& settings,
          const Drawn& drawn) {
  plain.run();
  const PlanResult result = plan_of(planner, settings, drawn.world.request);
  Route route;
  for (const PlainColony::Place& place : plain.best) {
    route.push_back({10 * (place[0] + 0.5), 10 * (place[1] + 0.5), *drawn.world.request.level_m});
  }
  EXPECT_EQ(counter(result, "alive"), std::int64_t(plain.best_alive))
      << drawn.text << settings << "\n"
      << result.message;
  EXPECT_EQ(result.route, route) << drawn.text << settings << "\n" << result.message;
  return result.status == PlanStatus::solved;
}

struct Powers {
  double alpha;
  double beta;
  double rho;
  double q;
};
const Powers kPowers[] = {{6, 3, 0.6, 2000}, {1, 2, 0.1, 200},  {2.5, 0.5, 0.9, 5}, {0, 3, 0.6, 1},
                          {1, 5, 0, 100},    {3, 0, 0.3, 1000}, {1, 1, 0.6, 1e-3},  {2, 1, 1, 50}};

template <class Colony>
int compare(const std::string& planner, const std::string& more, std::uint64_t seeds, int least,
            int most, int iterations, Colony plain) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Drawn drawn = draw_level(seed, least, most);
    const Powers& powers = kPowers[seed % std::size(kPowers)];
    Colony one = plain;
    one.alpha = powers.alpha;
    one.beta = powers.beta;
    one.rho = powers.rho;
    one.q = powers.q;
    one.iterations = iterations;
    set_up(one, drawn);
    solved += same(one, planner, settings_of(one) + more, drawn) ? 1 : 0;
  }
  return solved;
}

TEST(ColonyOracle, AntColonyIsThePlainOne) {
  EXPECT_GE(compare("ant_colony", "", 70, 3, 24, 25, reference::PlainLegColony()), 40);
}

TEST(ColonyOracle, AntColonyOnNarrowLevels) {
  EXPECT_GE(compare("ant_colony", "", 70, 1, 2, 25, reference::PlainLegColony()), 5);
}

TEST(ColonyOracle, AntColonyOverManyIterations) {
  EXPECT_GE(compare("ant_colony", "", 16, 5, 8, 700, reference::PlainLegColony()), 5);
}

TEST(ColonyOracle, ImprovedAntColonyIsThePlainOne) {
  const std::string settings = ", reach_cells: 3, spacing_cells: 1";
  EXPECT_GE(compare("improved_ant_colony", settings, 70, 3, 24, 25, reference::PlainRegionColony()),
            40);
}

TEST(ColonyOracle, ImprovedAntColonyOverManyIterations) {
  reference::PlainRegionColony plain;
  plain.reach = 1;
  plain.spacing = 0;
  plain.ants = 10;
  const std::string settings = ", reach_cells: 1, spacing_cells: 0";
  EXPECT_GE(compare("improved_ant_colony", settings, 16, 5, 8, 700, plain), 5);
}
}  // namespace
}  // namespace altiplan::colony_oracle_test
