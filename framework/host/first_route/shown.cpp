// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/shown.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/height_field.hpp"

namespace altiplan::host {
namespace {

using Plane = Eigen::Vector2d;

/// A part of a line that is straight in plan.
struct Stretch {
  Polyline points;
  bool begins_line = false;

  Plane from() const { return points.front().head<2>(); }
  Plane way() const { return points.back().head<2>() - from(); }
  /// Least height between two places along it, metres from its beginning; beyond its ends that of
  /// the end.
  double lowest(double begin_m, double end_m) const {
    double low = kInfinity;
    double at = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double length = (points[i] - points[i - 1]).head<2>().norm();
      const bool is_first = i == 1;
      const bool is_last = i + 1 == points.size();
      if ((end_m >= at || is_first) && (begin_m <= at + length || is_last)) {
        for (const double place : {begin_m, end_m}) {
          const double t = length > 0 ? std::clamp((place - at) / length, 0.0, 1.0) : 0;
          low = std::min(low, points[i - 1].z() + t * (points[i].z() - points[i - 1].z()));
        }
      }
      at += length;
    }
    return low;
  }
};

std::vector<Stretch> stretches_of(const std::vector<Polyline>& lines) {
  constexpr double kStraight = 1e-6;  // radians
  std::vector<Stretch> all;
  for (const Polyline& line : lines) {
    all.push_back({{line.front()}, true});
    for (std::size_t i = 1; i < line.size(); ++i) {
      Polyline& points = all.back().points;
      if (points.size() > 1 && turn_angle_horizontal(points.back() - points[points.size() - 2],
                                                     line[i] - line[i - 1]) > kStraight) {
        all.push_back({{line[i - 1]}, false});
      }
      all.back().points.push_back(line[i]);
    }
  }
  return all;
}

/// Metres along the stretch from a place to the nearest photo that is certain: at the beginning of
/// a line, or somewhat before, and then at each trigger distance; after a corner nobody knows how
/// much of that is left. The one at a line's end may come too soon after another for the camera.
double nearest_photo(const Stretch& stretch, const PhotoLines& photos, double s, double length) {
  const double trigger_m = photos.trigger_m;
  if (!stretch.begins_line) {  // the first and the last are within a distance of the ends
    return length < trigger_m ? kInfinity
                              : std::max({trigger_m / 2, trigger_m - s, s - (length - trigger_m)});
  }
  const double beside = std::max({-s, s - length, 0.0});
  return s < 0                     ? std::max(beside, photos.early_m)
         : s <= length - trigger_m ? trigger_m / 2
                                   : beside + trigger_m;
}

/// True if a photo of the stretch shows all within `radius` of a place whose ground is at most that
/// high.
bool shows(const Stretch& stretch, const PhotoLines& photos, const Plane& place, double radius,
           double ground) {
  const Plane way = stretch.way();
  const double length = way.norm();
  const Plane off = place - stretch.from();
  const double s = length > 0 ? off.dot(way) / length : 0;
  const double aside =
      length > 0 ? std::abs(off.x() * way.y() - off.y() * way.x()) / length : off.norm();
  const double along = nearest_photo(stretch, photos, s, length);
  const double beyond = radius + photos.off_m;
  const double height = stretch.lowest(s - along, s + along) - photos.off_m - ground;
  return aside + beyond <= photos.half_across * height &&
         along + beyond <= photos.half_along * height;
}

/// Of the elevation models; infinite where there is none.
double highest_ground(const World& world, const Plane& place, double half) {
  const Plane low = place.array() - half;
  const Plane high = place.array() + half;
  double highest = -kInfinity;
  for (const Layer& layer : world.layers()) {
    const Ground* ground = layer.environment->ground();
    const Box box = layer.environment->bounds();
    if (ground != nullptr && (low.array() <= box.max.head<2>().array()).all() &&
        (high.array() >= box.min.head<2>().array()).all()) {
      const HeightField* field = ground->height_field();
      highest = std::max(highest, field == nullptr
                                      ? kInfinity
                                      : field->max_height(low.x(), low.y(), high.x(), high.y()));
    }
  }
  return highest > -kInfinity ? highest : kInfinity;
}
}  // namespace

bool ring_holds(const formats::Ring& ring, const Plane& p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const auto& [ax, ay] = ring[j];
    const auto& [bx, by] = ring[i];
    if ((ay > p.y()) != (by > p.y()) && p.x() < (bx - ax) * (p.y() - ay) / (by - ay) + ax) {
      inside = !inside;
    }
  }
  return inside;
}

double share_shown(const std::vector<formats::Polygon>& areas, const PhotoLines& photos,
                   const World& world) {
  constexpr double kMaxCells = 1e6;
  Box box = Box::empty();
  for (const formats::Polygon& area : areas) {
    for (const auto& [x, y] : area.outline) {
      box = box.with({x, y, 0});
    }
  }
  const Vec3 size = box.max - box.min;
  const double cell =
      std::max({1.0, size.head<2>().maxCoeff() / 400, std::sqrt(size.x() * size.y() / kMaxCells)});
  const std::vector<Stretch> stretches = stretches_of(photos.lines);
  std::size_t cells = 0;
  std::size_t shown = 0;
  for (double y = box.min.y() + cell / 2; y < box.max.y(); y += cell) {
    for (double x = box.min.x() + cell / 2; x < box.max.x(); x += cell) {
      const Plane place(x, y);
      const auto holds = [&](const formats::Ring& ring) { return ring_holds(ring, place); };
      if (std::none_of(areas.begin(), areas.end(), [&](const formats::Polygon& area) {
            return holds(area.outline) && std::none_of(area.holes.begin(), area.holes.end(), holds);
          })) {
        continue;
      }
      ++cells;
      const double ground = highest_ground(world, place, cell / 2);
      shown += std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& stretch) {
        return shows(stretch, photos, place, cell * std::sqrt(0.5), ground);
      });
    }
  }
  return cells > 0 ? double(shown) / double(cells) : 0;
}
}  // namespace altiplan::host
