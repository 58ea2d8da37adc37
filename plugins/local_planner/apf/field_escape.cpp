// SPDX-License-Identifier: Apache-2.0
#include "field_escape.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/check.hpp"

namespace apf {

Escape::Escape(const Request& request) : request_(request), seen_(kTable) {
  places_.reserve(kMostPlaces);
  open_.reserve(kMostPlaces);
}

bool Escape::find(const Outlook& outlook, const Instant& here, double speed, const Vec3& ahead,
                  const Vec3& aside) {
  outlook_ = &outlook;
  ahead_ = ahead;
  aside_ = aside;
  here_ = here;
  speed_ = speed;
  // As long as what the sensor shows could take to meet the vehicle twice over.
  double farthest = speed * outlook.reaction_s();
  for (const Mover& mover : outlook.movers()) {
    farthest = std::max(farthest, (mover.position - here.at).norm() + mover.radius);
  }
  horizon_s_ = 2 * std::min(farthest, request_.vehicle.sensing_m) / speed;
  const double coarse = std::max(2.0, 2 * horizon_s_ / kMostLegs);
  ends_safe_ = false;
  for (int parts = 4; parts >= 1 && !ends_safe_; parts /= 2) {
    step_s_ = coarse * parts / 4;
    ends_safe_ = search(Aim::safe);
  }
  next_look_s_ = here.time_s + (ends_safe_ ? 0 : kPause);
  if (ends_safe_) {
    return true;
  }
  step_s_ = coarse;
  return search(Aim::lasting);
}

bool Escape::search(Aim aim) {
  places_.clear();
  open_.clear();
  std::fill(seen_.begin(), seen_.end(), 0);
  seen_count_ = 0;
  places_.push_back({here_.at});
  if (const auto end = straight(places_[0], aim, 192, 4)) {
    keep(0, *end);
    return true;
  }
  push_neighbours(0);
  while (!open_.empty()) {
    const int index = open_.back();
    open_.pop_back();
    if (const auto end = straight(places_[std::size_t(index)], aim, 48, 2)) {
      keep(index, *end);
      return true;
    }
    push_neighbours(index);
  }
  return false;
}

std::optional<Instant> Escape::straight(const Place& place, Aim aim, int headings,
                                        int speeds) const {
  for (int part = speeds; part > 0; --part) {
    for (const double climb : {0.0, steepest(), -steepest()}) {
      const double level = speed_ * part / speeds * std::cos(climb);
      const double up = speed_ * part / speeds * std::sin(climb);
      for (int i = 0; i < headings; ++i) {
        const double angle = 2 * kPi * i / headings;
        const Vec3 velocity =
            level * (std::cos(angle) * ahead_ + std::sin(angle) * aside_) + Vec3(0, 0, up);
        if (const auto end = straight_along(place, aim, velocity)) {
          return end;
        }
      }
      if (steepest() == 0) {
        break;
      }
    }
  }
  return std::nullopt;
}

std::optional<Instant> Escape::straight_along(const Place& place, Aim aim,
                                              const Vec3& velocity) const {
  const double after = seconds_to(place);
  if (aim == Aim::safe) {
    const auto lasts = outlook_->escape_s(place.at, after, velocity, kRoom, step_s_);
    return lasts
               ? std::optional(Instant{here_.time_s + after + *lasts, place.at + velocity * *lasts})
               : std::nullopt;
  }
  const double left = horizon_s_ - after;
  const Vec3 end = place.at + velocity * left;
  return outlook_->contact(place.at, after, velocity, kRoom) > left &&
                 outlook_->is_open(place.at, end)
             ? std::optional(Instant{here_.time_s + horizon_s_, end})
             : std::nullopt;
}

void Escape::push_neighbours(int index) {
  const Place place = places_[std::size_t(index)];
  const double after = seconds_to(place);
  if (after + step_s_ >= horizon_s_ || place.step + 2 >= kMostLegs) {
    return;
  }
  const double cell = speed_ * step_s_ / kCells;
  const int up = request_.level_m ? 0 : kCells;
  for (int x = -kCells; x <= kCells; ++x) {
    for (int y = -kCells; y <= kCells; ++y) {
      for (int z = -up; z <= up; ++z) {
        const double level = std::hypot(x, y);
        if (std::hypot(level, z) > kCells || std::abs(z) > level * std::tan(steepest()) ||
            (x == 0 && y == 0) || std::int64_t(places_.size()) == kMostPlaces) {
          continue;
        }
        const Vec3 way = cell * (x * ahead_ + y * aside_ + Vec3(0, 0, z));
        Place next{place.at + way, place.cell, std::int16_t(place.step + 1), index};
        next.cell[0] = std::int16_t(next.cell[0] + x);
        next.cell[1] = std::int16_t(next.cell[1] + y);
        next.cell[2] = std::int16_t(next.cell[2] + z);
        if (outlook_->contact(place.at, after, way / step_s_, kRoom) > step_s_ && is_new(next) &&
            leg_ok(std::nullopt, place.at, next.at, request_)) {
          open_.push_back(int(places_.size()));
          places_.push_back(next);
        }
      }
    }
  }
}

bool Escape::is_new(const Place& place) {
  std::uint64_t key = std::uint64_t(place.step);
  for (const std::int16_t cell : place.cell) {
    key = key << 16 | std::uint16_t(cell);
  }
  ++key;  // 0 stands for an empty slot
  std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> 51;
  while (seen_[slot] != 0 && seen_[slot] != key) {
    slot = (slot + 1) % kTable;
  }
  if (seen_[slot] == key || 2 * ++seen_count_ > kTable) {
    return false;
  }
  seen_[slot] = key;
  return true;
}

void Escape::keep(int index, const Instant& end) {
  size_ = 0;
  legs_[std::size_t(size_++)] = end;
  for (; index > 0; index = places_[std::size_t(index)].before) {
    const Place& place = places_[std::size_t(index)];
    legs_[std::size_t(size_++)] = {here_.time_s + seconds_to(place), place.at};
  }
  std::reverse(legs_.begin(), legs_.begin() + size_);
}

void Escape::keep(const Instant& corner, const Instant& end, double speed) {
  legs_[0] = corner;
  legs_[1] = end;
  size_ = 2;
  speed_ = speed;
  ends_safe_ = true;
}

std::optional<Instant> Escape::next(const Outlook& outlook, const Instant& here, double most_s) {
  const auto end = legs_.begin() + size_;
  const auto leg = std::find_if(legs_.begin(), end, [&](const Instant& corner) {
    return corner.time_s > here.time_s + 1e-9;
  });
  Instant from = here;
  for (auto corner = leg; corner != end; ++corner) {
    const double lasts = corner->time_s - from.time_s;
    const Vec3 velocity = (corner->at - from.at) / lasts;
    if (velocity.norm() > speed_ * (1 + 1e-6) ||
        outlook.contact(from.at, from.time_s - here.time_s, velocity, 0) < lasts ||
        !outlook.is_open(from.at, corner->at)) {
      return std::nullopt;
    }
    from = *corner;
  }
  if (leg == end) {
    return std::nullopt;
  }
  ends_safe_ =
      ends_safe_ &&
      outlook.escape_s(from.at, from.time_s - here.time_s, Vec3(0, 0, 0), 0, 0).has_value();
  const double lasts = leg->time_s - here.time_s;
  const double share = std::min(1.0, most_s / lasts);
  return Instant{here.time_s + lasts * share, here.at + (leg->at - here.at) * share};
}
}  // namespace apf
