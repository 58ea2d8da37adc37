// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

namespace altiplan::octomap {

/// A leaf of the tree: a cube of `edge` finest voxels whose lower corner is `key`, counted from the
/// corner of the whole tree's cube (65,536 voxels along an axis).
struct Leaf {
  std::array<int, 3> key{0, 0, 0};
  int edge = 1;
  bool occupied = false;
};

inline constexpr int kDepth = 16;
/// The voxel whose lower corner is the origin, on each axis.
inline constexpr int kOriginKey = 1 << (kDepth - 1);

/// An OctoMap file: A. Hornung et al., OctoMap, Autonomous Robots 34(3), 2013,
/// doi:10.1007/s10514-012-9321-0. Binary trees (.bt) and full ones (.ot), with or without colours.
class Octree {
 public:
  /// Throws Error naming the file and the defect; `leaves` checks the tree's nodes.
  explicit Octree(const std::string& file);

  double resolution() const { return resolution_; }  ///< metres, edge length of a finest voxel

  /// Calls `leaf` for each known leaf; a leaf of a full tree is occupied from that probability on.
  /// Throws Error if the nodes are damaged.
  void leaves(double occupied_from, const std::function<void(const Leaf&)>& leaf) const;

 private:
  struct Walk;

  std::string file_;
  std::string bytes_;
  std::size_t data_ = 0;  ///< beginning of the nodes
  bool binary_ = false;
  std::size_t node_bytes_ = 0;  ///< for a full tree, without the mask of its children
  double resolution_ = 0;
};
}  // namespace altiplan::octomap
