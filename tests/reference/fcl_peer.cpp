// SPDX-License-Identifier: Apache-2.0
#include "reference/fcl_peer.hpp"

#include <Eigen/Geometry>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#pragma GCC diagnostic pop

namespace altiplan::bench {
namespace {

using Object = fcl::CollisionObjectd;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

constexpr double kBall = 1e-3;

std::unique_ptr<Object> placed(const Geometry& geometry, const Vec3& at) {
  return std::make_unique<Object>(geometry, Eigen::Matrix3d::Identity(), at);
}

// Faces as FCL wants them: the number of corners, then the corners, counterclockwise from outside.
Geometry convex(const Prism& prism) {
  const int count = int(prism.outline.size());
  auto corners = std::make_shared<std::vector<Vec3>>();
  for (const double z : {prism.floor, prism.ceiling}) {
    for (const auto& p : prism.outline) {
      corners->emplace_back(p[0], p[1], z);
    }
  }
  auto faces = std::make_shared<std::vector<int>>();
  faces->push_back(count);
  for (int n = count - 1; n >= 0; --n) {
    faces->push_back(n);
  }
  faces->push_back(count);
  for (int n = 0; n < count; ++n) {
    faces->push_back(count + n);
  }
  for (int n = 0; n < count; ++n) {
    const int next = (n + 1) % count;
    faces->insert(faces->end(), {4, n, next, count + next, count + n});
  }
  return std::make_shared<fcl::Convexd>(corners, count + 2, faces);
}

std::unique_ptr<Object> object_of(const Shape& shape) {
  if (const auto* s = std::get_if<Sphere>(&shape)) {
    return placed(std::make_shared<fcl::Sphered>(s->radius), s->centre);
  }
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    return placed(std::make_shared<fcl::Cylinderd>(c->radius, c->ceiling - c->floor),
                  {c->x, c->y, (c->floor + c->ceiling) / 2});
  }
  if (const auto* b = std::get_if<BoxShape>(&shape)) {
    return placed(std::make_shared<fcl::Boxd>(Vec3(b->box.max - b->box.min)),
                  (b->box.min + b->box.max) / 2);
  }
  return placed(convex(std::get<Prism>(shape)), {0, 0, 0});
}
}  // namespace

struct FclPeer::Impl {
  std::vector<std::unique_ptr<Object>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
};

FclPeer::FclPeer(const std::vector<Shape>& shapes) : impl_(std::make_unique<Impl>()) {
  std::vector<Object*> objects;
  for (const Shape& shape : shapes) {
    impl_->objects.push_back(object_of(shape));
    objects.push_back(impl_->objects.back().get());
  }
  impl_->manager.registerObjects(objects);
  impl_->manager.setup();
}

FclPeer::~FclPeer() = default;
FclPeer::FclPeer(FclPeer&&) noexcept = default;

bool FclPeer::blocked(const Vec3& a, const Vec3& b, double r) const {
  static thread_local const auto kCapsule = std::make_shared<fcl::Capsuled>(1, 1);
  static thread_local Object capsule(kCapsule);
  kCapsule->radius = r;
  kCapsule->lz = (b - a).norm();
  kCapsule->computeLocalAABB();
  capsule.setTransform(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), b - a).toRotationMatrix(),
                       (a + b) / 2);
  capsule.computeAABB();
  fcl::DefaultCollisionData<double> data;
  data.request.gjk_solver_type = fcl::GST_LIBCCD;
  impl_->manager.collide(&capsule, &data, fcl::DefaultCollisionFunction<double>);
  return data.result.isCollision();
}

double FclPeer::clearance(const Vec3& p) const {
  static thread_local Object ball(std::make_shared<fcl::Sphered>(kBall));
  ball.setTranslation(p);
  ball.computeAABB();
  fcl::DefaultDistanceData<double> data;
  data.request.gjk_solver_type = fcl::GST_LIBCCD;
  impl_->manager.distance(&ball, &data, fcl::DefaultDistanceFunction<double>);
  return data.result.min_distance + kBall;
}
}  // namespace altiplan::bench
