// SPDX-License-Identifier: Apache-2.0
#include "host/gate/flown_places.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

constexpr double kCoarse = 60;  // metres: radius

/// The smallest disc about the middle of the strips' box, with their reach.
Whereabouts around(std::span<const Strip> strips) {
  Eigen::Vector2d minimum(kInfinity, kInfinity);
  Eigen::Vector2d maximum = -minimum;
  double reach = 0;
  Whereabouts place{{0, 0}, 0, kInfinity, -kInfinity};
  for (const Strip& strip : strips) {
    for (const Vec3& end : {strip.from, strip.to}) {
      minimum = minimum.cwiseMin(end.head<2>());
      maximum = maximum.cwiseMax(end.head<2>());
    }
    reach = std::max(reach, strip.reach_m);
    place.low_m = std::min({place.low_m, strip.from.z(), strip.to.z()});
    place.high_m = std::max({place.high_m, strip.from_high_m, strip.to_high_m});
  }
  place.at = (minimum + maximum) / 2;
  place.radius_m = (maximum - minimum).norm() / 2 + reach;
  return place;
}

std::array<Strip, 2> halves(const Strip& strip) {
  Strip first = strip;
  Strip second = strip;
  first.to = second.from = (strip.from + strip.to) / 2;
  first.to_high_m = second.from_high_m = (strip.from_high_m + strip.to_high_m) / 2;
  return {first, second};
}

void judge_strips(std::span<const Strip> strips, double finest_m,
                  const FlownPlaces::Judge& is_valid, const FlownPlaces::Refuse& refuse) {
  const Whereabouts place = around(strips);
  if (place.radius_m <= kCoarse && is_valid(place)) {
    return;
  }
  if (strips.size() > 1) {
    judge_strips(strips.first(strips.size() / 2), finest_m, is_valid, refuse);
    judge_strips(strips.subspan(strips.size() / 2), finest_m, is_valid, refuse);
  } else if ((strips.front().to - strips.front().from).head<2>().norm() > finest_m) {
    for (const Strip& half : halves(strips.front())) {
      judge_strips(std::span(&half, 1), finest_m, is_valid, refuse);
    }
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
      to_(to) {}

void FlownPlaces::judge(double finest_m, const Judge& is_valid, const Refuse& refuse) const {
  judge_strips(part_->strips, finest_m, is_valid, refuse);
}

double FlownPlaces::share_of(const Whereabouts& place, double beyond_m, double unknown) const {
  const Eigen::Vector2d way = to_ - from_;
  if (way.norm() < 1 || !part_->what.empty()) {
    return unknown;
  }
  return std::clamp(((place.at - from_).dot(way) / way.norm() + beyond_m) / way.norm(), 0.0, 1.0);
}

std::array<double, 2> FlownPlaces::times_of(const Whereabouts& place, double length_m) const {
  const auto at = [&](double share) { return time_s_[0] + share * (time_s_[1] - time_s_[0]); };
  return {at(share_of(place, -length_m / 2, 0)), at(share_of(place, length_m / 2, 1))};
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
