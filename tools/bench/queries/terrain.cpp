// SPDX-License-Identifier: Apache-2.0
// The minimum height of legs above a terrain.
#include <cmath>
#include <iostream>
#include <memory>

#include "altiplan/height_field.hpp"
#include "altiplan/random.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr int kPosts = 1000;
constexpr double kSpacing = 25;  // metres

std::vector<float> hills(RandomStream random, float sign) {
  struct Wave {
    double east, north, phase, height;
  };
  std::vector<Wave> waves;
  for (int n = 0; n < 24; ++n) {
    const double length = 40 * std::pow(0.85, n);  // posts
    const double course = random.uniform(0, 2 * kPi);
    waves.push_back({2 * kPi * std::cos(course) / length, 2 * kPi * std::sin(course) / length,
                     random.uniform(0, 2 * kPi), 2.5 * length});
  }
  std::vector<float> heights;
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      double height = 500;
      for (const Wave& wave : waves) {
        height += wave.height * std::sin(wave.east * i + wave.north * j + wave.phase);
      }
      heights.push_back(sign * float(height));
    }
  }
  return heights;
}

Vec3 mirrored(const Vec3& p) { return {p.x(), p.y(), -p.z()}; }

struct Leg {
  Vec3 a;
  Vec3 b;
};
}  // namespace

void add_terrain_rows() {
  const std::array<double, 2> spacing{kSpacing, kSpacing};
  const RandomStream random(7);
  const auto field = std::make_shared<const HeightField>(std::array<double, 2>{0, 0}, spacing,
                                                         kPosts, kPosts, hills(random, 1));
  // The maximum height above the inverted ground skips no posts: the plain traversal.
  const auto turned = std::make_shared<const HeightField>(std::array<double, 2>{0, 0}, spacing,
                                                          kPosts, kPosts, hills(random, -1));
  for (const double length : {250.0, 2500.0, 15000.0}) {
    RandomStream draw = random.sub("legs", std::uint64_t(length));
    std::vector<Leg> drawn;
    while (drawn.size() < kQueries) {
      const double side = (kPosts - 1) * kSpacing;
      Vec3 a = draw.in({{0, 0, 0}, {side, side, 0}});
      const double course = draw.uniform(0, 2 * kPi);
      Vec3 b = a + length * Vec3(std::cos(course), std::sin(course), 0);
      const auto below_a = field->at(a.x(), a.y());
      const auto below_b = field->at(b.x(), b.y());
      if (below_a && below_b) {
        a.z() = *below_a + draw.uniform(20, 120);
        b.z() = *below_b + draw.uniform(20, 120);
        drawn.push_back({a, b});
      }
    }
    const auto legs = std::make_shared<const std::vector<Leg>>(drawn);
    const auto gap = [=](std::size_t n) { return field->gap((*legs)[n].a, (*legs)[n].b); };
    const auto enough = [=](std::size_t n) { return field->gap((*legs)[n].a, (*legs)[n].b, 20); };
    const auto plain = [=](std::size_t n) {
      return -turned->gap_max(mirrored((*legs)[n].a), mirrored((*legs)[n].b));
    };
    const std::string of = "terrain/" + std::to_string(int(length)) + "_m/";
    require(of + "plain", [&](std::size_t n) { return gap(n) == plain(n); });
    require(of + "enough", [&](std::size_t n) { return (gap(n) < 20) == (enough(n) < 20); });
    std::cerr << of << ": " << share([&](std::size_t n) { return gap(n) < 20; })
              << " of the legs come below 20 m\n";
    add_row(of + "altiplan", gap);
    add_row(of + "altiplan_20_m_are_enough", enough);
    add_row(of + "plain", plain);
  }
}
}  // namespace altiplan::bench
