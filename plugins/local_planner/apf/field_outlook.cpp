// SPDX-License-Identifier: Apache-2.0
#include "field_outlook.hpp"

#include <algorithm>
#include <string_view>

#include "altiplan/world.hpp"

namespace apf {

void Outlook::see_movers(const Observation& seen, double speed) {
  speed_ = speed;
  if (seen.state.time_s > time_s_) {
    before_s_ = time_s_;
    count_before_ = count_;
    std::copy_n(movers_.begin(), count_, movers_before_.begin());
  }
  time_s_ = seen.state.time_s;
  const auto gap = [&](const Mover& mover) {
    return (mover.position - seen.state.position).norm() - mover.radius;
  };
  count_ = 0;
  for (const SensedObstacle& moving : seen.moving) {
    const std::size_t id = std::hash<std::string_view>()(moving.id);
    const Vec3 velocity = velocity_of(moving, id);
    const double pace = velocity.norm();
    const Mover mover{moving.position,
                      velocity,
                      moving.radius + std::max(required_, reach_),
                      id,
                      pace,
                      pace > 0 ? Vec3(velocity / pace) : velocity};
    if (count_ < kMaxMovers) {
      movers_[count_++] = mover;
    } else if (const auto farthest = std::max_element(
                   movers_.begin(), movers_.end(),
                   [&](const Mover& a, const Mover& b) { return gap(a) < gap(b); });
               gap(mover) < gap(*farthest)) {
      *farthest = mover;
    }
  }
}

void Outlook::see_world(const World& world, const Vec3& here) {
  world_ = &world;
  here_ = here;
  clearance_ = world.clearance(here);
  layers_size_ = 0;
  for (const Layer& layer : world.layers()) {
    if (layers_size_ < kMaxLayers) {
      const Environment& environment = *layer.environment;
      layers_[layers_size_++] = {&layer,
                                 environment.clearance(here) - environment.over_approximation()};
    }
  }
}

bool Outlook::is_blocked(const Vec3& a, const Vec3& b, double room) const {
  if (world_->layers().size() > kMaxLayers) {
    return world_->blocked(a, b, room);
  }
  const double reach = std::max((a - here_).norm(), (b - here_).norm()) + room;
  try {
    return std::any_of(
        layers_.begin(), layers_.begin() + std::ptrdiff_t(layers_size_), [&](const Near& near) {
          const Environment& environment = *near.layer->environment;
          return !(near.free_m >= reach) &&
                 environment.blocked(a, b, environment.ground() != nullptr ? required_ : room);
        });
  } catch (...) {
    return world_->blocked(a, b, room);  // which distinguishes the layers
  }
}

Vec3 Outlook::velocity_of(const SensedObstacle& moving, std::size_t id) const {
  if (moving.velocity) {
    return *moving.velocity;
  }
  const auto end = movers_before_.begin() + std::ptrdiff_t(count_before_);
  const auto was =
      std::find_if(movers_before_.begin(), end, [&](const Mover& mover) { return mover.id == id; });
  const double passed = time_s_ - before_s_;
  return was == end || !(passed > 0) ? Vec3(0, 0, 0)
                                     : Vec3((moving.position - was->position) / passed);
}

double Outlook::seconds_to_contact(const Vec3& from, double after_s, const Vec3& velocity,
                                   double room, double enough) const {
  double first = kInfinity;
  for (const Mover& mover : movers()) {
    const Vec3 r = from - mover.position - mover.velocity * after_s;
    const Vec3 w = velocity - mover.velocity;
    const double closing = -r.dot(w);
    if (closing <= 0) {
      continue;  // they move apart
    }
    const double core = mover.radius + room;
    const double apart = r.squaredNorm() - core * core;
    if (apart <= 0) {
      return 0;
    }
    const double root = closing * closing - w.squaredNorm() * apart;
    if (root > 0) {
      first = std::min(first, apart / (closing + std::sqrt(root)));
      if (first <= enough) {
        return first;
      }
    }
  }
  return first;
}

bool Outlook::is_open(const Vec3& a, const Vec3& b, double room) const {
  const auto& minimum = request_.limits.min_ground_clearance;
  return request_.volume.contains(b, kLengthTolerance) && world_->ground_below(a, b) &&
         !is_blocked(a, b, room) && (!minimum || world_->ground_gap(a, b, *minimum) >= *minimum);
}

std::optional<double> Outlook::seconds_to_safety(const Vec3& from, double after_s,
                                                 const Vec3& velocity, double room,
                                                 double min_s) const {
  const double meets = seconds_to_contact(from, after_s, velocity, room, min_s);
  std::array<Span, kMaxMovers> spans;
  std::size_t known = 0;
  double until = min_s;
  for (std::size_t i = 0; i < count_ && until < meets;) {
    if (i == known) {
      spans[known++] = seconds_in_the_way(movers_[i], from, after_s, velocity, room);
    }
    const Span& span = spans[i];
    const bool inside = span.begins <= until && until < span.ends;
    until = inside ? span.ends : until;
    i = inside ? 0 : i + 1;  // it may now block one examined earlier
  }
  return until < meets && is_open(from, from + velocity * until) ? std::optional(until)
                                                                 : std::nullopt;
}

Outlook::Span Outlook::seconds_in_the_way(const Mover& mover, const Vec3& from, double after_s,
                                          const Vec3& velocity, double room) const {
  const double pace = mover.pace;
  if (pace == 0) {
    return kNever;
  }
  const Vec3& onward = mover.onward;
  const Vec3 r = from - mover.position - mover.velocity * after_s;
  const double ahead = r.dot(onward);
  const double gains = velocity.dot(onward) - pace;
  if (ahead <= 0 && gains <= 0) {
    return kNever;  // behind it permanently
  }
  const Vec3 off = r - onward * ahead;
  const Vec3 aside = velocity - onward * velocity.dot(onward);
  const double core = mover.radius + room;
  const double a = aside.squaredNorm();
  const double b = off.dot(aside);
  const double outside = off.squaredNorm() - core * core;
  Span span{-kInfinity, kInfinity};
  if (a < 1e-12 * speed_ * speed_) {
    if (outside >= 0) {
      return kNever;
    }
  } else {
    const double root = b * b - a * outside;
    if (root <= 0) {
      return kNever;
    }
    const double half = std::sqrt(root);
    span = {(-b - half) / a, (-b + half) / a};
  }
  if (gains > 0) {
    span.begins = std::max(span.begins, -ahead / gains);
  } else if (gains < 0) {
    span.ends = std::min(span.ends, -ahead / gains);
  }
  return span;
}
}  // namespace apf
