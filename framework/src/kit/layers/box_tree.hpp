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

/// Eight numbers, or yes (all bits) and no, that one vector operation takes at once; compilers make
/// two of it for CPUs whose vectors are half as wide.
using Lanes = float __attribute__((vector_size(32)));
using LaneBits = std::int32_t __attribute__((vector_size(32)));

/// A node of a tree sixteen wide: up to sixteen boxes side by side, in two halves. Their sides are
/// floats, rounded outwards by more than a distance in doubles may err.
struct alignas(64) BoxNode {
  static constexpr int kWidth = 16;
  Lanes side[3][2][2];       ///< by axis, the lower and the upper one, by half
  std::int32_t box[kWidth];  ///< of a leaf: the boxes' indices
  std::int32_t first;        ///< else of its first child, the others follow; -1 of a leaf
  std::uint32_t lanes;       ///< a bit for each lane in use; the others' boxes are nowhere

  bool is_leaf() const { return first < 0; }
};
static_assert(sizeof(BoxNode) == 512);

/// Boxes halved at the median of their middles along the longer side, as few parts a node as keep
/// the nodes below it full. The root is node 0; no boxes, no nodes.
std::vector<BoxNode> box_tree(const std::vector<Box>& boxes);
std::vector<BoxNode> box_tree(const CellBoxes& boxes);

/// Levels of a tree of 2^31 boxes, and the nodes of it that can wait at once while it is walked.
inline constexpr int kMaxLevels = 10;
inline constexpr int kMaxOpen = 15 * kMaxLevels + 1;

/// Coordinates up to here may be asked for by the tests below; sides beyond it are endless.
inline constexpr double kTreeReach = 1e15;

/// Floats that are not above, and not below, a value of at most kTreeReach.
inline float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest - (std::abs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
}
inline float rounded_up(double value) { return -rounded_down(-value); }

/// Of the greatest coordinate: what boxes and legs are grown by, far more than distances in doubles
/// may err there, and than a float may.
inline constexpr double kTreeGrowth = 0x1p-21;

/// A leg a–b that reaches somewhat farther than `reach` to all sides.
struct TreeLeg {
  float from[3][2];  ///< the farthest that a reaches up and down
  float inverse[3];  ///< of the way from a to b
  int first[3];      ///< the side of a box that is met first

  TreeLeg(const Vec3& a, const Vec3& b, double reach) {
    constexpr double kNoWay = 1e-30;  // what is beyond a side then stays beyond it at any time
    const double most = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    const double grown = reach + kTreeGrowth * most;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis][0] = rounded_up(a[axis] + grown);
      from[axis][1] = rounded_down(a[axis] - grown);
      const double way = b[axis] - a[axis];
      inverse[axis] = static_cast<float>(1 / (std::abs(way) > kNoWay ? way : kNoWay));
      first[axis] = inverse[axis] < 0 ? 1 : 0;
    }
  }
};

/// A bit for each lane that says yes.
inline std::uint32_t bits_of(const LaneBits& low, const LaneBits& high) {
  constexpr LaneBits kBits{1, 2, 4, 8, 16, 32, 64, 128};
  const LaneBits bits = (low & kBits) | (high & kBits << 8);
  auto four = __builtin_shufflevector(bits, bits, 0, 1, 2, 3) |
              __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  four |= __builtin_shufflevector(four, four, 2, 3, 0, 1);
  four |= __builtin_shufflevector(four, four, 1, 0, 3, 2);
  return static_cast<std::uint32_t>(four[0]);
}

/// A distance as a key: its square as a float, read as a whole number, which keeps the order. The
/// keys of lanes have the lane in their last four bits.
inline std::int32_t key_of(double distance) {
  constexpr double kRounding = 1 + 0x1p-17;  // more than the keys of lanes are too great
  constexpr double kMax = std::numeric_limits<float>::max();
  const double outside = std::max(distance, 0.0);
  return std::bit_cast<std::int32_t>(float(std::min(outside * outside * kRounding, kMax))) | 15;
}

/// Keys of the least distance from the point to each box.
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

/// The lanes whose keys are at most `limit`, a bit each.
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
  auto least = low < high ? low : high;
  auto other = __builtin_shufflevector(least, least, 2, 3, 0, 1);
  least = other < least ? other : least;
  other = __builtin_shufflevector(least, least, 1, 0, 3, 2);
  least = other < least ? other : least;
  return least[0];
}

/// The lanes whose boxes the leg may reach, a bit each: where it is between the sides on all axes
/// at once.
inline std::uint32_t lanes_reached(const BoxNode& node, const TreeLeg& leg) {
  constexpr float kRounding = 0x1p-20F;  // more than a time loses to rounding
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
