// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "worlds.hpp"

namespace altiplan::conformance {

Balls::Balls(std::vector<Sphere> balls) : balls_(std::move(balls)) {
  for (const Sphere& ball : balls_) {
    info_.threats.push_back({ball.centre, ball.radius, "ball", ""});
  }
}

Box Balls::do_bounds() const {
  Box box = Box::empty();
  for (const Sphere& ball : balls_) {
    box = box.united(Box{ball.centre, ball.centre}.grown(ball.radius));
  }
  return box;
}

double Balls::do_clearance(const Vec3& p) const {
  double min_distance = kInfinity;
  for (const Sphere& ball : balls_) {
    min_distance = std::min(min_distance, (p - ball.centre).norm() - ball.radius);
  }
  return min_distance;
}

bool Balls::do_blocked(const Vec3& a, const Vec3& b, double r) const {
  return std::any_of(balls_.begin(), balls_.end(), [&](const Sphere& ball) {
    return point_leg_distance(ball.centre, a, b) - ball.radius < r - kLengthTolerance;
  });
}

void Balls::do_near(const Vec3& p, double reach, const NearSink& sink) const {
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Vec3 off = p - balls_[i].centre;
    const double distance = off.norm() - balls_[i].radius;
    if (distance <= reach) {
      const Vec3 normal = off.norm() > 0 ? Vec3(off.normalized()) : Vec3(0, 0, 1);
      sink({balls_[i].centre + normal * balls_[i].radius, distance, normal, int(i)});
    }
  }
}

Box BallField::do_bounds() const {
  const Vec3 last = first_ + spacing_ * Vec3(counts_[0] - 1, counts_[1] - 1, counts_[2] - 1);
  return Box{first_, last}.grown(radius_);
}

double BallField::do_clearance(const Vec3& p) const {
  Vec3 nearest;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::round((p[axis] - first_[axis]) / spacing_);
    nearest[axis] = first_[axis] + spacing_ * std::clamp(at, 0.0, counts_[std::size_t(axis)] - 1.0);
  }
  return (p - nearest).norm() - radius_;
}

void BallField::do_near(const Vec3& p, double reach, const NearSink& sink) const {
  std::array<int, 3> from;
  std::array<int, 3> to;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = p[int(axis)] - first_[int(axis)];
    const double far = reach + radius_;
    const auto post = [&](double x) {
      return int(std::clamp(std::floor(x / spacing_), -1.0, double(counts_[axis])));
    };
    from[axis] = std::max(post(at - far), 0);
    to[axis] = std::min(post(at + far), counts_[axis] - 1);
  }
  for (int k = from[2]; k <= to[2]; ++k) {
    for (int j = from[1]; j <= to[1]; ++j) {
      for (int i = from[0]; i <= to[0]; ++i) {
        const Vec3 off = p - (first_ + spacing_ * Vec3(i, j, k));
        const double distance = off.norm() - radius_;
        if (distance <= reach) {
          const Vec3 normal = off.norm() > 0 ? Vec3(off.normalized()) : Vec3(0, 0, 1);
          sink({p - distance * normal, distance, normal, (k * counts_[1] + j) * counts_[0] + i});
        }
      }
    }
  }
}

namespace {
using Vec2 = std::array<double, 2>;

/// Distance between a point and the side of the ridge that descends from its crest to the left
/// (sign -1) or right, in the plane across it.
double side_distance(const Vec2& p, double slope, double sign) {
  const double scale = 1 / std::sqrt(1 + slope * slope);
  const Vec2 down{sign * scale, -slope * scale};
  const double along = std::max(0.0, p[0] * down[0] + p[1] * down[1]);
  return std::hypot(p[0] - along * down[0], p[1] - along * down[1]);
}
}  // namespace

Box Ridge::do_bounds() const {
  Box box;
  box.max.z() = top_;
  return box;
}

double Ridge::do_clearance(const Vec3& p) const {
  const Vec2 at{p.x() - x_, p.z() - top_};
  const double distance = std::min(side_distance(at, slope_, -1), side_distance(at, slope_, 1));
  return p.z() < height_at(p.x()) ? -distance : distance;
}

bool Ridge::do_blocked(const Vec3& a, const Vec3& b, double r) const {
  double min_clearance = std::min(do_clearance(a), do_clearance(b));
  const double t = a.x() == b.x() ? -1 : (x_ - a.x()) / (b.x() - a.x());
  if (t > 0 && t < 1) {
    const double over = a.z() + t * (b.z() - a.z()) - top_;  // of the leg over the crest
    const Vec3 flat_a(a.x(), 0, a.z());
    const Vec3 flat_b(b.x(), 0, b.z());
    const double crest = point_leg_distance({x_, 0, top_}, flat_a, flat_b);
    min_clearance = std::min(min_clearance, over < 0 ? over : crest);
  }
  return min_clearance < r - kLengthTolerance;
}

double Ridge::do_gap(const Vec3& a, const Vec3& b, double) const {
  double min_gap = std::min(a.z() - height_at(a.x()), b.z() - height_at(b.x()));
  const double t = a.x() == b.x() ? -1 : (x_ - a.x()) / (b.x() - a.x());
  if (t > 0 && t < 1) {
    min_gap = std::min(min_gap, a.z() + t * (b.z() - a.z()) - top_);
  }
  return min_gap;
}

double Ridge::do_gap_max(const Vec3& a, const Vec3& b) const {
  return std::max(a.z() - height_at(a.x()), b.z() - height_at(b.x()));
}

double Watched::do_clearance(const Vec3& p) const {
  asked_(p);
  return inner_->clearance(p);
}
bool Watched::do_blocked(const Vec3& a, const Vec3& b, double r) const {
  asked_(a + b);
  return inner_->blocked(a, b, r);
}
void Watched::do_near(const Vec3& p, double reach, const NearSink& sink) const {
  asked_(p);
  inner_->near(p, reach, sink);
}
void Watched::do_rasterize(VoxelGrid& grid) const {
  asked_(Vec3::Zero());
  inner_->rasterize(grid);
}
}  // namespace altiplan::conformance
