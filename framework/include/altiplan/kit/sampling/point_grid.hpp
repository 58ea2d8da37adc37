// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::kit {

/// Points spread over a volume, as sampling planners generate them, with numbers 0, 1, 2 … in order
/// of insertion. All queries are exact. Points lie in the buckets of a grid that is rebuilt
/// whenever their number has doubled; fewer than kFewest are one bucket. (Where points cluster in
/// few places, KdTree is the better index.)
class ALTIPLAN_API PointGrid {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};
  static constexpr std::size_t kFewest = 512;

  PointGrid() { clear(); }
  void clear();
  /// Number of points inserted, including those removed since.
  std::size_t size() const { return points_.size(); }
  /// Number of points in the grid.
  std::size_t count() const { return kept_.size(); }
  const Vec3& point(std::size_t number) const { return points_[number]; }
  /// Returns the point's number.
  std::size_t insert(const Vec3& p);
  /// The point nearest to p, the smallest number among equals; kNone in an empty grid.
  std::size_t nearest(const Vec3& p) const;
  /// Numbers of the points at most `radius` away, in an order that depends on the insertions alone.
  /// `found` is emptied first.
  void within(const Vec3& p, double radius, std::vector<std::uint32_t>& found) const;
  /// Removes every point for which `leaves(number)` is true; its number is not reused.
  template <class Leaves>
  void forget_if(const Leaves& leaves) {
    std::erase_if(kept_, leaves);
    lay();
  }

 private:
  static constexpr int kWide = 8;

  /// Some points of one bucket, by axes; at infinity where there are fewer.
  struct alignas(64) Chunk {
    std::array<std::array<double, kWide>, 3> axes;
    std::array<std::uint32_t, kWide> number;
    std::uint32_t next;
  };

  std::uint32_t nearest_of_all(const Vec3& p) const;
  void lay();
  void put(std::uint32_t number);
  std::array<int, 3> bucket_of(const Vec3& p) const;
  std::size_t row_of(int j, int k) const {
    return (std::size_t(k) * std::size_t(counts_[1]) + std::size_t(j)) * std::size_t(counts_[0]);
  }
  template <class Visit>
  void visit_bucket(std::size_t bucket, const Vec3& p, const double& square,
                    const Visit& visit) const;
  template <class Visit>
  void visit_ring(const std::array<int, 3>& middle, int ring, const Visit& visit) const;

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> kept_;  ///< numbers of the points in the grid
  std::vector<Chunk> chunks_;
  std::vector<std::uint32_t> first_;  ///< chunk of each bucket, 0 where it is empty
  std::vector<std::uint8_t> filled_;  ///< points of that chunk
  Vec3 corner_{0, 0, 0};
  Vec3 edge_{kInfinity, kInfinity, kInfinity};  ///< of a bucket
  Vec3 per_edge_{0, 0, 0};                      ///< 1 / edge_
  std::array<int, 3> counts_{1, 1, 1};
  std::size_t lay_at_ = kFewest;
};
}  // namespace altiplan::kit
