// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <vector>

#include "altiplan/geometry.hpp"

// Whether two convex sets are apart, and how far, by P. Wolfe, "Finding the nearest point in a
// polytope", Mathematical Programming 11, 1976, on their difference: least squares over at most
// four points, in 80-bit numbers. Neither answer rests on the method's convergence: a direction
// proves a gap, by the farthest points along it, and two points prove that a gap is no wider.
namespace altiplan::oracle {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;

inline Vector exact(const Vec3& p) { return p.cast<Real>(); }

/// The convex hull of points, grown by a horizontal disc and by a ball.
struct Convex {
  std::vector<Vector> points;
  Real disc = 0;
  Real ball = 0;

  Vector farthest_without_ball(const Vector& along) const {
    Vector best = points.front();
    Real most = along.dot(best);
    for (const Vector& p : points) {
      const Real here = along.dot(p);
      if (here > most) {
        most = here;
        best = p;
      }
    }
    const Real flat = along.head<2>().norm();
    if (disc > 0 && flat > 0) {
      best.head<2>() += disc / flat * along.head<2>();
    }
    return best;
  }

  Convex moved(const Vector& by) const {
    Convex made = *this;
    for (Vector& p : made.points) {
      p += by;
    }
    return made;
  }
};

/// What is known of two sets: the gap between them, negative for the depth of their overlap, the
/// least way that separates them.
struct Gap {
  Real low = -std::numeric_limits<Real>::infinity();
  Real high = std::numeric_limits<Real>::infinity();
  Vector direction{0, 0, 1};  ///< unit, from the first set to the second; moved by -low along it,
                              ///< the second touches the first at most
};

/// The point of a simplex nearest to the origin, by Wolfe's minor cycle.
class Simplex {
 public:
  explicit Simplex(const Vector& p) : points_{p}, weights_{1} {}

  Vector nearest() const {
    Vector sum = Vector::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      sum += weights_[i] * points_[i];
    }
    return sum;
  }

  /// The direction to that point, across the edges or the face on which it lies: far more exact
  /// than the point's own where it is near and the corners are far.
  Vector direction() const {
    Vector along = nearest();
    if (points_.size() == 2) {
      const Vector edge = (points_[1] - points_[0]).normalized();
      along -= along.dot(edge) * edge;
    } else if (points_.size() == 3) {
      const Vector across = (points_[1] - points_[0]).cross(points_[2] - points_[0]);
      along = across.dot(along) < 0 ? Vector(-across) : across;
    }
    return along.normalized();
  }

  /// False if the point is one of the corners.
  bool add(const Vector& p) {
    if (points_.size() == 4 || std::find(points_.begin(), points_.end(), p) != points_.end()) {
      return false;
    }
    points_.push_back(p);
    weights_.push_back(0);
    for (;;) {
      const std::vector<Real> wanted = nearest_of_span();
      Real step = 1;
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i] < 0) {
          step = std::min(step, weights_[i] / (weights_[i] - wanted[i]));
        }
      }
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        weights_[i] += step * (wanted[i] - weights_[i]);
      }
      if (step >= 1) {
        return true;
      }
      drop_least();
    }
  }

 private:
  /// Weights of the point of the affine hull that is nearest to the origin.
  std::vector<Real> nearest_of_span() const {
    const Eigen::Index count = Eigen::Index(points_.size()) - 1;
    std::vector<Real> weights(points_.size(), 1);
    if (count > 0) {
      Eigen::Matrix<Real, 3, Eigen::Dynamic, 0, 3, 3> edges(3, count);
      for (Eigen::Index i = 0; i < count; ++i) {
        edges.col(i) = points_[std::size_t(i) + 1] - points_[0];
      }
      const Eigen::Matrix<Real, Eigen::Dynamic, 1> along =
          edges.colPivHouseholderQr().solve(Vector(-points_[0]));
      for (Eigen::Index i = 0; i < count; ++i) {
        weights[std::size_t(i) + 1] = along[i];
        weights[0] -= along[i];
      }
    }
    return weights;
  }

  void drop_least() {
    const auto least = std::min_element(weights_.begin(), weights_.end());
    points_.erase(points_.begin() + (least - weights_.begin()));
    weights_.erase(least);
    Real sum = 0;
    for (Real& weight : weights_) {
      weight = std::max<Real>(weight, 0);
      sum += weight;
    }
    for (Real& weight : weights_) {
      weight /= sum;
    }
  }

  std::vector<Vector> points_;
  std::vector<Real> weights_;
};

inline Gap separation(const Convex& first, const Convex& second) {
  constexpr int kMostSteps = 500;
  constexpr Real kEnough = 1e-10L;  // metres
  const Real balls = first.ball + second.ball;
  const auto support = [&](const Vector& along) -> Vector {
    return second.farthest_without_ball(along) - first.farthest_without_ball(-along);
  };
  Gap gap;
  Simplex simplex(support({1, 0, 0}));
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector nearest = simplex.nearest();
    gap.high = std::min(gap.high, nearest.norm() - balls);
    if (nearest.norm() < kEnough) {
      break;
    }
    const Vector direction = simplex.direction();
    const Vector least = support(-direction);
    const Real margin = direction.dot(least) - balls;
    if (margin > gap.low) {
      gap.low = margin;
      gap.direction = direction;
    }
    if (gap.high - gap.low < kEnough || !simplex.add(least)) {
      break;
    }
  }
  return gap;
}
}  // namespace altiplan::oracle
