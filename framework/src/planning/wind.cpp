// SPDX-License-Identifier: Apache-2.0
#include "altiplan/wind.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan {

WindGrid::WindGrid(std::array<double, 2> south_west, std::array<double, 2> step,
                   std::array<int, 2> counts, std::vector<std::array<float, 2>> velocities)
    : south_west_(south_west), step_(step), counts_(counts), velocities_(std::move(velocities)) {
  for (const auto& [east, north] : velocities_) {
    max_speed_ = std::max(max_speed_, std::hypot(double(east), double(north)));
  }
}

Vec3 WindGrid::at(const Vec3& p) const {
  const auto cell = [&](std::size_t axis) {
    const double n = std::floor((p[Eigen::Index(axis)] - south_west_[axis]) / step_[axis]);
    return std::size_t(std::clamp(n, 0.0, double(counts_[axis] - 1)));
  };
  const auto& [east, north] = velocities_[cell(1) * std::size_t(counts_[0]) + cell(0)];
  return {east, north, 0};
}

std::vector<double> WindGrid::borders(std::size_t axis, double from, double to) const {
  const auto [low, high] = std::minmax(from, to);
  const auto near = [&](double at) { return std::floor((at - south_west_[axis]) / step_[axis]); };
  std::vector<double> found;
  for (double n = std::max(1.0, near(low)); n <= std::min(counts_[axis] - 1.0, near(high) + 1);
       ++n) {
    const double border = south_west_[axis] + n * step_[axis];
    if (border > low && border < high) {
      found.push_back(border);
    }
  }
  return found;
}

double Wind::Layer::max_speed() const { return grid ? grid->max_speed() : velocity.norm(); }

Vec3 Wind::at(const Vec3& p) const {
  const Layer* in_force = nullptr;
  for (const Layer& layer : layers) {
    if (p.z() >= layer.above_m) {
      in_force = &layer;
    }
  }
  if (in_force == nullptr) {
    return {0, 0, 0};
  }
  return in_force->grid ? in_force->grid->at(p) : in_force->velocity;
}

double Wind::max_speed() const {
  double speed = 0;
  const auto take = [&](const std::vector<Layer>& some) {
    for (const Layer& layer : some) {
      speed = std::max(speed, layer.max_speed());
    }
  };
  take(layers);
  for (const Change& change : changes) {
    take(change.layers);
  }
  return speed;
}

Wind Wind::in_force(double time_s) const {
  Wind wind{layers, {}};
  for (const Change& change : changes) {
    if (change.from_s <= time_s + kTimeTolerance) {
      wind.layers = change.layers;
    }
  }
  return wind;
}

double Wind::in_force_until(double time_s) const {
  for (const Change& change : changes) {
    if (change.from_s > time_s + kTimeTolerance) {
      return change.from_s;
    }
  }
  return kInfinity;
}

std::vector<double> Wind::crossings(const Vec3& from, const Vec3& to) const {
  std::vector<double> shares;
  const auto add = [&](Eigen::Index axis, double border) {
    const double share = (border - from[axis]) / (to[axis] - from[axis]);
    if (share > 0 && share < 1) {
      shares.push_back(share);
    }
  };
  for (const Layer& layer : layers) {
    add(2, layer.above_m);
    for (const std::size_t axis : {0U, 1U}) {
      const auto at = Eigen::Index(axis);
      if (layer.grid) {
        for (const double border : layer.grid->borders(axis, from[at], to[at])) {
          add(at, border);
        }
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

bool Wind::is_uniform(const Box& box) const {
  bool is_uniform = true;
  double top = kInfinity;
  for (auto layer = layers.rbegin(); layer != layers.rend(); top = (layer++)->above_m) {
    is_uniform &= !(layer->above_m > box.min.z() && layer->above_m < box.max.z());
    const bool is_in_force =
        (layer->above_m < box.max.z() || layer->above_m == box.min.z()) && box.min.z() < top;
    for (const std::size_t axis : {0U, 1U}) {
      const auto at = Eigen::Index(axis);
      if (layer->grid && is_in_force) {
        is_uniform &= layer->grid->borders(axis, box.min[at], box.max[at]).empty();
      }
    }
  }
  return is_uniform;
}

std::optional<double> ground_speed(const Vec3& course, double airspeed, const Vec3& wind) {
  const double run = course.head<2>().norm();
  const double along = (wind.x() * course.x() + wind.y() * course.y()) / run;
  const double across = (wind.y() * course.x() - wind.x() * course.y()) / run;
  if (!(std::abs(across) <= airspeed)) {
    return std::nullopt;
  }
  const double speed = along + std::sqrt(airspeed * airspeed - across * across);
  return speed > 0 ? std::optional(speed) : std::nullopt;
}

std::optional<double> heading_on(const Vec3& course, double airspeed, const Vec3& wind) {
  const Vec3 along = Vec3(course.x(), course.y(), 0).normalized();
  const std::optional<double> speed = ground_speed(along, airspeed, wind);
  if (!speed) {
    return std::nullopt;
  }
  const Vec3 through_air = *speed * along - wind;
  return std::atan2(through_air.y(), through_air.x());
}

double flight_time(const Vec3& from, const Vec3& to, double airspeed, const Wind& wind) {
  const Vec3 leg = to - from;
  if (!has_heading(leg)) {
    return leg.norm() / airspeed;
  }
  double time = 0;
  double begin = 0;
  std::vector<double> ends = wind.crossings(from, to);
  ends.push_back(1);
  for (const double end : ends) {
    const Vec3 middle = from + (begin + end) / 2 * leg;
    const std::optional<double> speed = ground_speed(leg, airspeed, wind.at(middle));
    time += speed ? (end - begin) * leg.head<2>().norm() / *speed : kInfinity;
    begin = end;
  }
  return time;
}
}  // namespace altiplan
