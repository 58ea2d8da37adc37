// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/ground_within.hpp"

#include <array>
#include <optional>

namespace altiplan::kit {
namespace {

/// (fraction of the leg, x, y), x and y relative to the piece's centre.
using Unknowns = std::array<double, 3>;

/// The square of |o + share d - (x, y, dx x + dy y)| over a box of the unknowns: convex, so its
/// minimum is the smallest of those where the derivatives in some of them are zero and the others
/// are at their ends.
class LeastSquare {
 public:
  LeastSquare(const Vec3& o, const Vec3& d, const GroundPiece& piece)
      : o_(o), columns_{d, {-1, 0, -piece.dx}, {0, -1, -piece.dy}} {
    for (std::size_t i = 0; i < 3; ++i) {
      linear_[i] = columns_[i].dot(o);
      for (std::size_t j = 0; j < 3; ++j) {
        gram_[i][j] = columns_[i].dot(columns_[j]);
      }
    }
  }

  double distance(const Unknowns& u) const {
    return (o_ + u[0] * columns_[0] + u[1] * columns_[1] + u[2] * columns_[2]).norm();
  }

  /// Solves for the free unknowns, one or more, with zero derivatives; false if the columns are
  /// dependent: the minimum is then found with fewer free unknowns too.
  bool solve(const std::array<bool, 3>& is_free, Unknowns& u) const {
    std::array<std::size_t, 3> free{};
    std::array<double, 3> right{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_free[i]) {
        right[count] = -linear_[i];
        for (std::size_t j = 0; j < 3; ++j) {
          right[count] -= is_free[j] ? 0 : gram_[i][j] * u[j];
        }
        free[count++] = i;
      }
    }
    // Elimination without pivoting, as the matrix is positive definite or singular.
    std::array<std::array<double, 3>, 3> m{};
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        m[i][j] = gram_[free[i]][free[j]];
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (!(m[k][k] > kDependent * gram_[free[k]][free[k]])) {
        return false;
      }
      for (std::size_t i = k + 1; i < count; ++i) {
        const double by = m[i][k] / m[k][k];
        for (std::size_t j = k; j < count; ++j) {
          m[i][j] -= by * m[k][j];
        }
        right[i] -= by * right[k];
      }
    }
    for (std::size_t k = count; k-- > 0;) {
      for (std::size_t j = k + 1; j < count; ++j) {
        right[k] -= m[k][j] * u[free[j]];
      }
      u[free[k]] = right[k] / m[k][k];
    }
    return true;
  }

 private:
  static constexpr double kDependent = 1e-12;

  Vec3 o_;
  std::array<Vec3, 3> columns_;
  std::array<double, 3> linear_;
  std::array<std::array<double, 3>, 3> gram_;
};
}  // namespace

LegToPlane leg_to_plane(const Vec3& a, const Vec3& b, const GroundPiece& piece, double half_x,
                        double half_y) {
  const Vec3 middle(piece.x, piece.y, piece.z);
  const LeastSquare square(a - middle, b - a, piece);
  const Unknowns low{0, -half_x, -half_y};
  const Unknowns high{a == b ? 0.0 : 1.0, half_x, half_y};
  LegToPlane best{kInfinity, 0, 0, 0};
  // Each unknown is free (0), at its minimum (1) or its maximum (2); all of them are free first.
  for (int faces = 0; faces < 27; ++faces) {
    const std::array<int, 3> at{faces % 3, faces / 3 % 3, faces / 9};
    Unknowns u{};
    std::array<bool, 3> is_free{};
    bool doubled = false;
    for (std::size_t i = 0; i < 3; ++i) {
      is_free[i] = at[i] == 0;
      u[i] = at[i] == 2 ? high[i] : low[i];
      doubled |= at[i] != 1 && low[i] == high[i];
    }
    if (doubled || ((is_free[0] || is_free[1] || is_free[2]) && !square.solve(is_free, u))) {
      continue;
    }
    bool within = true;
    for (std::size_t i = 0; i < 3; ++i) {
      within &= u[i] >= low[i] && u[i] <= high[i];
    }
    if (const double distance = within ? square.distance(u) : kInfinity; distance < best.distance) {
      best = {distance, u[0], piece.x + u[1], piece.y + u[2]};
      if (faces == 0) {
        break;
      }
    }
  }
  return best;
}
}  // namespace altiplan::kit
