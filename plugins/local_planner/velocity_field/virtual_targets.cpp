// SPDX-License-Identifier: Apache-2.0
#include "virtual_targets.hpp"

#include <algorithm>

namespace velocity_field {

bool is_in_wedge(const Vec2& p, const Vec2& target, const Vec2& a, const Vec2& b) {
  const Vec2 to_p = p - target;
  const double turn = cross(a - target, b - target);
  const double after_a = cross(a - target, to_p);
  const double before_b = cross(to_p, b - target);
  return turn >= 0 ? after_a >= 0 && before_b >= 0 : after_a <= 0 && before_b <= 0;
}

bool is_beyond_chord(const Vec2& p, const Vec2& target, const Vec2& a, const Vec2& b) {
  return cross(b - a, p - a) * cross(b - a, target - a) < 0;
}

void VirtualTargets::reset(const Threats& threats) {
  const std::size_t count = threats.all().size();
  active_.reset();
  near_.reserve(count);
  was_used_.assign(count, 0);
  in_pair_.assign(count, 0);
  potential_ = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    in_pair_[i] = threats.has_partner(i);
    potential_ += in_pair_[i];
  }
}

Vec2 VirtualTargets::place(const Disc& threat, const Vec2& target) const {
  const Vec2 way = threat.centre - target;
  const double distance = way.norm();
  return distance > 0 ? Vec2(target + (1 + (threat.radius + balance_) / distance) * way) : target;
}

Vec2 VirtualTargets::aim(const Threats& threats, const Vec2& target, const Vec2& here,
                         const Vec2& heading, const std::vector<std::uint32_t>& inside) {
  const std::vector<Disc>& discs = threats.all();
  if (active_ && (!is_in_wedge(here, target, discs[*active_].centre, discs[other_].centre) ||
                  (place(discs[*active_], target) - here).norm() <= release_)) {
    active_.reset();
  }
  if (const auto pair = choose(threats, target, here, heading, inside)) {
    if (active_ != pair->threat) {
      activate(threats, *pair, place(discs[pair->threat], target));
    }
  }
  return active_ ? place(discs[*active_], target) : target;
}

void VirtualTargets::find_traps(const Threats& threats, const Vec2& target, const Vec2& here,
                                const std::vector<std::uint32_t>& inside) {
  const std::vector<Disc>& discs = threats.all();
  near_.clear();
  for (const std::uint32_t i : inside) {
    if (in_pair_[i] != 0) {
      near_.push_back({i, cross(discs[i].centre - target, here - target), 0, false});
    }
  }
  for (std::size_t n = 1; n < near_.size(); ++n) {
    for (std::size_t m = 0; m < n; ++m) {
      Near& a = near_[m];
      Near& b = near_[n];
      if (a.side * b.side > 0) {
        continue;  // on one side of both rays: not between them
      }
      const Vec2& at = discs[a.threat].centre;
      const Vec2& bt = discs[b.threat].centre;
      if (threats.overlap(a.threat, b.threat) && is_in_wedge(here, target, at, bt) &&
          is_beyond_chord(here, target, at, bt)) {
        a.other = a.traps ? a.other : b.threat;
        b.other = b.traps ? b.other : a.threat;
        a.traps = b.traps = true;
      }
    }
  }
}

std::optional<VirtualTargets::Pair> VirtualTargets::choose(
    const Threats& threats, const Vec2& target, const Vec2& here, const Vec2& heading,
    const std::vector<std::uint32_t>& inside) {
  find_traps(threats, target, here, inside);
  std::optional<Pair> best;
  double closest = -2;
  for (const Near& near : near_) {
    if (!near.traps) {
      continue;
    }
    const Vec2 way = place(threats.all()[near.threat], target) - here;
    const double along = heading.dot(way.normalized());
    if (along > closest) {
      closest = along;
      best = Pair{near.threat, near.other};
    }
  }
  return best;
}

void VirtualTargets::activate(const Threats& threats, const Pair& pair, const Vec2& place) {
  active_ = pair.threat;
  other_ = pair.other;
  ++entries_;
  used_ += was_used_[pair.threat] == 0;
  was_used_[pair.threat] = 1;
  const auto near = threats.near(place);
  inside_another_ = std::any_of(near.begin(), near.end(), [&](std::uint32_t i) {
    const Disc& disc = threats.all()[i];
    return i != pair.threat && (disc.centre - place).norm() < disc.radius;
  });
  inside_threats_ += inside_another_;
}
}  // namespace velocity_field
