// SPDX-License-Identifier: Apache-2.0
#include "host/gate/flown_places.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace altiplan::host {
namespace {

constexpr double kCoarse = 60;  // metres: radius

using Area = Eigen::AlignedBox<double, 2>;

/// The part of a strip's line in an area; nothing where it is outside.
std::optional<Strip> within(const Strip& strip, const Area& area) {
  const Eigen::Vector2d from = strip.from.head<2>();
  const Eigen::Vector2d way = strip.to.head<2>() - from;
  double begin = 0;
  double end = 1;
  for (const int axis : {0, 1}) {
    if (way[axis] != 0) {
      const double low = (area.min()[axis] - from[axis]) / way[axis];
      const double high = (area.max()[axis] - from[axis]) / way[axis];
      begin = std::max(begin, std::min(low, high));
      end = std::min(end, std::max(low, high));
    } else if (from[axis] < area.min()[axis] || from[axis] > area.max()[axis]) {
      return std::nullopt;
    }
  }
  if (begin > end) {
    return std::nullopt;
  }
  Strip part = strip;
  part.from = strip.from + begin * (strip.to - strip.from);
  part.to = strip.from + end * (strip.to - strip.from);
  part.from_high_m = strip.from_high_m + begin * (strip.to_high_m - strip.from_high_m);
  part.to_high_m = strip.from_high_m + end * (strip.to_high_m - strip.from_high_m);
  return part;
}

/// What strips fly of an area.
struct FlownArea {
  Area area;
  double low_m = kInfinity;
  double high_m = -kInfinity;
  double reach_m = 0;
  std::vector<const Strip*> strips;

  FlownArea(std::span<const Strip* const> all, const Area& whole) {
    for (const Strip* strip : all) {
      const Eigen::Vector2d reach(strip->reach_m, strip->reach_m);
      if (const auto part = within(*strip, Area(whole.min() - reach, whole.max() + reach))) {
        for (const Vec3& end : {part->from, part->to}) {
          area.extend(Area(end.head<2>() - reach, end.head<2>() + reach));
        }
        low_m = std::min({low_m, part->from.z(), part->to.z()});
        high_m = std::max({high_m, part->from_high_m, part->to_high_m});
        reach_m = std::max(reach_m, strip->reach_m);
        strips.push_back(strip);
      }
    }
    area = area.intersection(whole);
  }
};

void judge_area(std::span<const Strip* const> strips, const Area& whole, double finest_m,
                const FlownPlaces::Judge& is_valid, const FlownPlaces::Refuse& refuse) {
  const FlownArea flown(strips, whole);
  if (flown.strips.empty()) {
    return;
  }
  const Area& area = flown.area;
  const Whereabouts place{area.center(), area.diagonal().norm() / 2, flown.low_m, flown.high_m};
  if (place.radius_m <= kCoarse && is_valid(place)) {
    return;
  }
  if (place.radius_m > finest_m / 2 + flown.reach_m) {
    const int axis = area.sizes().x() > area.sizes().y() ? 0 : 1;
    Area first = area;
    Area second = area;
    first.max()[axis] = second.min()[axis] = area.center()[axis];
    judge_area(flown.strips, first, finest_m, is_valid, refuse);
    judge_area(flown.strips, second, finest_m, is_valid, refuse);
  } else if (place.radius_m <= kCoarse || !is_valid(place)) {
    refuse(place);
  }
}

/// The middle of a time that has no end is its beginning.
double middle(const TimeSpan& time) {
  return std::isfinite(time.max_s) ? (time.min_s + time.max_s) / 2 : time.min_s;
}
}  // namespace

FlownPlaces::FlownPlaces(const FlownPart& part, std::array<double, 2> time_s,
                         double before_latest_s, const Eigen::Vector2d& to)
    : part_(&part),
      time_s_(time_s),
      before_latest_s_(before_latest_s),
      from_(part.strips.front().from.head<2>()),
      to_(to) {
  for (const Strip& strip : part.strips) {
    waits_within_m_ = std::max(waits_within_m_, part.held_s > 0 ? strip.reach_m : 0);
  }
}

void FlownPlaces::judge(double finest_m, const Judge& is_valid, const Refuse& refuse) const {
  std::vector<const Strip*> strips;
  for (const Strip& strip : part_->strips) {
    strips.push_back(&strip);
  }
  const Eigen::Vector2d far(kInfinity, kInfinity);
  judge_area(strips, Area(-far, far), finest_m, is_valid, refuse);
}

double FlownPlaces::share_of(const Whereabouts& place, double beyond_m, double unknown) const {
  const Eigen::Vector2d way = to_ - from_;
  if (way.norm() < 1 || !part_->what.empty()) {
    return unknown;
  }
  return std::clamp(((place.at - from_).dot(way) / way.norm() + beyond_m) / way.norm(), 0.0, 1.0);
}

std::array<double, 2> FlownPlaces::times_of(const Whereabouts& place, double length_m) const {
  const double arrived_s = std::max(time_s_[1] - part_->held_s, time_s_[0]);
  const auto at = [&](double share) { return time_s_[0] + share * (arrived_s - time_s_[0]); };
  const bool waits = share_of(place, length_m / 2 + waits_within_m_, 1) == 1;
  return {at(share_of(place, -length_m / 2, 0)),
          waits ? time_s_[1] : at(share_of(place, length_m / 2, 1))};
}

double FlownPlaces::latest_s(const Whereabouts& place) const {
  // A part that is flown again counts as it is at its last end.
  const double latest_s = std::max(part_->time.max_s, part_->until_s);
  const double share =
      part_->until_s > 0 ? 1 : share_of(place, place.radius_m + waits_within_m_, 1);
  return share < 1 ? before_latest_s_ + share * (latest_s - part_->held_s - before_latest_s_)
                   : latest_s;
}

std::vector<FlownPlaces> flown_places_of(const FlownMission& mission,
                                         const formats::MissionFile& plan, const Frame& frame) {
  std::vector<FlownPlaces> places;
  double begin_s = 0;
  double latest_s = 0;
  for (const FlownPart& part : mission.parts) {
    const double end_s = std::max(middle(part.time), begin_s);
    if (!part.strips.empty()) {
      Eigen::Vector2d to = part.strips.back().to.head<2>();
      if (const formats::MissionCommand& command = plan.commands[part.command];
          command.has_position()) {
        const auto [x, y] = frame.to_local(command.lon, command.lat);
        to = {x, y};
      }
      places.emplace_back(part, std::array{begin_s, end_s}, latest_s, to);
    }
    begin_s = end_s;
    latest_s = part.time.max_s;
  }
  return places;
}
}  // namespace altiplan::host
