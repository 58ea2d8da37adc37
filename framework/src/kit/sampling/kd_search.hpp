// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstring>

#include "altiplan/kit/sampling/kd_tree.hpp"

namespace altiplan::kit::kd {

using Leaf = KdTree::Leaf;
using Branch = KdTree::Branch;

/// Four numbers, or booleans (all bits set or none), in one vector register; compilers split it for
/// CPUs whose vectors are half as wide.
using Four = double __attribute__((vector_size(32), may_alias));
using FourBits = std::int64_t __attribute__((vector_size(32)));

inline const Four& four(const double* numbers) { return *reinterpret_cast<const Four*>(numbers); }

inline void take_roots(Four& numbers) {
  for (int i = 0; i < 4; ++i) {
    numbers[i] = std::sqrt(numbers[i]);
  }
}

/// Lower bounds of a query's figure in each part of a branch, >= 0. Their last three bits are the
/// lane's number, which preserves the order except among those that differ in these bits alone.
struct Keys {
  Four half[2];

  double& operator[](int lane) { return reinterpret_cast<double*>(half)[lane]; }
};

/// Above every figure; slightly less as a limit.
inline constexpr double kBeyond = 0x1p1000;
inline constexpr double kNoLimit = 0x1p999;

inline int lane_in(double key) { return int(std::bit_cast<std::int64_t>(key) & 7); }
/// Upper bound of the keys of figures up to this one.
inline double limit_of(double figure) {
  const double maximum = figure < kNoLimit ? figure : kNoLimit;
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(maximum) | 7);
}

/// Makes keys of bounds; unused parts are beyond any limit.
inline void make_keys(std::uint32_t count, Keys& keys) {
  constexpr FourBits kLane{0, 1, 2, 3};
  for (int half = 0; half < 2; ++half) {
    const FourBits lane = kLane + 4 * half;
    Four bound = lane < std::int64_t(count) ? keys.half[half] : kBeyond + Four{};
    FourBits bits;
    std::memcpy(&bits, &bound, sizeof bits);
    bits = (bits & ~std::int64_t{7}) | lane;
    std::memcpy(&keys.half[half], &bits, sizeof bits);
  }
}

inline double min_of(const Four& numbers) {
  using Two = double __attribute__((vector_size(16)));
  const Two low = __builtin_shufflevector(numbers, numbers, 0, 1);
  const Two high = __builtin_shufflevector(numbers, numbers, 2, 3);
  const Two minimum = low < high ? low : high;
  return minimum[0] < minimum[1] ? minimum[0] : minimum[1];
}

inline double min_of(const Keys& keys) {
  const Four minimum = keys.half[0] < keys.half[1] ? keys.half[0] : keys.half[1];
  return min_of(minimum);
}

inline Box box_of(const Leaf& leaf) {
  Box box = Box::empty();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::uint32_t slot = 0; slot < leaf.count; ++slot) {
      box.min[axis] = std::min(box.min[axis], leaf.at[axis][slot]);
      box.max[axis] = std::max(box.max[axis], leaf.at[axis][slot]);
    }
  }
  return box;
}

inline Box box_of(const Branch& branch) {
  Box box = Box::empty();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::uint32_t lane = 0; lane < branch.count; ++lane) {
      box.min[axis] = std::min(box.min[axis], branch.side[axis][0][lane]);
      box.max[axis] = std::max(box.max[axis], branch.side[axis][1][lane]);
    }
  }
  return box;
}

/// Keys of the squared minimum distances to the parts. Rounding preserves the order of numbers,
/// so none of them exceeds a computed distance to a point of the part.
inline void distance_keys(const Branch& branch, const Vec3& p, Keys& keys) {
  for (int half = 0; half < 2; ++half) {
    Four square{};
    for (int axis = 0; axis < 3; ++axis) {
      const Four at = p[axis] + Four{};
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      const Four above = at > low ? at : low;
      const Four nearest = above < high ? above : high;
      square += (at - nearest) * (at - nearest);
    }
    keys.half[half] = square;
  }
  make_keys(branch.count, keys);
}

/// The square of the distance to each point of a leaf's quarter.
inline void squares(const Leaf& leaf, int quarter, const Vec3& p, Four& square) {
  const Four x = four(&leaf.at[0][4 * quarter]) - p.x();
  const Four y = four(&leaf.at[1][4 * quarter]) - p.y();
  const Four z = four(&leaf.at[2][4 * quarter]) - p.z();
  square = x * x + y * y + z * z;
}

/// The point with the smallest figure, the smallest number among equals.
struct Best {
  double minimum = kBeyond;
  std::size_t number = KdTree::kNone;

  /// Considers the points of a leaf with these figures, by quarter.
  void see(const Leaf& leaf, const Four* figures) {
    Four max_promising = kBeyond + Four{};
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Four& figure = figures[quarter];
      max_promising = figure < max_promising ? figure : max_promising;
    }
    const double here = min_of(max_promising);
    if (here > minimum) {
      return;
    }
    if (here < minimum) {
      minimum = here;
      number = KdTree::kNone;
    }
    for (std::uint32_t slot = 0; slot < Leaf::kMax; ++slot) {
      if (figures[slot / 4][slot % 4] == here && leaf.number[slot] < number) {
        number = leaf.number[slot];
      }
    }
  }
};

/// Prefetches the cache lines of a part that is likely to be visited next.
template <class Part>
inline void prefetch(const Part& part) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < 6 * kLine; at += kLine) {
    __builtin_prefetch(reinterpret_cast<const char*>(&part) + at);
  }
}

/// Most promising leaf first, so that little is left to visit on the way back. `query` has
/// keys_of(branch, keys), limit(), which keys must not exceed, and see(leaf).
template <class Query>
[[gnu::always_inline]] inline void search(const Leaf* leaves, const Branch* branches,
                                          std::uint32_t root, std::uint32_t height, Query& query) {
  constexpr int kMaxLevels = 32;
  struct Open {
    Keys keys;
    double next;  ///< the smallest of them
    const Branch* branch;
  };
  if (height == 0) {
    query.see(leaves[root]);
    return;
  }
  Open way[kMaxLevels];
  Open* here = way;
  const Open* const lowest = way + height - 1;
  for (std::uint32_t part = root;; ++here) {
    here->branch = branches + part;
    query.keys_of(*here->branch, here->keys);
    here->next = min_of(here->keys);
    for (bool is_branch = false; !is_branch;) {
      if (!(here->next <= query.limit())) {
        if (here == way) {
          return;
        }
        --here;
        continue;
      }
      const int lane = lane_in(here->next);
      here->keys[lane] = kBeyond;
      here->next = min_of(here->keys);
      part = here->branch->part[lane];
      const std::uint32_t after = here->branch->part[lane_in(here->next)];
      const bool is_likely = here->next <= query.limit();
      is_branch = here != lowest;
      if (is_likely && is_branch) {
        prefetch(branches[after]);
      } else if (is_likely) {
        prefetch(leaves[after]);
      }
      if (!is_branch) {
        query.see(leaves[part]);
      }
    }
  }
}
}  // namespace altiplan::kit::kd
