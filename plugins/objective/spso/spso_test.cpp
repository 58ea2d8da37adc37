// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/penalty/disc_detour.hpp"
#include "support/published_routes.hpp"

namespace altiplan::spso_objective_test {
namespace {

const std::vector<Vec3> kThreats{{400, 500, 80}, {600, 200, 70}, {500, 350, 80},
                                 {350, 200, 70}, {700, 550, 70}, {650, 750, 80}};

Request published() {
  Request request = testing::published_map("spso.tif", kThreats, {200, 100, 150}, {800, 800, 150});
  request.objective = testing::make_objective("spso", "{}", *request.world);
  return request;
}

TEST(SpsoObjective, EqualsTheAuthorsProgram) {
  ALTIPLAN_DATA_OR_SKIP(file, "costs/spso_routes.csv");
  const Request request = published();
  int finite = 0;
  for (const testing::NumberRow& row : testing::rows_of(file)) {
    const Route route = testing::published_route(row, request);
    const double cost = cost_of(route, request);
    testing::expect_published(cost, row.at("cost_octave"), row.at("id"));
    if (std::isfinite(cost)) {
      ++finite;
      const std::vector<double> terms = request.objective->costs(route, request);
      testing::expect_published(terms.at(0) / 5, row.at("J1"), row.at("id"));
      testing::expect_published(terms.at(1), row.at("J2"), row.at("id"));
      testing::expect_published(terms.at(2) / 10, row.at("J3"), row.at("id"));
      testing::expect_published(terms.at(3), row.at("J4"), row.at("id"));
      EXPECT_LE(min_cost(request), cost);
    }
  }
  EXPECT_GT(finite, 50);
}

TEST(SpsoObjective, TheBoundOfTheirMapIsCertified) {
  EXPECT_GT(min_cost(published()), 4642);
  EXPECT_LT(min_cost(published()), 4664.6);  // a route is known that costs 4,664.61
}

/// Without ground; a threat beside the line, so that passing it by the shortest path costs a fee.
TEST(SpsoObjective, ATermWithoutWeightIsLeftOut) {
  const World world = testing::world_of(
      testing::make_environment("zones", "{list: [{cylinder: {at_m: [500, 0], radius_m: 50}}]}"));
  Request request =
      testing::request_in(world, {0, 0, 150}, {1000, 0, 150}, {{0, -500, 0}, {1000, 500, 300}});
  request.objective = testing::make_objective("spso", "{height_weight: 0}", *request.world);
  EXPECT_EQ(cost_of(Route{{0, 0, 150}, {500, 0, -1}, {1000, 0, 150}}, request), kInfinity);
  EXPECT_LT(cost_of(Route{{0, 0, 150}, {500, 80, -1}, {1000, 0, 150}}, request), kInfinity);
}

/// One disc: tangent, arc, tangent. Two discs, the straight line between them, and closed.
TEST(DiscDetour, IsTheTautString) {
  const Threat disc{{50, 0, 0}, 30, "", ""};
  const double half = std::acos(30.0 / 50);
  const double around = 2 * 40 + 30 * (kPi - 2 * half);
  const std::vector<Threat> one{disc};
  EXPECT_NEAR(kit::shortest_detour({0, 0, 0}, {100, 0, 0}, one).length, around, 1e-9);
  EXPECT_NEAR(kit::shortest_detour({0, 0, 0}, {100, 0, 0}, one).distances.at(0), 30, 1e-9);
  const std::vector<Threat> gate{{{50, 40, 0}, 39, "", ""}, {{50, -40, 0}, 39, "", ""}};
  EXPECT_NEAR(kit::shortest_detour({0, 0, 0}, {100, 0, 0}, gate).length, 100, 1e-9);
  const std::vector<Threat> closed{{{50, 40, 0}, 41, "", ""}, {{50, -40, 0}, 41, "", ""}};
  EXPECT_GT(kit::shortest_detour({0, 0, 0}, {100, 0, 0}, closed).length, 160);
}

/// Among random discs no path over the corners of polygons around them is shorter.
TEST(DiscDetour, IsNoLongerThanAnyPathAndNearTheShortest) {
  SplitMix64 draws(3);
  for (int n = 0; n < 20; ++n) {
    std::vector<Threat> discs;
    for (int k = 0; k < 4; ++k) {
      discs.push_back({{20 + 60 * draws.uniform(), 60 * draws.uniform() - 30, 0},
                       4 + 8 * draws.uniform(),
                       "",
                       ""});
    }
    std::vector<Vec3> corners{{0, 0, 0}, {100, 0, 0}};
    constexpr int kSides = 64;
    for (const Threat& disc : discs) {
      for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * kPi * i / kSides;
        corners.push_back(disc.centre + disc.radius / std::cos(kPi / kSides) *
                                            Vec3(std::cos(angle), std::sin(angle), 0));
      }
    }
    const auto is_open = [&](const Vec3& a, const Vec3& b) {
      return std::all_of(discs.begin(), discs.end(), [&](const Threat& disc) {
        return kit::plane_distance(disc.centre, a, b) >= disc.radius - 1e-9;
      });
    };
    std::vector<double> g(corners.size(), kInfinity);  // Bellman and Ford
    g[0] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t a = 0; a < corners.size(); ++a) {
        for (std::size_t b = 1; b < corners.size() && g[a] < kInfinity; ++b) {
          const double there = g[a] + (corners[b] - corners[a]).norm();
          if (there < g[b] - 1e-12 && is_open(corners[a], corners[b])) {
            g[b] = there;
            changed = true;
          }
        }
      }
    }
    const double length = kit::shortest_detour({0, 0, 0}, {100, 0, 0}, discs).length;
    EXPECT_LE(length, g[1] + 1e-9) << n;
    EXPECT_GE(length, g[1] * (1 - 2e-3)) << n;
  }
}
}  // namespace
}  // namespace altiplan::spso_objective_test
