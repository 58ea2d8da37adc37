// SPDX-License-Identifier: Apache-2.0
// The judge and the measures against samples, and under changes of the problem.
#include <gtest/gtest.h>

#include <set>

#include "altiplan/measures.hpp"
#include "reference/isometry.hpp"
#include "reference/sampled_judge.hpp"

namespace altiplan::reference::judge_oracle_test {
namespace {

/// From the start (mostly) to the goal (mostly) by way of random places, some outside the volume.
Polyline random_route(oracle::Draw& draw, const Request& request) {
  const Box box = request.volume.grown(0.3);
  Polyline route = {request.start.position};
  for (int n = draw.below(5); n > 0; --n) {
    route.push_back(draw.within(box.min, box.max));
    if (request.level_m && draw.below(6) != 0) {
      route.back().z() = *request.level_m;
    }
  }
  route.push_back(request.goal.position);
  if (draw.below(8) == 0) {
    route.front().x() += 0.5;
  }
  if (draw.below(4) == 0) {
    route.back() += draw.point(1);
  }
  return route;
}

/// All limits, not only those that a search often keeps.
std::unique_ptr<Problem> judged_problem(std::uint64_t seed, oracle::Draw& draw) {
  auto problem = random_problem(seed);
  Limits& limits = problem->request.limits;
  if (draw.below(2) == 0) {
    limits.max_turn_horizontal = radians(draw(20, 170));
  }
  if (draw.below(3) == 0) {
    limits.max_turn_space = radians(draw(20, 170));
  }
  if (draw.below(3) == 0) {
    limits.min_turn_radius = draw(0.1, 3);
  }
  if (draw.below(2) == 0) {
    problem->request.start.velocity = draw.point(5);
  }
  return problem;
}

using Found = std::multiset<std::pair<std::string, std::size_t>>;
Found found(const Polyline& route, const Request& request) {
  Found rules;
  for (const Violation& violation : check(route, request).violations) {
    rules.insert({violation.constraint, violation.at});
  }
  return rules;
}

void hold_to_samples(std::uint64_t from, std::uint64_t to) {
  std::map<std::string, int> broken;
  std::map<std::string, int> kept;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    oracle::Draw draw(seed + 11);
    const auto problem = judged_problem(seed, draw);
    const Polyline route = random_route(draw, problem->request);
    const Found judged = found(route, problem->request);
    const Excesses sampled = sampled_judge(route, problem->scene, problem->request);
    for (const auto& rule : judged) {
      EXPECT_TRUE(sampled.contains(rule)) << seed << ": invents " << rule.first;
    }
    for (const auto& [rule, excess] : sampled) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + rule.first + " at " +
                   std::to_string(rule.second) + ", excess " + std::to_string(excess.most));
      if (excess.most > 2e-6) {
        EXPECT_TRUE(judged.contains(rule)) << "missed";
        ++broken[rule.first];
      } else if (excess.most < -excess.unsure) {
        EXPECT_FALSE(judged.contains(rule)) << "invented";
        ++kept[rule.first];
      }
    }
  }
  for (const char* rule : {"leg_length", "climb_angle", "altitude", "ground_clearance", "clearance",
                           "turn_angle", "turn_radius", "volume", "route_length", "goal"}) {
    EXPECT_GT(broken[rule], 5) << rule;
    EXPECT_GT(kept[rule], 5) << rule;
  }
}
TEST(JudgeOracle, AgreesWithSamples) { hold_to_samples(0, 400); }
TEST(NightlyJudgeOracle, AgreesWithSamples) { hold_to_samples(1000, 11000); }

TEST(JudgeOracle, MeasuresAreThoseOfSamples) {
  int clear = 0;
  int inside = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    oracle::Draw draw(seed + 5);
    const auto problem = judged_problem(seed, draw);
    const Polyline route = random_route(draw, problem->request);
    const Measures m = measure(route, problem->request);
    SCOPED_TRACE(seed);
    double total = 0;
    double climb = 0;
    double turn = 0;
    double radius = kInfinity;
    double clearance = kInfinity;
    double gap = kInfinity;
    double longest = 0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      const Vec3 leg = route[i + 1] - route[i];
      total += leg.norm();
      longest = std::max(longest, leg.norm());
      climb = std::max(climb, std::atan2(std::abs(leg.z()), flat(leg).norm()));
      clearance =
          std::min(clearance, sampled_clearance(problem->scene, route[i], route[i + 1], kSamples));
      if (problem->scene.ground) {
        gap = std::min({gap, problem->scene.ground->above(route[i]),
                        problem->scene.ground->above(route[i + 1])});
      }
    }
    Request from_rest = problem->request;
    from_rest.start.velocity = {0, 0, 0};
    for (const auto& [i, corner] : corners(route, from_rest)) {
      turn = std::max(turn, corner.level_turn());
      radius = std::min(radius, corner.radius());
    }
    if (total == 0) {
      EXPECT_FALSE(m.duration_s || m.max_climb_deg || m.max_turn_deg);
      continue;
    }
    ASSERT_TRUE(m.duration_s && m.max_climb_deg);
    EXPECT_NEAR(m.length_m, total, 1e-9 * total);
    EXPECT_NEAR(m.duration_s.value(), total / problem->request.vehicle.speed_mps, 1e-9 * total);
    EXPECT_NEAR(m.max_climb_deg.value(), degrees(climb), 1e-5);
    EXPECT_NEAR(m.max_turn_deg.value_or(0), degrees(turn), 1e-5);
    if (std::isfinite(radius)) {
      ASSERT_TRUE(m.min_radius_m) << radius;
      EXPECT_NEAR(m.min_radius_m.value(), radius, 1e-4 * radius + 1e-6);
    }
    ASSERT_EQ(m.min_clearance_m.has_value(), clearance < kInfinity);
    if (clearance < kInfinity) {
      const double step = longest / (2 * kSamples);
      // In an obstacle the measure is within a millimetre of the depth (a ten-thousandth of it).
      const double fine = clearance < step ? 2e-3 + longest * 1e-4 : 2e-6;
      EXPECT_LE(m.min_clearance_m.value(), std::max(clearance, clearance < 0 ? -1.0 : 0.0) + fine);
      EXPECT_GE(m.min_clearance_m.value(), clearance - step - fine);
      ++(clearance < 0 ? inside : clear);
    }
    ASSERT_EQ(m.min_ground_clearance_m.has_value(), gap < kInfinity);
    EXPECT_TRUE(gap == kInfinity || std::abs(m.min_ground_clearance_m.value() - gap) < 1e-6);
  }
  EXPECT_GT(clear, 30);
  EXPECT_GT(inside, 30);
}

/// Whether a verdict on this route hangs on rounding.
bool in_doubt(const Polyline& route, const Problem& problem) {
  const Excesses sampled = sampled_judge(route, problem.scene, problem.request);
  return std::any_of(sampled.begin(), sampled.end(), [](const auto& entry) {
    return std::abs(entry.second.most) < 1e-4 && entry.second.most != 0;
  });
}

void hold_isometries(std::uint64_t from, std::uint64_t to) {
  int sound = 0;
  int broken = 0;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    oracle::Draw draw(seed + 3);
    const auto problem = judged_problem(seed, draw);
    const Polyline route = random_route(draw, problem->request);
    if (in_doubt(route, *problem)) {
      continue;
    }
    const Found plain = found(route, problem->request);
    ++(plain.empty() ? sound : broken);
    for (const auto& [name, by] : isometries(problem->scene.ground.has_value())) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + name);
      Problem other = mapped(*problem, by);
      Polyline there = mapped(route, by);
      if (problem->request.level_m) {  // on the level to the last bit, where it was
        for (std::size_t i = 0; i < route.size(); ++i) {
          if (route[i].z() == *problem->request.level_m) {
            there[i].z() = *other.request.level_m;
          }
        }
      }
      EXPECT_EQ(found(there, other.request), plain);
    }
    // Flown backward, without a heading: the same rules, as often.
    Problem back = *problem;
    back.request.start.velocity = {0, 0, 0};
    back.request.goal.tolerance_m = 1e-9;
    back.request.start.position = route.front();
    back.request.goal.position = route.back();
    const auto names = [](const Found& rules) {
      std::multiset<std::string> all;
      for (const auto& rule : rules) {
        all.insert(rule.first);
      }
      return all;
    };
    const auto forth = names(found(route, back.request));
    std::swap(back.request.start.position, back.request.goal.position);
    EXPECT_EQ(names(found(Polyline(route.rbegin(), route.rend()), back.request)), forth) << seed;
  }
  EXPECT_GT(sound, 5);
  EXPECT_GT(broken, 50);
}
TEST(JudgeSeenFromElsewhere, FindsTheSame) { hold_isometries(0, 300); }
TEST(NightlyJudgeSeenFromElsewhere, FindsTheSame) { hold_isometries(1000, 6000); }

TEST(JudgeMetamorphic, AStricterRuleFindsNoLess) {
  const struct {
    const char* name;
    std::function<void(Request&)> tighten;
  } kStricter[] = {
      {"radius", [](Request& r) { r.vehicle.radius_m += 0.2; }},
      {"clearance", [](Request& r) { r.limits.min_clearance += 0.4; }},
      {"climb", [](Request& r) { r.limits.max_climb *= 0.7; }},
      {"turn", [](Request& r) { r.limits.max_turn_horizontal *= 0.7; }},
      {"turn in space", [](Request& r) { r.limits.max_turn_space *= 0.7; }},
      {"turn radius", [](Request& r) { r.limits.min_turn_radius += 0.3; }},
      {"least leg", [](Request& r) { r.limits.min_leg += 0.5; }},
      {"longest leg", [](Request& r) { r.limits.max_leg = std::min(r.limits.max_leg, 2.0); }},
      {"length",
       [](Request& r) {
         r.limits.max_route_length *= r.limits.max_route_length < kInfinity ? 0.5 : 1;
       }},
      {"band",
       [](Request& r) {
         const double z = r.start.position.z();
         r.limits.altitude.push_back({AltitudeBand::Datum::sea, z - 1, z + 0.5});
       }},
      {"ground",
       [](Request& r) {
         auto& least = r.limits.min_ground_clearance;
         least = least.value_or(0) + 0.3;
       }},
      {"volume", [](Request& r) { r.volume = r.volume.grown(-0.2); }},
      {"tolerance", [](Request& r) { r.goal.tolerance_m *= 0.5; }},
      {"a solid more",
       [](Request& r) {
         const World one = testing::world_of({Sphere{r.goal.position, 0.5}});
         Layer layer = one.layers().front();
         layer.id = "more";
         r.world = std::make_shared<const World>(r.world->with(std::move(layer)));
       }},
  };
  std::map<std::string, int> grown;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    oracle::Draw draw(seed + 3);
    const auto problem = judged_problem(seed, draw);
    const Polyline route = random_route(draw, problem->request);
    const Found plain = found(route, problem->request);
    for (const auto& [name, tighten] : kStricter) {
      Request stricter = problem->request;
      tighten(stricter);
      const Found now = found(route, stricter);
      const std::set<Found::value_type> before(plain.begin(), plain.end());
      for (const auto& rule : before) {
        EXPECT_TRUE(now.contains(rule)) << seed << ' ' << name << " forgives " << rule.first;
      }
      grown[name] += now.size() > plain.size();
    }
  }
  for (const auto& stricter : kStricter) {
    EXPECT_GT(grown[stricter.name], 3) << stricter.name;
  }
}
}  // namespace
}  // namespace altiplan::reference::judge_oracle_test
