// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/random.hpp"

namespace altiplan::rrt_connect {

/// A free point between two blocked ones.
struct Bridge {
  static constexpr std::size_t kMagnitudes = 7;

  Vec3 middle;
  std::size_t magnitude = 0;  ///< of its length, in powers of 1/2 of the longest
};

/// A direction in a box, which may be flat; every other one along an axis, as most walls are: a
/// bridge along a thin wall does not leave it.
inline Vec3 direction_in(const Box& box, RandomStream& random) {
  Vec3 along{random.normal(), random.normal(), random.normal()};
  if (random.uniform() < 0.5) {
    const auto axis = Eigen::Index(random.integer(0, 2));
    along = Vec3::Unit(axis) * along[axis];
  }
  along = ((box.max - box.min).array() > 0).select(along, 0);
  return along.stableNormalized();
}

/// Bridges up to `longest` metres in a box, of which few lie outside narrow passages: `tries`
/// points are looked at. D. Hsu, T. Jiang, J. Reif, Z. Sun: The Bridge Test for Sampling Narrow
/// Passages with Probabilistic Roadmap Planners. IEEE ICRA 2003, doi:10.1109/ROBOT.2003.1242285.
/// Nothing in clutter, where one point in a hundred finds a bridge: any sample lies in a passage.
inline std::optional<std::vector<Bridge>> find_bridges(const Box& box, double longest, int tries,
                                                       const kit::LegRules& rules,
                                                       RandomStream random) {
  constexpr std::size_t kEnough = 16;
  constexpr int kClutter = 100;
  std::vector<Bridge> found;
  for (int n = 0; n < tries; ++n) {
    const Vec3 end = random.in(box);
    if (rules.point_ok(end)) {
      continue;
    }
    const double magnitude = double(Bridge::kMagnitudes) * random.uniform();
    const Vec3 half = direction_in(box, random) * (longest / 2 * std::exp2(-magnitude));
    if (box.contains(end + 2 * half) && rules.point_ok(end + half) &&
        !rules.point_ok(end + 2 * half)) {
      found.push_back({end + half, std::size_t(magnitude)});
      if (found.size() >= kEnough && int(found.size()) * kClutter > n) {
        return std::nullopt;
      }
    }
  }
  return found;
}

/// The passages that a tree has not reached. Each magnitude is sampled alike: wide passages have
/// more bridges than narrow ones, and need them less.
class Passages {
 public:
  void add(const std::vector<Bridge>& bridges) {
    for (const Bridge& bridge : bridges) {
      if (middles_[bridge.magnitude].size() < kEnough) {
        middles_[bridge.magnitude].push_back(bridge.middle);
      }
    }
  }
  bool empty() const {
    return std::all_of(middles_.begin(), middles_.end(), [](const auto& m) { return m.empty(); });
  }
  const Vec3& sample(RandomStream& random) {
    do {
      magnitude_ = any(middles_.size(), random);
    } while (middles_[magnitude_].empty());
    index_ = any(middles_[magnitude_].size(), random);
    return middles_[magnitude_][index_];
  }
  /// Removes the last sample.
  void remove() {
    middles_[magnitude_][index_] = middles_[magnitude_].back();
    middles_[magnitude_].pop_back();
  }
  static std::size_t any(std::size_t count, RandomStream& random) {
    return std::size_t(random.integer(0, std::int64_t(count) - 1));
  }

 private:
  static constexpr std::size_t kEnough = 200;  ///< of a magnitude

  std::array<std::vector<Vec3>, Bridge::kMagnitudes> middles_;
  std::size_t magnitude_ = 0;  ///< of the last sample
  std::size_t index_ = 0;
};
}  // namespace altiplan::rrt_connect
