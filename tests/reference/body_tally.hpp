// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "altiplan/swept_volume.hpp"
#include "framework/shape_oracle.hpp"
#include "reference/separation.hpp"

// How answers about bodies compare with the oracle's gaps.
namespace altiplan::oracle {

struct Tally {
  int answers = 0;  ///< two of each query
  int met = 0;
  int near = 0;    ///< gaps and depths within kBodyTolerance
  int vague = 0;   ///< not known to a micrometre by the oracle
  int missed = 0;  ///< overlaps, of whatever depth
  int invented = 0;
  double widest = 0;   ///< gap of a volume said to meet
  double deepest = 0;  ///< bound on the depth of one said to be free
};

/// A signed gap to aim for: most of them near the decision, metres.
inline double drawn_gap(Draw& draw) {
  const double sign = draw.below(2) == 0 ? 1 : -1;
  return draw.below(3) == 0 ? draw(-0.1, 0.1) : sign * std::pow(10, draw(-6, -1));
}

/// Counts an answer; false if it is wrong by more than the tolerance.
inline bool count(Tally& tally, const Gap& gap, bool met) {
  constexpr double kTouching = 1e-7;  // metres
  ++tally.answers;
  tally.met += met;
  tally.near += gap.low > -kBodyTolerance && gap.high < kBodyTolerance;
  tally.vague += gap.high > kTouching && gap.high - gap.low > 1e-6;
  if (met) {
    tally.widest = std::max(tally.widest, double(gap.low));
    tally.invented += gap.low > kBodyTolerance;
    return gap.low <= kBodyTolerance;
  }
  if (gap.high <= kTouching) {
    ++tally.missed;
    tally.deepest = std::max(tally.deepest, -double(gap.low));
    return false;
  }
  return true;
}

inline void print(const char* name, double scale, const Tally& tally) {
  std::printf(
      "%-8s %6g m: %6d answers, %6d met, %5d within %g m, %d vague; missed %d (by at most %.2e m), "
      "invented %d (widest gap %.2e m)\n",
      name, scale, tally.answers, tally.met, tally.near, kBodyTolerance, tally.vague, tally.missed,
      tally.deepest, tally.invented, tally.widest);
}
}  // namespace altiplan::oracle
