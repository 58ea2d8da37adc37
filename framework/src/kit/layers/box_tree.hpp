// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "altiplan/geometry.hpp"

#include "cell_boxes.hpp"

namespace altiplan::kit {

/// Eight numbers, or booleans (all bits set or none), in one vector register; compilers split it
/// for CPUs whose vectors are half as wide.
using Lanes = float __attribute__((vector_size(32)));
using LaneBits = std::int32_t __attribute__((vector_size(32)));

/// A node of a 16-ary tree: up to sixteen boxes side by side, in two halves. Their sides are
/// floats, rounded outwards by more than the error of a distance in doubles.
struct alignas(64) BoxNode {
  static constexpr int kWidth = 16;
  Lanes side[3][2][2];       ///< by axis, the lower and the upper one, by half
  std::int32_t box[kWidth];  ///< of a leaf: the boxes' indices
  std::int32_t first;        ///< of an inner node: its first child, followed by the others; -1 for
                             ///< a leaf
  std::uint32_t lanes;       ///< one bit per lane in use; the boxes of other lanes are empty

  bool is_leaf() const { return first < 0; }
};
static_assert(sizeof(BoxNode) == 512);

/// Boxes split at the median of their centres along the longer side, into as few parts per node as
/// keep the nodes below it full. The root is node 0; no boxes, no nodes.
std::vector<BoxNode> box_tree(const std::vector<Box>& boxes);
std::vector<BoxNode> box_tree(const CellBoxes& boxes);

/// Levels of a tree of 2^31 boxes, and the maximum number of pending nodes of a traversal.
inline constexpr int kMaxLevels = 10;
inline constexpr int kMaxOpen = 15 * kMaxLevels + 1;

/// Maximum coordinate of a query by the tests below; sides beyond it count as infinite.
inline constexpr double kTreeReach = 1e15;

/// The largest float not above, and the smallest not below, a value of at most kTreeReach.
inline float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest - (std::abs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
inline float rounded_up(double value) { return -rounded_down(-value); }

/// Relative to the largest coordinate: boxes and legs are grown by this, far more than the error of
/// distances in doubles, and than that of a float.
inline constexpr double kTreeGrowth = 0x1p-21;

/// A leg a–b, grown by slightly more than `reach` on all sides.
struct TreeLeg {
  float from[3][2];  ///< the farthest that a reaches up and down
  float inverse[3];  ///< of the displacement from a to b
  int first[3];      ///< the side of a box that is met first

  TreeLeg(const Vec3& a, const Vec3& b, double reach) {
    constexpr double kNoWay = 1e-30;  // keeps anything beyond a side beyond it at any time
    const double maximum = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    const double grown = reach + kTreeGrowth * maximum;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis][0] = rounded_up(a[axis] + grown);
      from[axis][1] = rounded_down(a[axis] - grown);
      const double way = b[axis] - a[axis];
      inverse[axis] = static_cast<float>(1 / (std::abs(way) > kNoWay ? way : kNoWay));
      first[axis] = inverse[axis] < 0 ? 1 : 0;
    }
  }
};

/// One bit for each lane that is true.
inline std::uint32_t bits_of(const LaneBits& low, const LaneBits& high) {
  constexpr LaneBits kBits{1, 2, 4, 8, 16, 32, 64, 128};
  const LaneBits bits = (low & kBits) | (high & kBits << 8);
  auto four = __builtin_shufflevector(bits, bits, 0, 1, 2, 3) |
              __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  four |= __builtin_shufflevector(four, four, 2, 3, 0, 1);
  four |= __builtin_shufflevector(four, four, 1, 0, 3, 2);
  return static_cast<std::uint32_t>(four[0]);
}

/// A distance as a key: its square as a float, reinterpreted as an integer, which preserves the
/// order. The keys of lanes have the lane in their last four bits.
inline std::int32_t key_of(double distance) {
  constexpr double kRounding = 1 + 0x1p-17;  // covers the excess of the lanes' keys
  constexpr double kMax = std::numeric_limits<float>::max();
  const double outside = std::max(distance, 0.0);
  return std::bit_cast<std::int32_t>(float(std::min(outside * outside * kRounding, kMax))) | 15;
}

/// Keys of the minimum distance from the point to each box.
struct Keys {
  LaneBits half[2];
};

inline void keys_of(const BoxNode& node, const float* p, Keys& keys) {
  constexpr LaneBits kLane{0, 1, 2, 3, 4, 5, 6, 7};
  for (int half = 0; half < 2; ++half) {
    Lanes square{};
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes at = p[axis] + Lanes{};
      const Lanes& low = node.side[axis][0][half];
      const Lanes& high = node.side[axis][1][half];
      const Lanes above = at > low ? at : low;
      const Lanes nearest = above < high ? above : high;
      square += (at - nearest) * (at - nearest);
    }
    std::memcpy(&keys.half[half], &square, sizeof square);
    keys.half[half] = (keys.half[half] & ~15) | (kLane + 8 * half);
  }
}

/// The lanes whose keys are at most `limit`, one bit each.
inline std::uint32_t lanes_within(const Keys& keys, std::int32_t limit) {
  const LaneBits low = keys.half[0] <= limit + LaneBits{};
  const LaneBits high = keys.half[1] <= limit + LaneBits{};
  return bits_of(low, high);
}

/// The least key.
inline std::int32_t min_of(const Keys& keys) {
  const LaneBits eight = keys.half[0] < keys.half[1] ? keys.half[0] : keys.half[1];
  const auto low = __builtin_shufflevector(eight, eight, 0, 1, 2, 3);
  const auto high = __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
  auto minimum = low < high ? low : high;
  auto other = __builtin_shufflevector(minimum, minimum, 2, 3, 0, 1);
  minimum = other < minimum ? other : minimum;
  other = __builtin_shufflevector(minimum, minimum, 1, 0, 3, 2);
  minimum = other < minimum ? other : minimum;
  return minimum[0];
}

/// The lanes whose boxes the leg may reach, one bit each: where it is between the sides on all axes
/// at once.
inline std::uint32_t lanes_reached(const BoxNode& node, const TreeLeg& leg) {
  constexpr float kRounding = 0x1p-20F;  // exceeds the rounding error of a time
  LaneBits reached[2];
  for (int half = 0; half < 2; ++half) {
    Lanes enter{};
    Lanes leave = enter + 1.0F;
    for (int axis = 0; axis < 3; ++axis) {
      const int first = leg.first[axis];
      const int last = 1 - first;
      const Lanes in = (node.side[axis][first][half] - leg.from[axis][first]) * leg.inverse[axis];
      const Lanes out = (node.side[axis][last][half] - leg.from[axis][last]) * leg.inverse[axis];
      enter = in > enter ? in : enter;
      leave = out < leave ? out : leave;
    }
    reached[half] = enter * (1 - kRounding) <= leave * (1 + kRounding);
  }
  return bits_of(reached[0], reached[1]) & node.lanes;
}
}  // namespace altiplan::kit
