// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/kd_tree.hpp"

#include <algorithm>

namespace altiplan::kit {

void KdTree::clear() {
  points_.clear();
  out_.clear();
  order_.clear();
  axis_.clear();
}

void KdTree::reserve(std::size_t count) {
  points_.reserve(count);
  out_.reserve(count);
  order_.reserve(count);
  axis_.reserve(count);
}

std::size_t KdTree::insert(const Vec3& p) {
  points_.push_back(p);
  out_.push_back(0);
  const std::size_t waiting = points_.size() - order_.size();
  if (waiting >= std::max(order_.size(), kFirst)) {
    while (order_.size() < points_.size()) {
      order_.push_back(std::uint32_t(order_.size()));
    }
    std::sort(order_.begin(), order_.end());
    axis_.assign(order_.size(), 0);
    build(0, order_.size());
  }
  return points_.size() - 1;
}

void KdTree::build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeaf) {
    return;
  }
  Box box = Box::empty();
  for (std::size_t i = begin; i < end; ++i) {
    box = box.with(points_[order_[i]]);
  }
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + std::ptrdiff_t(begin), order_.begin() + std::ptrdiff_t(middle),
                   order_.begin() + std::ptrdiff_t(end), [&](std::uint32_t a, std::uint32_t b) {
                     const double x = points_[a][axis];
                     const double y = points_[b][axis];
                     return x != y ? x < y : a < b;
                   });
  axis_[middle] = std::uint8_t(axis);
  build(begin, middle);
  build(middle + 1, end);
}

/// `visit.see(number)` looks at a point; `visit.reach()` is the distance, squared, that still
/// matters.
template <class Visit>
void KdTree::search(std::size_t begin, std::size_t end, const Vec3& p, Visit& visit) const {
  if (end - begin <= kLeaf) {
    for (std::size_t i = begin; i < end; ++i) {
      visit.see(order_[i]);
    }
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const int axis = axis_[middle];
  const double beyond = p[axis] - points_[order_[middle]][axis];
  visit.see(order_[middle]);
  if (beyond < 0) {
    search(begin, middle, p, visit);
  } else {
    search(middle + 1, end, p, visit);
  }
  if (beyond * beyond <= visit.reach()) {
    if (beyond < 0) {
      search(middle + 1, end, p, visit);
    } else {
      search(begin, middle, p, visit);
    }
  }
}

std::size_t KdTree::nearest(const Vec3& p) const {
  struct Nearest {
    const KdTree& tree;
    const Vec3& p;
    std::size_t best = kNone;
    double least = kInfinity;
    double reach() const { return least; }
    void see(std::size_t number) {
      const double square = (tree.points_[number] - p).squaredNorm();
      if (tree.out_[number] != 0) {
        return;
      }
      if (square < least || (square == least && number < best)) {
        least = square;
        best = number;
      }
    }
  } visit{*this, p};
  search(0, order_.size(), p, visit);
  for (std::size_t i = order_.size(); i < points_.size(); ++i) {
    visit.see(i);
  }
  return visit.best;
}

void KdTree::within(const Vec3& p, double radius, std::vector<std::size_t>& found) const {
  struct Within {
    const KdTree& tree;
    const Vec3& p;
    double square;
    std::vector<std::size_t>& found;
    double reach() const { return square; }
    void see(std::size_t number) {
      if (tree.out_[number] == 0 && (tree.points_[number] - p).squaredNorm() <= square) {
        found.push_back(number);
      }
    }
  } visit{*this, p, radius * radius, found};
  found.clear();
  search(0, order_.size(), p, visit);
  for (std::size_t i = order_.size(); i < points_.size(); ++i) {
    visit.see(i);
  }
  std::sort(found.begin(), found.end());
}

std::size_t KdTree::least_sum(const Vec3& p, double p_weight, const Vec3& q,
                              double q_weight) const {
  std::size_t best = kNone;
  double least = kInfinity;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double sum = p_weight * (points_[i] - p).norm() + q_weight * (points_[i] - q).norm();
    if (out_[i] == 0 && sum < least) {
      least = sum;
      best = i;
    }
  }
  return best;
}

void KdTree::within(const Box& box, std::vector<std::size_t>& found) const {
  found.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (out_[i] == 0 && box.contains(points_[i])) {
      found.push_back(i);
    }
  }
}
}  // namespace altiplan::kit
