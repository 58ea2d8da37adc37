// SPDX-License-Identifier: Apache-2.0
#include "altiplan/request.hpp"

#include <algorithm>
#include <cstdio>

namespace altiplan {
namespace {

/// Poses at one position in `count` headings.
std::vector<Pose> all_headings(const Vec3& position, int count) {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) {
    poses.push_back({position, 2 * kPi * k / count});
  }
  return poses;
}

/// `count` poses on a loiter circle, without those whose course the wind does not let it hold.
std::vector<Pose> on_circle(const Request& request, const Vec3& centre, const Loiter& loiter,
                            int count) {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) {
    const Vec3 p = centre + loiter.radius * unit_heading(2 * kPi * k / count);
    if (const auto heading = request.heading_on(loiter.course(centre, p), p)) {
      poses.push_back({p, *heading});
    }
  }
  return poses;
}
}  // namespace

bool Request::judges_pairs() const {
  return vehicle.body != nullptr ||
         std::any_of(constraints.begin(), constraints.end(),
                     [](const NamedConstraint& named) { return !named.admits_all; });
}

std::optional<Approach> Request::before_start(const Vec3& first) const {
  const Vec3 course = start.loiter ? start.loiter->course(start.position, first) : start.velocity;
  return course.squaredNorm() == 0 ? std::nullopt : std::optional(Approach(first - course));
}

std::optional<Vec3> Request::arrival_course(const Vec3& last) const {
  if (goal.loiter) {
    return goal.loiter->course(goal.position, last);
  }
  return goal.heading ? std::optional(ground_velocity({last, *goal.heading})) : std::nullopt;
}

std::optional<double> Request::heading_on(const Vec3& course, const Vec3& at) const {
  return altiplan::heading_on(course, air_speed(), wind.at(at));
}

std::vector<Pose> Request::start_poses(int count) const {
  if (start.loiter) {
    return on_circle(*this, start.position, *start.loiter, count);
  }
  if (!has_heading(start.velocity)) {
    return all_headings(start.position, count);
  }
  const auto heading = heading_on(start.velocity, start.position);
  return heading ? std::vector<Pose>{{start.position, *heading}} : std::vector<Pose>{};
}

std::vector<Pose> Request::goal_poses(int count) const {
  if (goal.loiter) {
    return on_circle(*this, goal.position, *goal.loiter, count);
  }
  return goal.heading ? std::vector<Pose>{{goal.position, *goal.heading}}
                      : all_headings(goal.position, count);
}

std::string Request::place_text(const Vec3& p) const {
  char text[160];
  std::snprintf(text, sizeof text, "(%.0f, %.0f, %.0f)", p.x(), p.y(), p.z());
  std::string place = text;
  if (world && world->frame().has_position()) {
    const auto [lon, lat] = world->frame().to_lonlat(p.x(), p.y());
    std::snprintf(text, sizeof text, " at longitude %.5f, latitude %.5f", lon, lat);
    place += text;
  }
  return place;
}
}  // namespace altiplan
