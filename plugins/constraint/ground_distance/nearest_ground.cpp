// SPDX-License-Identifier: Apache-2.0
#include "nearest_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "altiplan/height_field.hpp"
#include "altiplan/kit/layers/field_within.hpp"

namespace ground_distance {
namespace {
using namespace altiplan;

constexpr double kFarther = 1e-3;

void take_nearer(NearGround& best, const NearGround& other) {
  if (other.at_most < best.at_most) {
    best.point = other.point;
    best.ground = other.ground;
    best.at_most = other.at_most;
  }
  best.at_least = std::min(best.at_least, other.at_least);
}

/// True if the field has all ground of the layer that far from the place.
bool has_all(const HeightField& field, const Box& layer, const Vec3& p, double within) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int posts = axis == 0 ? field.columns() : field.rows();
    const double first = field.origin()[axis];
    const double last = first + (posts - 1) * field.spacing()[axis];
    const double at = p[int(axis)];
    if ((at - within < first && layer.min[int(axis)] < first - kLengthTolerance) ||
        (at + within > last && layer.max[int(axis)] > last + kLengthTolerance)) {
      return false;
    }
  }
  return true;
}

/// Slopes of the cell that has the position.
std::array<double, 2> slopes(const HeightField& field, double x, double y) {
  const auto [dx, dy] = field.spacing();
  const double u = (x - field.origin()[0]) / dx;
  const double v = (y - field.origin()[1]) / dy;
  const int i = int(std::clamp(u, 0.0, double(field.columns() - 2)));
  const int j = int(std::clamp(v, 0.0, double(field.rows() - 2)));
  const double sw = field.post(i, j);
  const double se = field.post(i + 1, j);
  const double nw = field.post(i, j + 1);
  const double twist = field.post(i + 1, j + 1) - se - nw + sw;
  return {(se - sw + (v - j) * twist) / dx, (nw - sw + (u - i) * twist) / dy};
}

/// Walks downhill in distance from the point of `near`: to the foot of the perpendicular on the
/// plane that touches the ground, less far where that is no nearer. Ends at a local minimum, about.
void descend(const HeightField& field, const Vec3& p, NearGround& near) {
  constexpr int kSteps = 8;
  constexpr double kFine = 1e-4;  // metres
  double share = 1;
  for (int n = 0; n < kSteps; ++n) {
    const Vec3 to = p - near.point;
    const auto [dx, dy] = slopes(field, near.point.x(), near.point.y());
    const double east = to.x() + dx * to.z();
    const double north = to.y() + dy * to.z();
    const double back = (dx * east + dy * north) / (1 + dx * dx + dy * dy);
    const double x = near.point.x() + share * (east - back * dx);
    const double y = near.point.y() + share * (north - back * dy);
    const auto height = field.at(x, y);
    const double away = height ? std::hypot(p.x() - x, p.y() - y, p.z() - *height) : kInfinity;
    if (away < near.at_most) {
      const bool is_done = away > near.at_most - kFine;
      near.point = Vec3(x, y, *height);
      near.at_most = away;
      if (is_done) {
        return;
      }
    } else {
      share /= 2;
    }
  }
}

/// All posts, for ground that is nearer than the one known.
void search_posts(const HeightField& field, const Vec3& p, double within, NearGround& near) {
  kit::GroundWithin search(p, p, std::min(within, near.at_most), kit::GroundWithin::Until::nearest);
  kit::search_field(search, field);
  if (search.nearest()) {
    near.point = *search.nearest();
    near.at_most = search.distance();
  }
}

/// What a layer without posts tells; its obstacles other than the ground are not to be counted.
void ask_layer(const Environment& layer, const Ground& ground, const Vec3& p, double within,
               NearGround& near) {
  if (ground.is_all()) {
    layer.near(p, std::min(within, near.at_most), [&](const Nearby& nearby) {
      if (nearby.distance > 0 && nearby.distance < near.at_most) {
        near.point = nearby.point;
        near.at_most = nearby.distance;
      }
    });
  }
  if (const auto distance = ground.is_all() ? ground.distance(p, p) : std::nullopt) {
    near.at_least = *distance;
    near.at_most = std::min(near.at_most, *distance);
  } else {
    near.at_least = layer.blocked(p, p, within) ? 0 : within;
  }
}

NearGround nearest_of(const Environment& layer, const Ground& ground, const Vec3& p, double limit) {
  const double within = limit + kFarther;
  NearGround near;
  near.ground = &ground;
  near.at_least = 0;
  const HeightField* field = ground.height_field();
  if (const auto below = ground.height(p.x(), p.y())) {
    near.point = Vec3(p.x(), p.y(), *below);
    near.at_most = std::max(p.z() - *below, 0.0);
    if (p.z() > *below && field != nullptr && field->at(p.x(), p.y())) {
      descend(*field, p, near);
    }
  }
  if (near.at_most == 0 || (field != nullptr && near.at_most <= limit)) {
    return near;
  }
  if (field != nullptr) {
    search_posts(*field, p, within, near);
  }
  if (field != nullptr && has_all(*field, layer.bounds(), p, within)) {
    near.at_least = std::min(within, near.at_most);
  } else {
    ask_layer(layer, ground, p, within, near);
  }
  return near;
}
}  // namespace

NearGround nearest_ground(const World& world, const Vec3& p, double limit) {
  NearGround best;
  for (const Layer& layer : world.layers()) {
    if (const Ground* ground = layer.environment->ground()) {
      take_nearer(best, nearest_of(*layer.environment, *ground, p, limit));
    }
  }
  return best;
}

double off_the_ground(const Ground& ground, const Vec3& a, const Vec3& b) {
  return std::max(ground.gap_max(a, b), -ground.gap(a, b));
}
}  // namespace ground_distance
