// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "../../multiversion.hpp"

namespace altiplan::kit {
namespace {

constexpr double kPerBucket = 6;  ///< mean number of points at a rebuild

// Four at a time: the compiler maps them to the vectors of the CPU.
using Wide = double __attribute__((vector_size(32)));
using WideMask = std::int64_t __attribute__((vector_size(32)));

constexpr int kLanes = 4;

/// Squared distances of four of a chunk's points from p.
template <class Chunk>
[[gnu::always_inline]] inline void squares_of(const Chunk& chunk, int first, const Vec3& p,
                                              Wide& squares) {
  squares = Wide{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Wide off;
    std::memcpy(&off, chunk.axes[axis].data() + first, sizeof off);
    off -= p[int(axis)];
    squares += off * off;
  }
}
}  // namespace

void PointGrid::clear() {
  points_.clear();
  kept_.clear();
  lay();
}

std::size_t PointGrid::insert(const Vec3& p) {
  const auto number = std::uint32_t(points_.size());
  points_.push_back(p);
  kept_.push_back(number);
  if (kept_.size() >= lay_at_) {
    lay();
  } else {
    put(number);
  }
  return number;
}

/// Rebuilds the grid over the current points; later points outside it belong to the nearest bucket.
void PointGrid::lay() {
  chunks_.resize(1);  // number 0 means none
  counts_ = {1, 1, 1};
  per_edge_.setZero();
  edge_.setConstant(kInfinity);
  lay_at_ = std::max(kFewest, 2 * kept_.size());
  Box box = Box::empty();
  for (const std::uint32_t number : kept_) {
    box = box.with(points_[number]);
  }
  corner_ = kept_.empty() ? Vec3::Zero() : box.min;
  if (kept_.size() >= kFewest) {
    const Vec3 extent = box.max - box.min;
    double spread = 1;
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (extent[axis] > 1e-3 * extent.maxCoeff()) {
        spread *= extent[axis];
        ++axes;
      }
    }
    const double cube =
        axes == 0 ? 1.0 : std::pow(spread * kPerBucket / double(kept_.size()), 1.0 / axes);
    for (int axis = 0; axis < 3; ++axis) {
      const int count = int(std::clamp(extent[axis] / cube, 1.0, double(kept_.size())));
      if (count > 1) {
        counts_[std::size_t(axis)] = count;
        edge_[axis] = extent[axis] / count;
        per_edge_[axis] = count / extent[axis];
      }
    }
  }
  const std::size_t buckets =
      std::size_t(counts_[0]) * std::size_t(counts_[1]) * std::size_t(counts_[2]);
  first_.assign(buckets, 0);
  filled_.assign(buckets, 0);
  for (const std::uint32_t number : kept_) {
    put(number);
  }
}

void PointGrid::put(std::uint32_t number) {
  const Vec3& p = points_[number];
  std::size_t bucket = 0;
  if (first_.size() > 1) {
    const std::array<int, 3> at = bucket_of(p);
    bucket = row_of(at[1], at[2]) + std::size_t(at[0]);
  }
  if (first_[bucket] == 0 || filled_[bucket] == kWide) {
    Chunk& empty = chunks_.emplace_back();
    for (auto& axis : empty.axes) {
      axis.fill(kInfinity);
    }
    empty.number.fill(0);
    empty.next = first_[bucket];
    first_[bucket] = std::uint32_t(chunks_.size() - 1);
    filled_[bucket] = 0;
  }
  Chunk& chunk = chunks_[first_[bucket]];
  const std::size_t place = filled_[bucket]++;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    chunk.axes[axis][place] = p[int(axis)];
  }
  chunk.number[place] = number;
}

std::array<int, 3> PointGrid::bucket_of(const Vec3& p) const {
  std::array<int, 3> at{};
  for (int axis = 0; axis < 3; ++axis) {
    const int count = counts_[std::size_t(axis)];
    at[std::size_t(axis)] =
        int(std::clamp((p[axis] - corner_[axis]) * per_edge_[axis], 0.0, count - 1.0));
  }
  return at;
}

/// Calls visit(number, squared distance) for the points of the bucket whose squared distance is at
/// most `square`, which a visit may reduce.
template <class Visit>
[[gnu::always_inline]] inline void PointGrid::visit_bucket(std::size_t bucket, const Vec3& p,
                                                           const double& square,
                                                           const Visit& visit) const {
  for (std::uint32_t c = first_[bucket]; c != 0; c = chunks_[c].next) {
    const Chunk& chunk = chunks_[c];
    for (int first = 0; first < kWide; first += kLanes) {
      Wide squares;
      squares_of(chunk, first, p, squares);
      const WideMask near = squares <= square;
      if ((near[0] | near[1] | near[2] | near[3]) == 0) {
        continue;
      }
      for (int lane = 0; lane < kLanes; ++lane) {
        if (near[lane] != 0) {
          visit(chunk.number[std::size_t(first + lane)], squares[lane]);
        }
      }
    }
  }
}

/// Calls visit(bucket) for the buckets whose index differs by `ring` on an axis, and by at most
/// that on the others.
template <class Visit>
void PointGrid::visit_ring(const std::array<int, 3>& middle, int ring, const Visit& visit) const {
  std::array<int, 3> low{};
  std::array<int, 3> high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(0, middle[axis] - ring);
    high[axis] = std::min(counts_[axis] - 1, middle[axis] + ring);
  }
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      const std::size_t row = row_of(j, k);
      if (std::abs(k - middle[2]) == ring || std::abs(j - middle[1]) == ring) {
        for (int i = low[0]; i <= high[0]; ++i) {
          visit(row + std::size_t(i));
        }
        continue;
      }
      if (middle[0] - ring >= 0) {
        visit(row + std::size_t(middle[0] - ring));
      }
      if (middle[0] + ring < counts_[0]) {
        visit(row + std::size_t(middle[0] + ring));
      }
    }
  }
}

/// Among at most kFewest points, all in one bucket, in chunks in the order of their numbers.
ALTIPLAN_CLONES std::uint32_t PointGrid::nearest_of_all(const Vec3& p) const {
  constexpr int kParts = kWide / kLanes;
  Wide minimum[kParts];
  WideMask which[kParts];
  for (int part = 0; part < kParts; ++part) {
    minimum[part] = Wide{} + kInfinity;
    which[part] = WideMask{};
  }
  for (std::size_t c = 1; c < chunks_.size(); ++c) {
    for (int part = 0; part < kParts; ++part) {
      Wide squares;
      squares_of(chunks_[c], part * kLanes, p, squares);
      const WideMask nearer = squares < minimum[part];
      minimum[part] = nearer ? squares : minimum[part];
      which[part] = nearer ? WideMask{} + std::int64_t(c) : which[part];
    }
  }
  double square = kInfinity;
  for (int place = 0; place < kWide; ++place) {
    square = std::min(square, minimum[place / kLanes][place % kLanes]);
  }
  std::int64_t best = std::int64_t(kept_.size());  // index in the list: numbers ascend there
  for (int place = 0; place < kWide; ++place) {
    const int part = place / kLanes;
    const int lane = place % kLanes;
    const std::int64_t at = (which[part][lane] - 1) * kWide + place;
    best = minimum[part][lane] <= square && at < best ? at : best;
  }
  return kept_[std::size_t(best)];
}

std::size_t PointGrid::nearest(const Vec3& p) const {
  if (kept_.empty()) {
    return kNone;
  }
  if (first_.size() == 1) {
    return nearest_of_all(p);
  }
  std::size_t best = kNone;
  double minimum = kInfinity;
  const std::array<int, 3> middle = bucket_of(p);
  const int rings = *std::max_element(counts_.begin(), counts_.end());
  for (int ring = 0; ring < rings; ++ring) {
    // Minimum distance of the buckets of this ring: whole edges lie between.
    const double gap = std::max(0, ring - 1) * edge_.minCoeff() * (1 - 1e-9);
    if (gap * gap > minimum) {
      break;
    }
    visit_ring(middle, ring, [&](std::size_t bucket) {
      visit_bucket(bucket, p, minimum, [&](std::uint32_t number, double square) {
        if (square < minimum || (square <= minimum && number < best)) {
          minimum = square;
          best = number;
        }
      });
    });
  }
  return best;
}

ALTIPLAN_CLONES
void PointGrid::within(const Vec3& p, double radius, std::vector<std::uint32_t>& found) const {
  found.clear();
  const double square = radius * radius;
  const Vec3 reach = Vec3::Constant(radius * (1 + 1e-9));
  const std::array<int, 3> low = bucket_of(p - reach);
  const std::array<int, 3> high = bucket_of(p + reach);
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        visit_bucket(row_of(j, k) + std::size_t(i), p, square,
                     [&](std::uint32_t number, double) { found.push_back(number); });
      }
    }
  }
}
}  // namespace altiplan::kit
