// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/world.hpp"

namespace altiplan::kit {

/// Cache of the ground below the steps of a lattice. Steps above each other share the ground below,
/// and the height above ground of one gives that of the others: one query to the world answers for
/// many of them.
class StepGround {
 public:
  StepGround(const Lattice& lattice, const World& world)
      : lattice_(lattice),
        world_(world),
        columns_east_(std::size_t(lattice.spec().counts[0])),
        pages_(columns_east_ * std::size_t(lattice.spec().counts[1]) / kColumns + 1) {
    for (const Layer& layer : world.layers()) {
      if (const Ground* ground = layer.environment->ground()) {
        // Two grounds may meet in a vertical step, which no slope bounds.
        only_ground_ = has_ground_ ? nullptr : ground;
        has_ground_ = true;
      }
    }
  }

  /// Bounds of the highest ground below a step, metres above sea; both kNone where part of it has
  /// no ground.
  struct Top {
    float least = kUnknown;
    float most = kNone;
  };

  /// Height of the ground below the cell's centre, or less by rounding; kNone: there is none.
  float height(const Cell& c) { return column(c[0], c[1]).height; }

  /// Bounds below the step from c in direction d.
  Top& below(const Cell& c, int d) {
    // A step shares the ground of its reverse, and its height does not matter: of the nine
    // horizontal components of d five remain, the last of them vertical.
    const int flat = d % 9;
    const int east = c[0] + flat % 3 - 1;
    const int north = c[1] + flat / 3 - 1;
    const bool back = flat > 4;
    Column& from = back ? column(east, north) : column(c[0], c[1]);
    Top& top = from.tops[std::size_t(back ? 8 - flat : flat)];
    if (top.least == kUnknown) {
      const Column& to = back ? column(c[0], c[1]) : column(east, north);
      begin(top, from, to, std::hypot(lattice_.step(d).x(), lattice_.step(d).y()));
    }
    return top;
  }

  /// Records that a leg over that ground keeps `gap` above it, or more unless `exact`. `low` and
  /// `high` are the heights of its ends.
  static void learn(Top& top, double low, double high, double gap, bool exact) {
    if (gap == -kInfinity) {
      top = {kNone, kNone};
      return;
    }
    // The ground is nowhere higher than the leg minus the gap, and somewhere that high.
    top.most = std::min(top.most, std::nextafterf(float(high - gap), kNone));
    if (exact) {
      top.least = std::max(top.least, std::nextafterf(float(low - gap), -kNone));
    }
  }

  static constexpr float kNone = std::numeric_limits<float>::infinity();

 private:
  static constexpr float kUnknown = -kNone;
  static constexpr std::size_t kColumns = 64;
  struct Column {
    float height = kUnknown;
    float slope = kNone;  ///< no ground within a cell's edges is steeper
    std::array<Top, 5> tops;
  };
  using Page = std::array<Column, kColumns>;

  Column& column(int east, int north) {
    const std::size_t at = std::size_t(north) * columns_east_ + std::size_t(east);
    std::unique_ptr<Page>& page = pages_[at / kColumns];
    if (page == nullptr) {
      page = std::make_unique<Page>();
    }
    Column& column = (*page)[at % kColumns];
    if (column.height == kUnknown) {
      ask(column, lattice_.spec().centre({east, north, 0}));
    }
    return column;
  }

  void ask(Column& column, const Vec3& at) const {
    const auto ground = world_.ground(at.x(), at.y());
    column.height = ground        ? std::nextafterf(float(*ground), kUnknown)
                    : has_ground_ ? kNone
                                  : std::numeric_limits<float>::lowest();
    if (only_ground_ != nullptr) {
      const Vec3 reach(lattice_.spec().cell.x(), lattice_.spec().cell.y(), kInfinity);
      column.slope = float(only_ground_->slope({at - reach, at + reach}));
    }
  }

  /// Bounds from the ground heights at both ends and the slope limit.
  static void begin(Top& top, const Column& from, const Column& to, double run) {
    top.least = std::max(from.height, to.height);
    const double slope = std::min(from.slope, to.slope);
    if (top.least < kNone && slope < kNone) {
      constexpr double kRounding = 0.002;  // of heights and slopes stored in four bytes, in metres
      const double middle = (double(from.height) + to.height + slope * run) / 2;
      top.most = float(std::max(double(top.least), middle) * (1 + 1e-6) + kRounding);
    }
  }

  const Lattice& lattice_;
  const World& world_;
  std::size_t columns_east_;
  std::vector<std::unique_ptr<Page>> pages_;
  const Ground* only_ground_ = nullptr;
  bool has_ground_ = false;
};
}  // namespace altiplan::kit
