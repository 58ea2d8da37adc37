// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/clearance_steps.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::kit {
namespace {

float rounded_down(double value) {
  return std::nextafterf(float(value), -std::numeric_limits<float>::infinity());
}
}  // namespace

ClearanceSteps::ClearanceSteps(const Lattice& lattice, const World& obstacles, double needed)
    : lattice_(lattice),
      obstacles_(obstacles),
      needed_(needed),
      spare_(needed + obstacles.over_approximation() + kLengthTolerance),
      around_(spare_ + lattice.step(direction(1, 1, lattice.spec().counts[2] > 1)).norm()) {
  const auto blocks = [&](int axis) {
    return std::size_t((lattice.spec().counts[std::size_t(axis)] + kEdge - 1) / kEdge);
  };
  blocks_east_ = blocks(0);
  blocks_north_ = blocks(1);
  slots_.reset(blocks_east_ * blocks_north_ * blocks(2));
}

std::uint32_t ClearanceSteps::look_at(const Cell& c, std::size_t block) {
  const bool is_level = lattice_.spec().counts[2] == 1;
  const auto first = [](int index) { return index / kEdge * kEdge; };
  const Vec3 corner = lattice_.position({first(c[0]), first(c[1]), is_level ? 0 : first(c[2])});
  const Vec3 diagonal = (kEdge - 1) / 2.0 * lattice_.step(direction(1, 1, is_level ? 0 : 1));
  const bool is_far = obstacles_.clearance(corner + diagonal) > diagonal.norm() + around_;
  if (!is_far) {
    blocks_.push_back(std::make_unique<Block>());
    blocks_.back()->clearance.fill(kUnknown);
  }
  return slots_.at(block) = is_far ? kFar : std::uint32_t(blocks_.size()) + 1;
}

double ClearanceSteps::clearance(const Cell& c) {
  if (is_far(c)) {
    return around_;
  }
  Block& block = *blocks_[slots_[block_of(c)] - 2];
  const auto within = [](int index) { return std::size_t(index % kEdge); };
  float& known = block.clearance[(within(c[2]) * kEdge + within(c[1])) * kEdge + within(c[0])];
  if (known == kUnknown) {
    known = std::max(rounded_down(obstacles_.clearance(lattice_.position(c))),
                     std::numeric_limits<float>::lowest());
  }
  return known;
}

DirectionMask ClearanceSteps::near(const Cell& c, DirectionMask wanted) {
  const double here = clearance(c);
  if (here > around_) {
    return wanted;
  }
  DirectionMask kept = 0;
  for (DirectionMask left = wanted; left != 0; left &= left - 1) {
    const int d = __builtin_ctz(left);
    // Two balls of half the leg around its ends contain all of it.
    const double half = spare_ + lattice_.step_length(d) / 2;
    const Cell o = offset(d);
    const Cell to = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
    bool is_free = here > half && clearance(to) > half;
    if (!is_free) {
      const Vec3 a = lattice_.position(c);
      const Layer* layer = obstacles_.blocked_by(a, a + lattice_.step(d), needed_);
      is_free = layer == nullptr;
      if (!is_free) {
        layer_ = layer->id;
      }
    }
    kept |= DirectionMask(is_free) << d;
  }
  return kept;
}
}  // namespace altiplan::kit
