// SPDX-License-Identifier: Apache-2.0
#include "host/gate/flown_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace altiplan::host {
namespace {

constexpr double kFinest = 16;

/// What a judge saw of a part, that finds places above a bad point not valid.
struct Seen {
  std::vector<Whereabouts> valid;
  std::vector<Whereabouts> refused;
  std::size_t count = 0;
};

bool holds(const Whereabouts& place, const Vec3& point) {
  constexpr double kRounding = 1e-6;
  return (point.head<2>() - place.at).norm() <= place.radius_m + kRounding &&
         point.z() >= place.low_m - kRounding && point.z() <= place.high_m + kRounding;
}

bool any_holds(const std::vector<Whereabouts>& places, const Vec3& point) {
  return std::any_of(places.begin(), places.end(),
                     [&](const Whereabouts& place) { return holds(place, point); });
}

Seen judge(const FlownPart& part, const Vec3& bad) {
  Seen seen;
  FlownPlaces(part, {0, 60}, 0, part.strips.back().to.head<2>())
      .judge(
          kFinest,
          [&](const Whereabouts& place) {
            ++seen.count;
            if (holds(place, bad)) {
              return false;
            }
            seen.valid.push_back(place);
            return true;
          },
          [&](const Whereabouts& place) { seen.refused.push_back(place); });
  return seen;
}

Strip random_strip(std::mt19937& random) {
  std::uniform_real_distribution<double> across(-400, 400);
  std::uniform_real_distribution<double> up(0, 60);
  Strip strip;
  strip.from = {across(random), across(random), up(random)};
  strip.to = {across(random), across(random), up(random)};
  if (random() % 4 == 0) {  // straight up, or along an axis
    strip.to.x() = strip.from.x();
    strip.to.y() = random() % 2 == 0 ? strip.from.y() : strip.to.y();
  }
  strip.from_high_m = strip.from.z() + up(random);
  strip.to_high_m = strip.to.z() + up(random);
  strip.reach_m = std::array{0.0, 3.0, 40.0, 90.0}[random() % 4];
  return strip;
}

/// Anywhere that a strip has the vehicle be.
Vec3 point_of(const Strip& strip, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double share = unit(random);
  const double turn = unit(random) * 2 * M_PI;
  const double off = strip.reach_m * std::sqrt(unit(random));
  Vec3 point = strip.from + share * (strip.to - strip.from);
  point.z() += unit(random) * ((1 - share) * (strip.from_high_m - strip.from.z()) +
                               share * (strip.to_high_m - strip.to.z()));
  return point + off * Vec3(std::cos(turn), std::sin(turn), 0);
}

TEST(FlownPlaces, EachPointIsInAPlaceThatIsJudged) {
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    FlownPart part;
    for (std::size_t n = 0; n < 1 + random() % 6; ++n) {
      part.strips.push_back(random_strip(random));
    }
    const Vec3 bad = point_of(part.strips[random() % part.strips.size()], random);
    const Seen seen = judge(part, bad);
    EXPECT_TRUE(any_holds(seen.refused, bad)) << run;
    for (int n = 0; n < 100; ++n) {
      const Vec3 point = point_of(part.strips[random() % part.strips.size()], random);
      EXPECT_TRUE(any_holds(seen.valid, point) || any_holds(seen.refused, point)) << run;
    }
  }
}

TEST(FlownPlaces, WhatIsFarFromWhereItFailsIsValid) {
  std::mt19937 random(2);
  for (int run = 0; run < 200; ++run) {
    FlownPart part;
    part.strips.push_back(random_strip(random));
    const Vec3 bad = point_of(part.strips.front(), random);
    for (const Whereabouts& refused : judge(part, bad).refused) {
      EXPECT_TRUE(holds(refused, bad)) << run;
      EXPECT_LE(refused.radius_m, kFinest / 2 + part.strips.front().reach_m + 1e-9) << run;
    }
  }
}

TEST(FlownPlaces, StripsThatOverlapAreJudgedOnce) {
  FlownPart one;
  one.strips.push_back({{0, 0, 10}, {900, 500, 20}, 30, 40, 25});
  FlownPart many = one;
  for (int n = 1; n < 40; ++n) {
    many.strips.push_back({{0.1 * n, 0, 10}, {900, 500 - 0.1 * n, 20}, 30, 40, 25});
  }
  const Vec3 bad(450, 250, 20);
  EXPECT_LE(judge(many, bad).count, 2 * judge(one, bad).count);
}

}  // namespace
}  // namespace altiplan::host
