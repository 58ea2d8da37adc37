// SPDX-License-Identifier: Apache-2.0
// A sphere's leg and a point's clearance among solids of all four kinds.
#include <algorithm>
#include <iostream>
#include <memory>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "reference/fcl_peer.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

// Assumed error of FCL's distances, metres: those from convex prisms are wrong by up to 0.9 mm.
constexpr double kTrusted = 1e-3;
constexpr double kRadius = 2;

struct Leg {
  Vec3 a;
  Vec3 b;
};

/// Solids at a density of 200 per square kilometre, and legs of 50 m among them.
struct City {
  double side;  // metres
  std::vector<Shape> shapes;
  std::vector<Leg> legs;

  explicit City(int count) : side(1000 * std::sqrt(count / 200.0)) {
    RandomStream random(static_cast<std::uint64_t>(count));
    for (int n = 0; n < count; ++n) {
      shapes.push_back(solid(random, n % 4));
    }
    const Box air{{0, 0, 2}, {side, side, 120}};
    while (legs.size() < kQueries) {
      const Vec3 a = random.in(air);
      const double course = random.uniform(0, 2 * kPi);
      const Vec3 b = a + Vec3(50 * std::cos(course), 50 * std::sin(course), random.uniform(-5, 5));
      legs.push_back({a, b});
    }
  }

  Shape solid(RandomStream& random, int kind) const {
    const Vec3 at = random.in({{0, 0, 0}, {side, side, 0}});
    const double size = random.uniform(5, 25);
    const double height = random.uniform(20, 100);
    switch (kind) {
      case 0:
        return Sphere{at + Vec3(0, 0, height), size};
      case 1:
        return Cylinder{at.x(), at.y(), size, 0, height};
      case 2: {
        const Vec3 half(size, random.uniform(5, 25), 0);
        return BoxShape{{at - half, at + half + Vec3(0, 0, height)}};
      }
      default: {
        Prism prism{{}, {}, 0, height};
        for (int n = 0; n < 6; ++n) {
          const double angle = (n + random.uniform(-0.2, 0.2)) * kPi / 3;
          prism.outline.push_back(
              {at.x() + size * std::cos(angle), at.y() + size * std::sin(angle)});
        }
        return prism;
      }
    }
  }
};

double min_clearance(const City& city, const Vec3& p) {
  double min_distance = kInfinity;
  for (const Shape& shape : city.shapes) {
    min_distance = std::min(min_distance, signed_distance(shape, p));
  }
  return min_distance;
}

double min_distance(const City& city, const Leg& leg) {
  double min_distance = kInfinity;
  for (const Shape& shape : city.shapes) {
    min_distance = std::min(min_distance, leg_distance(shape, leg.a, leg.b));
  }
  return min_distance;
}

bool plainly_blocked(const City& city, const Leg& leg) {
  return std::any_of(city.shapes.begin(), city.shapes.end(), [&](const Shape& shape) {
    return leg_distance(shape, leg.a, leg.b) < kRadius - kLengthTolerance;
  });
}
}  // namespace

void add_shape_rows(int count) {
  const auto city = std::make_shared<const City>(count);
  const auto set = std::make_shared<const kit::ObstacleSet>(city->shapes);
  const auto fcl = std::make_shared<const FclPeer>(city->shapes);
  const std::string of = "/" + std::to_string(count) + "_shapes/";

  const auto sweep = [=](std::size_t n) {
    return set->blocked(city->legs[n].a, city->legs[n].b, kRadius);
  };
  const auto fcl_sweep = [=](std::size_t n) {
    return fcl->blocked(city->legs[n].a, city->legs[n].b, kRadius);
  };
  const auto plain_sweep = [=](std::size_t n) { return plainly_blocked(*city, city->legs[n]); };
  require("sweep" + of + "plain", [&](std::size_t n) { return sweep(n) == plain_sweep(n); });
  require("sweep" + of + "fcl", [&](std::size_t n) {
    return sweep(n) == fcl_sweep(n) ||
           std::abs(min_distance(*city, city->legs[n]) - kRadius) < kTrusted;
  });
  std::cerr << "sweep" << of << ": " << share(sweep) << " of the legs are blocked\n";
  add_row("sweep" + of + "altiplan", sweep);
  add_row("sweep" + of + "plain", plain_sweep);
  add_row("sweep" + of + "fcl", fcl_sweep);

  const auto clear = [=](std::size_t n) { return set->clearance(city->legs[n].a); };
  const auto fcl_clear = [=](std::size_t n) { return fcl->clearance(city->legs[n].a); };
  const auto plain_clear = [=](std::size_t n) { return min_clearance(*city, city->legs[n].a); };
  require("clearance" + of + "plain", [&](std::size_t n) { return clear(n) == plain_clear(n); });
  require("clearance" + of + "fcl", [&](std::size_t n) {
    return std::abs(clear(n) - fcl_clear(n)) < kTrusted ||
           (clear(n) < kTrusted && fcl_clear(n) < kTrusted);
  });
  add_row("clearance" + of + "altiplan", clear);
  add_row("clearance" + of + "plain", plain_clear);
  add_row("clearance" + of + "fcl", fcl_clear);
}
}  // namespace altiplan::bench
