// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "altiplan/kit/lattice/lattice.hpp"

/// \file Steps of a lattice with the heading that persists through them. A step is numbered as its
/// direction; a vertical one, where the vehicle has a heading, by direction and heading, so that
/// the steps that may follow depend on the step alone.
namespace altiplan::kit {

using StepMask = std::uint64_t;
inline constexpr int kHeadings = 8;
inline constexpr int kSteps = kDirections + 2 * kHeadings;
inline constexpr int kDown = direction(0, 0, -1);
inline constexpr int kUp = direction(0, 0, 1);

constexpr bool is_upright(int direction) { return direction == kDown || direction == kUp; }
constexpr int direction_of(int step) {
  return step < kDirections ? step : step < kDirections + kHeadings ? kDown : kUp;
}
/// Number of the heading at the end of a step; -1 where the vehicle has none by its steps.
constexpr int heading_of(int step) {
  if (step >= kDirections) {
    return (step - kDirections) % kHeadings;
  }
  const int level = step % 9;
  return level == 4 ? -1 : level < 4 ? level : level - 1;
}
constexpr Cell heading_offset(int heading) {
  const int level = heading < 4 ? heading : heading + 1;
  return {level % 3 - 1, level / 3 - 1, 0};
}
/// The step in direction d of a vehicle that arrives by the step `in`.
constexpr int step_after(int in, int d) {
  const int heading = heading_of(in);
  return is_upright(d) && heading >= 0 ? kDirections + (d == kUp ? kHeadings : 0) + heading : d;
}
/// All steps in the directions.
constexpr StepMask steps_in(DirectionMask directions) {
  constexpr StepMask kEveryHeading = (StepMask{1} << kHeadings) - 1;
  return directions | ((directions >> kDown & 1) != 0 ? kEveryHeading << kDirections : 0) |
         ((directions >> kUp & 1) != 0 ? kEveryHeading << (kDirections + kHeadings) : 0);
}
/// The directions of the steps.
constexpr DirectionMask directions_of(StepMask steps) {
  constexpr StepMask kEveryHeading = (StepMask{1} << kHeadings) - 1;
  return DirectionMask(steps & ((StepMask{1} << kDirections) - 1)) |
         ((steps >> kDirections & kEveryHeading) != 0 ? DirectionMask{1} << kDown : 0) |
         ((steps >> (kDirections + kHeadings) & kEveryHeading) != 0 ? DirectionMask{1} << kUp : 0);
}
}  // namespace altiplan::kit
