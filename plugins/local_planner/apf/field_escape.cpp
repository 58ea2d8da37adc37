// SPDX-License-Identifier: Apache-2.0
#include "field_escape.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/check.hpp"

namespace apf {

Escape::Escape(const Request& request) : request_(request), seen_(std::size_t(1) << kTableBits) {
  known_.reserve(Outlook::kMaxMovers);
  const int up = request.level_m ? 0 : kCells;
  for (int x = kCells; x >= -kCells; --x) {
    for (int y = kCells; y >= -kCells; --y) {
      for (int z = up; z >= -up; --z) {
        const double level = std::hypot(x, y);
        if (level > 0 && std::hypot(level, z) <= kCells &&
            std::abs(z) <= level * std::tan(steepest())) {
          neighbours_.push_back({x, y, z});
        }
      }
    }
  }
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    const double angle = 2 * kPi * double(i) / double(headings_.size());
    headings_[i] = {std::cos(angle), std::sin(angle)};
  }
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
  next_look_s_ = here.time_s + kPause;
  if ((searched_ == 0 || searched_ == kSearches.size()) && learns(outlook)) {
    searched_ = 0;
  }
  looks_left_ = kMaxLooks;
  for (Outcome outcome = Outcome::none; outcome == Outcome::none && searched_ < kSearches.size();) {
    const Search& what = kSearches[searched_++];
    outcome = search(what);
    if (outcome == Outcome::found) {
      searched_ = 0;
      ends_safe_ = what.aim == Aim::safe;
      return true;
    }
  }
  return false;
}

bool Escape::learns(const Outlook& outlook) {
  const auto is_known = [&](const Mover& mover) {
    return std::any_of(known_.begin(), known_.end(), [&](const Mover& known) {
      return known.id == mover.id &&
             (known.velocity - mover.velocity).norm() <= kSameVelocity * speed_;
    });
  };
  const auto movers = outlook.movers();
  const bool same = outlook.revision() == revision_ && movers.size() == known_.size() &&
                    std::all_of(movers.begin(), movers.end(), is_known);
  known_.assign(movers.begin(), movers.end());
  revision_ = outlook.revision();
  return !same;
}

Escape::Outcome Escape::search(const Search& what) {
  step_s_ = std::max(2.0, 2 * horizon_s_ / kMaxLegs) * what.share;
  // Ways of two legs first: depth first, those that begin otherwise would come late.
  const Outcome outcome = look_on(what.aim, 0, 1);
  return outcome == Outcome::none ? look_on(what.aim, 2, kMaxLegs - 2) : outcome;
}

Escape::Outcome Escape::look_on(Aim aim, int from, int to) {
  std::fill(seen_.begin(), seen_.end(), 0);
  seen_count_ = 0;
  tried_[0] = {here_.at};
  size_tried_ = 1;
  while (size_tried_ > 0) {
    const int step = size_tried_ - 1;
    const int looks = step < from ? 0 : step == 0 ? kLooksHere : 1;
    if (looks > looks_left_) {
      return Outcome::unfinished;
    }
    looks_left_ -= looks;
    const auto end = looks > 1   ? straight(aim, 1, 4)
                     : looks > 0 ? straight(aim, 4, 2)
                                 : std::nullopt;
    if (end) {
      keep(*end);
      return Outcome::found;
    }
    while (size_tried_ > 0 && !(size_tried_ <= to && go_on())) {
      --size_tried_;
    }
  }
  return Outcome::none;
}

std::optional<Instant> Escape::straight(Aim aim, std::size_t every, int speeds) const {
  for (int part = speeds; part > 0; --part) {
    for (const double climb : {0.0, steepest(), -steepest()}) {
      const double level = speed_ * part / speeds * std::cos(climb);
      const double up = speed_ * part / speeds * std::sin(climb);
      for (std::size_t i = 0; i < headings_.size(); i += every) {
        const auto [cosine, sine] = headings_[i];
        const Vec3 velocity = level * (cosine * ahead_ + sine * aside_) + Vec3(0, 0, up);
        if (const auto end = straight_along(aim, velocity)) {
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

std::optional<Instant> Escape::straight_along(Aim aim, const Vec3& velocity) const {
  const Vec3& from = tried_[std::size_t(size_tried_ - 1)].at;
  const double after = seconds();
  if (aim == Aim::safe) {
    const auto lasts = outlook_->seconds_to_safety(from, after, velocity, kRoom, step_s_);
    return lasts ? std::optional(Instant{here_.time_s + after + *lasts, from + velocity * *lasts})
                 : std::nullopt;
  }
  const double left = horizon_s_ - after;
  const Vec3 end = from + velocity * left;
  return outlook_->seconds_to_contact(from, after, velocity, kRoom, left) > left &&
                 outlook_->is_open(from, end)
             ? std::optional(Instant{here_.time_s + horizon_s_, end})
             : std::nullopt;
}

bool Escape::go_on() {
  const double after = seconds();
  if (after + step_s_ >= horizon_s_) {
    return false;
  }
  Place& place = tried_[std::size_t(size_tried_ - 1)];
  const double side = speed_ * step_s_ / kCells;
  while (place.next < neighbours_.size()) {
    const Cell& by = neighbours_[place.next++];
    const Vec3 way = side * (by[0] * ahead_ + by[1] * aside_ + Vec3(0, 0, by[2]));
    const Place next{place.at + way,
                     {place.cell[0] + by[0], place.cell[1] + by[1], place.cell[2] + by[2]}};
    if (outlook_->seconds_to_contact(place.at, after, way / step_s_, kRoom, step_s_) > step_s_ &&
        is_new(next.cell) && leg_ok(std::nullopt, place.at, next.at, request_)) {
      tried_[std::size_t(size_tried_++)] = next;
      return true;
    }
  }
  return false;
}

bool Escape::is_new(const Cell& cell) {
  std::uint64_t key = std::uint64_t(size_tried_);
  for (const int along : cell) {
    key = key << 16 | std::uint16_t(along);
  }
  std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> (64 - kTableBits);
  while (seen_[slot] != 0 && seen_[slot] != key) {
    slot = (slot + 1) % seen_.size();
  }
  if (seen_[slot] == key || 2 * ++seen_count_ > seen_.size()) {
    return false;
  }
  seen_[slot] = key;
  return true;
}

void Escape::keep(const Instant& end) {
  for (size_ = 1; size_ < size_tried_; ++size_) {
    legs_[std::size_t(size_ - 1)] = {here_.time_s + size_ * step_s_, tried_[std::size_t(size_)].at};
  }
  legs_[std::size_t(size_ - 1)] = end;
}

void Escape::keep(const Instant& corner, const Instant& end, double speed) {
  legs_[0] = corner;
  legs_[1] = end;
  size_ = 2;
  speed_ = speed;
  ends_safe_ = true;
  searched_ = 0;
}

std::optional<Instant> Escape::next(const Outlook& outlook, const Instant& here, double max_s) {
  const auto end = legs_.begin() + size_;
  const auto leg = std::find_if(legs_.begin(), end, [&](const Instant& corner) {
    return corner.time_s > here.time_s + 1e-9;
  });
  Instant from = here;
  for (auto corner = leg; corner != end; ++corner) {
    const double lasts = corner->time_s - from.time_s;
    const Vec3 velocity = (corner->at - from.at) / lasts;
    if (velocity.norm() > speed_ * (1 + 1e-6) ||
        outlook.seconds_to_contact(from.at, from.time_s - here.time_s, velocity, 0) < lasts ||
        !outlook.is_open(from.at, corner->at)) {
      return std::nullopt;
    }
    from = *corner;
  }
  if (leg == end) {
    return std::nullopt;
  }
  ends_safe_ = ends_safe_ &&
               outlook.seconds_to_safety(from.at, from.time_s - here.time_s, Vec3(0, 0, 0), 0, 0)
                   .has_value();
  const double lasts = leg->time_s - here.time_s;
  const double share = std::min(1.0, max_s / lasts);
  return Instant{here.time_s + lasts * share, here.at + (leg->at - here.at) * share};
}
}  // namespace apf
