// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "altiplan/body.hpp"
#include "framework/shape_oracle.hpp"
#include "reference/separation.hpp"

namespace altiplan::oracle {

using Matrix = Eigen::Matrix<Real, 3, 3>;

/// A body with its parts as they were asked for, in body axes.
struct RandomBody {
  std::shared_ptr<const Body> body;
  std::vector<Convex> parts;
};

inline RandomBody random_body(Draw& draw) {
  auto body = std::make_shared<Body>();
  RandomBody made;
  for (int parts = draw.below(4) == 0 ? 2 : 1; parts > 0; --parts) {
    const double size = std::pow(10, draw(-0.7, 1.3));
    const Vec3 offset = draw(0, 1) * draw.point(size);
    const double slim = draw(0.05, 0.5);
    std::vector<Vec3> points;
    switch (draw.below(4)) {
      case 0:
        body->parts.push_back(box_part(size * draw.within({0.05, 0.05, 0.05}, {1, 1, 1}), offset));
        break;
      case 1:
        body->parts.push_back(capsule_part(size * slim, size, offset));
        break;
      case 2:
        body->parts.push_back(cylinder_part(size * slim, size * draw(0.05, 1), offset));
        break;
      default:
        for (int n = 5 + draw.below(30); n > 0; --n) {
          points.push_back(offset + draw.point(size));
        }
        body->parts.push_back(hull_part(points));
    }
    const BodyPart& part = body->parts.back();
    Convex convex{{}, 0, part.rounding};
    for (const Vec3& p : points.empty() ? part.corners : points) {
      convex.points.push_back(exact(p));
    }
    made.parts.push_back(convex);
  }
  body->pitches = draw.below(2) == 0;
  if (draw.below(4) == 0) {
    body->yaw = draw(-kPi, kPi);
  }
  made.body = body;
  return made;
}

/// The axes of a body with that heading and climb angle: forward, left, up.
inline Matrix axes(Real yaw, Real pitch) {
  const Vector forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                       std::sin(pitch));
  const Vector left(-std::sin(yaw), std::cos(yaw), 0);
  Matrix all;
  all << forward, left, forward.cross(left);
  return all;
}

/// On a straight path in calm air.
inline Matrix axes_along(const Body& body, const Vec3& a, const Vec3& b) {
  const Vector along = exact(b) - exact(a);
  const Real yaw = body.yaw ? Real(*body.yaw) : std::atan2(along.y(), along.x());
  return axes(yaw, body.pitches ? std::atan2(along.z(), along.head<2>().norm()) : 0);
}

inline Convex placed(const Convex& part, const Matrix& axes, const Vector& at) {
  Convex made = part;
  for (Vector& p : made.points) {
    p = at + axes * p;
  }
  return made;
}

/// What a part sweeps from a to b at a constant attitude.
inline Convex swept(const Convex& part, const Matrix& axes, const Vec3& a, const Vec3& b) {
  Convex made = placed(part, axes, exact(a));
  const Convex end = placed(part, axes, exact(b));
  made.points.insert(made.points.end(), end.points.begin(), end.points.end());
  return made;
}
}  // namespace altiplan::oracle
