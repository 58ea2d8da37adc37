// SPDX-License-Identifier: Apache-2.0
// Queries of KdTree.
#include <algorithm>
#include <utility>
#include <vector>

#include "../../multiversion.hpp"
#include "kd_search.hpp"

namespace altiplan::kit {
namespace {

using namespace kd;

struct Nearest {
  const Vec3& p;
  Best best{};
  double limit() const { return limit_of(best.minimum); }
  void keys_of(const Branch& branch, Keys& keys) const { distance_keys(branch, p, keys); }
  void see(const Leaf& leaf) {
    Four square[4];
    for (int quarter = 0; quarter < 4; ++quarter) {
      squares(leaf, quarter, p, square[quarter]);
    }
    best.see(leaf, square);
  }
};

ALTIPLAN_CLONES void find_nearest(const Leaf* leaves, const Branch* branches, std::uint32_t root,
                                  std::uint32_t height, Nearest& query) {
  search(leaves, branches, root, height, query);
}

// F(x) = p_weight |x − p| + q_weight |x − q| is convex: over a box it is at least its tangent at
// any c of the box, that is F(c) and, for each axis, the smaller product of the gradient and the
// distances from c to both sides. The bound is the tighter the nearer c is to the minimum of F in
// the box, which is about where the box is nearest to the segment p–q. Rounding errs by less than
// `slack`, 450 times the double precision of the sum: each part of it by less than 30 times.
struct LeastSum {
  const Vec3& p;
  double p_weight;
  const Vec3& q;
  double q_weight;
  Vec3 way = q - p;
  double inverse = 1 / std::max(way.squaredNorm(), 1e-200);
  double slack = 0;
  Best best{};

  double limit() const { return limit_of(best.minimum + slack); }

  void keys_of(const Branch& branch, Keys& keys) const {
    for (int half = 0; half < 2; ++half) {
      bound(branch, half, keys.half[half]);
    }
    make_keys(branch.count, keys);
  }

  void bound(const Branch& branch, int half, Four& minimum) const {
    Four t{};
    for (int axis = 0; axis < 3; ++axis) {
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      t += (0.5 * (low + high) - p[axis]) * way[axis];
    }
    t *= inverse;
    t = t > 0.0 ? t : Four{};
    t = t < 1.0 ? t : 1.0 + Four{};
    Four c[3];
    Four p_distance{};
    Four q_distance{};
    for (int axis = 0; axis < 3; ++axis) {
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      const Four at = p[axis] + t * way[axis];
      const Four above = at > low ? at : low;
      c[axis] = above < high ? above : high;
      p_distance += (c[axis] - p[axis]) * (c[axis] - p[axis]);
      q_distance += (c[axis] - q[axis]) * (c[axis] - q[axis]);
    }
    take_roots(p_distance);
    take_roots(q_distance);
    constexpr double kNoDistance = 1e-100;
    const Four p_pull = p_weight / (p_distance > kNoDistance ? p_distance : kNoDistance + Four{});
    const Four q_pull = q_weight / (q_distance > kNoDistance ? q_distance : kNoDistance + Four{});
    minimum = p_weight * p_distance + q_weight * q_distance;
    for (int axis = 0; axis < 3; ++axis) {
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      const Four gradient = p_pull * (c[axis] - p[axis]) + q_pull * (c[axis] - q[axis]);
      const Four down = gradient * (low - c[axis]);
      const Four up = gradient * (high - c[axis]);
      minimum += down < up ? down : up;
    }
    minimum = minimum > 0.0 ? minimum : Four{};
  }

  void see(const Leaf& leaf) {
    Four sum[4];
    for (int quarter = 0; quarter < 4; ++quarter) {
      Four p_distance;
      Four q_distance;
      squares(leaf, quarter, p, p_distance);
      squares(leaf, quarter, q, q_distance);
      take_roots(p_distance);
      take_roots(q_distance);
      sum[quarter] = p_weight * p_distance + q_weight * q_distance;
    }
    best.see(leaf, sum);
  }
};

ALTIPLAN_CLONES void find_min_sum(const Leaf* leaves, const Branch* branches, std::uint32_t root,
                                  std::uint32_t height, LeastSum& query) {
  search(leaves, branches, root, height, query);
}

struct WithinBall {
  const Vec3& p;
  double square;
  std::vector<std::size_t>& found;
  double limit() const { return limit_of(square); }
  void keys_of(const Branch& branch, Keys& keys) const { distance_keys(branch, p, keys); }
  void see(const Leaf& leaf) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      Four here;
      squares(leaf, quarter, p, here);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t slot = 4 * std::uint32_t(quarter) + i;
        if (here[i] <= square && slot < leaf.count) {
          found.push_back(leaf.number[slot]);
        }
      }
    }
  }
};

struct NearestOnes {
  using Point = std::pair<double, std::size_t>;  ///< squared distance, number
  const Vec3& p;
  std::size_t count;
  std::vector<Point> farthest_first{};  ///< a heap
  double limit() const {
    return limit_of(farthest_first.size() < count ? kInfinity : farthest_first.front().first);
  }
  void keys_of(const Branch& branch, Keys& keys) const { distance_keys(branch, p, keys); }
  void see(const Leaf& leaf) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      Four square;
      squares(leaf, quarter, p, square);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t slot = 4 * std::uint32_t(quarter) + i;
        if (slot < leaf.count) {
          add({double(square[i]), leaf.number[slot]});
        }
      }
    }
  }
  void add(const Point& point) {
    if (farthest_first.size() == count) {
      if (!(point < farthest_first.front())) {
        return;
      }
      std::pop_heap(farthest_first.begin(), farthest_first.end());
      farthest_first.pop_back();
    }
    farthest_first.push_back(point);
    std::push_heap(farthest_first.begin(), farthest_first.end());
  }
};

struct WithinBox {
  const Box& box;
  std::vector<std::size_t>& found;
  double limit() const { return limit_of(0); }
  void keys_of(const Branch& branch, Keys& keys) const {
    for (int half = 0; half < 2; ++half) {
      Four outside{};
      for (int axis = 0; axis < 3; ++axis) {
        const Four& low = four(&branch.side[axis][0][4 * half]);
        const Four& high = four(&branch.side[axis][1][4 * half]);
        outside = low > box.max[axis] || high < box.min[axis] ? 1.0 + Four{} : outside;
      }
      keys.half[half] = outside;
    }
    make_keys(branch.count, keys);
  }
  void see(const Leaf& leaf) {
    for (std::uint32_t slot = 0; slot < leaf.count; ++slot) {
      if (box.contains({leaf.at[0][slot], leaf.at[1][slot], leaf.at[2][slot]})) {
        found.push_back(leaf.number[slot]);
      }
    }
  }
};
}  // namespace

std::size_t KdTree::nearest(const Vec3& p) const {
  if (root_ == kOut) {
    return kNone;
  }
  Nearest query{p};
  find_nearest(leaves_.data(), branches_.data(), root_, height_, query);
  return query.best.number;
}

void KdTree::nearest(const Vec3& p, std::size_t count, std::vector<std::size_t>& found) const {
  found.clear();
  if (root_ == kOut || count == 0) {
    return;
  }
  NearestOnes query{p, count};
  search(leaves_.data(), branches_.data(), root_, height_, query);
  std::sort_heap(query.farthest_first.begin(), query.farthest_first.end());
  for (const auto& [square, number] : query.farthest_first) {
    found.push_back(number);
  }
}

std::size_t KdTree::min_sum(const Vec3& p, double p_weight, const Vec3& q, double q_weight) const {
  if (root_ == kOut) {
    return kNone;
  }
  LeastSum query{p, p_weight, q, q_weight};
  if (height_ > 0) {
    const Box all = box_of(branches_[root_]);
    const double farthest =
        (all.max - all.min).sum() + (p - all.min).cwiseAbs().sum() + (q - all.min).cwiseAbs().sum();
    query.slack = 1e-13 * (p_weight + q_weight) * farthest;
  }
  find_min_sum(leaves_.data(), branches_.data(), root_, height_, query);
  return query.best.number;
}

void KdTree::within(const Vec3& p, double radius, std::vector<std::size_t>& found) const {
  found.clear();
  if (root_ != kOut) {
    WithinBall query{p, radius * radius, found};
    search(leaves_.data(), branches_.data(), root_, height_, query);
    std::sort(found.begin(), found.end());
  }
}

void KdTree::within(const Box& box, std::vector<std::size_t>& found) const {
  found.clear();
  if (root_ != kOut) {
    WithinBox query{box, found};
    search(leaves_.data(), branches_.data(), root_, height_, query);
    std::sort(found.begin(), found.end());
  }
}
}  // namespace altiplan::kit
