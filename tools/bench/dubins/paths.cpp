// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "altiplan/kit/dubins/wind.hpp"
#include "altiplan/random.hpp"
#include "cyclic_rows.hpp"
#include "ompl_dubins.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr double kRadius = 50;
/// At these limits nearly half of the paths between easy pairs must be longer than the shortest.
constexpr double kHeight = 2 * kRadius;
constexpr kit::AirplaneLimits kLimits{kRadius, radians(12), radians(10)};

using Pairs = std::vector<std::pair<Pose, Pose>>;

Pairs random_pairs(double edge) {
  RandomStream random(1);
  const double half = edge * kRadius / 2;
  const auto pose = [&] {
    const Vec3 position = random.in({{-half, -half, 0}, {half, half, kHeight}});
    return Pose{position, random.uniform(-kPi, kPi)};
  };
  Pairs pairs;
  while (pairs.size() < kQueries) {
    const Pose from = pose();
    pairs.emplace_back(from, pose());
  }
  return pairs;
}
}  // namespace

void add_length_rows(const PosePairs& set) {
  const auto pairs = std::make_shared<const Pairs>(random_pairs(set.edge));
  const auto ompl = std::make_shared<const OmplDubins>(kRadius, *pairs);
  const auto ours = [pairs](std::size_t n) {
    return kit::dubins_length((*pairs)[n].first, (*pairs)[n].second, kRadius);
  };
  for (std::size_t n = 0; n < kQueries; ++n) {
    if (std::abs(ours(n) - ompl->length(n)) > 1e-9 * ours(n)) {
      throw WrongAnswer("length/" + set.name + ": pair " + std::to_string(n) + " differs");
    }
  }
  add_row("length/" + set.name + "/altiplan", ours);
  add_row("length/" + set.name + "/ompl", [ompl](std::size_t n) { return ompl->length(n); });
}

void add_path_rows(const PosePairs& set) {
  const auto pairs = std::make_shared<const Pairs>(random_pairs(set.edge));
  const kit::Air air{20, {6, -8, 0}};
  add_row("path/" + set.name, [pairs](std::size_t n) {
    return kit::dubins_path((*pairs)[n].first, (*pairs)[n].second, kRadius);
  });
  add_row("airplane_length/" + set.name, [pairs](std::size_t n) {
    return kit::airplane_length((*pairs)[n].first, (*pairs)[n].second, kLimits);
  });
  add_row("airplane_path/" + set.name, [pairs](std::size_t n) {
    return kit::airplane_path((*pairs)[n].first, (*pairs)[n].second, kLimits);
  });
  add_row("wind_path/" + set.name, [pairs, air](std::size_t n) {
    return kit::wind_path((*pairs)[n].first, (*pairs)[n].second, kRadius, air);
  });
}
}  // namespace altiplan::bench
