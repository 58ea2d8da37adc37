// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/world.hpp"
#include "field_pilot.hpp"

namespace apf {
namespace {
/// Switches to another side if the path past it is no longer than this fraction: a permanent choice
/// may be wrong, and one that follows every change oscillates.
constexpr double kMuchShorter = 0.8;
constexpr int kMaxParts = 32;
constexpr int kParts = 8;  ///< of the detour, after each of which the rest may be straight

Passing opposite(Passing passing) {
  switch (passing) {
    case Passing::left:
      return Passing::right;
    case Passing::right:
      return Passing::left;
    case Passing::above:
      return Passing::below;
    case Passing::below:
      return Passing::above;
    case Passing::nothing:
      break;
  }
  return passing;
}

bool is_level(Passing passing) { return passing == Passing::left || passing == Passing::right; }

double climb_of(const Vec3& way) { return std::atan2(way.z(), std::hypot(way.x(), way.y())); }
}  // namespace

Vec3 FieldPilot::way_around(const Observation& seen) {
  const double reach = std::min(to_target_.norm(), target_);
  const Vec3 way = to_target_.normalized() * reach;
  if (is_free_way(here_, 0, way)) {
    passing_ = insists() ? passing_ : Passing::nothing;
    return to_target_;
  }
  Detour detour = passing_ == Passing::nothing ? Detour{} : past(way, passing_, kInfinity);
  if (passing_ == Passing::nothing || !insists()) {
    detour = shorter_than(detour, seen, way);
  }
  if (!detour.aside) {
    detour = past(way, opposite(detour.passing), kInfinity);
  }
  passing_ = detour.passing;
  return detour.aside.value_or(to_target_);
}

double FieldPilot::length_along(Passing passing) const {
  const Vec3 target = here_ + to_target_;
  const int sign = passing == Passing::left ? 1 : -1;
  Vec3 at = here_;
  double flown = 0;
  int turn = 1;
  for (int part = 0; part < kMaxParts; ++part) {
    const Vec3 left = target - at;
    const Vec3 way = left.normalized() * std::min(left.norm(), target_);
    if (is_free_way(at, flown / speed_, way)) {
      return flown + left.norm();
    }
    turn = std::max(1, turn - 3);  // beside an obstacle the turns follow each other closely
    std::optional<Vec3> aside;
    while (turn <= Fan::kHalf &&
           !(aside = free_way(at, flown / speed_, fan_.turned(way, sign * turn), true))) {
      ++turn;
    }
    if (!aside) {
      return kInfinity;
    }
    const Vec3 on = *aside / 4;
    at += on;
    flown += on.norm();
  }
  return flown + (target - at).norm();
}

FieldPilot::Detour FieldPilot::shorter_than(const Detour& chosen, const Observation& seen,
                                            const Vec3& way) {
  const bool first =
      chosen.passing == Passing::nothing || !(is_level(chosen.passing) || chosen.aside);
  const double maximum = first ? kInfinity : kMuchShorter * chosen.length;
  if (maximum <= way.norm()) {
    return chosen;  // straight through would not be much shorter
  }
  const Detour left = past(way, Passing::left, maximum);
  const Detour right = past(way, Passing::right, first ? maximum : std::min(maximum, left.length));
  Detour best = left.length < right.length ? left : right;
  if (left.length == right.length && (first || left.length < maximum)) {
    sum_up(seen);
    best = bearing_change(way, force_) >= 0 ? left : right;
  }
  if (first) {
    const double along_left = length_along(Passing::left);
    const double along_right = length_along(Passing::right);
    if (along_left != along_right) {
      best = along_left < along_right ? left : right;
    }
  } else if (is_level(chosen.passing) && best.length < maximum &&
             length_along(best.passing) >= kMuchShorter * length_along(chosen.passing)) {
    best = chosen;
  }
  for (const Passing passing : {Passing::above, Passing::below}) {
    const Detour detour = past(way, passing, std::min(maximum, best.length));
    if (detour.length < best.length) {
      best = detour;
    }
  }
  return first || best.length < maximum ? best : chosen;
}

bool FieldPilot::is_free_way(const Vec3& from, double after, const Vec3& way) const {
  const double length = way.norm();
  const double end = from.z() + way.z();
  return length == 0 || (lowest_ - kLengthTolerance <= end && end <= highest_ + kLengthTolerance &&
                         outlook_.seconds_to_contact(from, after, way / length * speed_,
                                                     outlook_.margin()) > length / speed_ &&
                         outlook_.is_open(from, from + way, required_ + room_));
}

std::optional<Vec3> FieldPilot::free_way(const Vec3& from, double after, const Vec3& way,
                                         bool rises) const {
  if (is_free_way(from, after, way)) {
    return way;
  }
  if (!rises || !request_.world->has_ground()) {
    return std::nullopt;
  }
  const double rise =
      std::min(std::hypot(way.x(), way.y()) * std::tan(max_climb()), highest_ - from.z());
  const Vec3 risen(way.x(), way.y(), rise);
  return rise > std::max(way.z(), 0.0) && is_free_way(from, after, risen) ? std::optional(risen)
                                                                          : std::nullopt;
}

FieldPilot::Detour FieldPilot::past(const Vec3& way, Passing passing, double maximum) const {
  Detour detour{passing, min_turned(way, passing, maximum), kInfinity};
  if (detour.aside) {
    const Vec3& aside = *detour.aside;
    detour.length = 2 * aside.norm() + (way - aside).norm();
    for (int i = 1; i <= kParts; ++i) {
      const Vec3 on = aside * (double(i) / kParts);
      if (is_free_way(here_ + on, on.norm() / speed_, way - on)) {
        detour.length = on.norm() + (way - on).norm();
        break;
      }
    }
  }
  return detour;
}

std::optional<Vec3> FieldPilot::min_turned(const Vec3& way, Passing passing, double maximum) const {
  const bool level = is_level(passing);
  const int sign = passing == Passing::left || passing == Passing::above ? 1 : -1;
  constexpr int kClimbs = 4;
  for (int k = 1; k <= (level ? Fan::kHalf : kClimbs); ++k) {
    Vec3 turned = fan_.turned(way, sign * k);
    if (!level) {
      const double climb = sign * max_climb() * k / kClimbs;
      const double flat = std::hypot(way.x(), way.y());
      if (flat == 0 || sign * climb_of(way) >= sign * climb) {
        continue;
      }
      turned = Vec3(way.x(), way.y(), flat * std::tan(climb)).normalized() * way.norm();
    }
    // The shortest possible flight at such an offset; farther aside it is no shorter.
    if (const Vec3 on = turned / kParts; on.norm() + (way - on).norm() > maximum) {
      return std::nullopt;
    }
    if (const auto aside = free_way(here_, 0, turned, level)) {
      return aside;
    }
  }
  return std::nullopt;
}
}  // namespace apf
