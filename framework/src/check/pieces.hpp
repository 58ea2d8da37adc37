// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan {

/// A piece of a turn by its chord a–b. Each point of the piece has a partner on the chord, and each
/// point of the chord one on the piece, at the same height and time and at most `e` metres away.
struct Piece {
  Vec3 a;
  Vec3 b;
  double e;
  bool last;     ///< too short to be halved again
  double begin;  ///< fractions of the leg's time
  double end;
};

enum class Verdict { kept, violated, halve };

/// Decides a property of every point of a turn by that of chords: `verdict(piece)` keeps or
/// violates it for a whole piece, or asks for its halves. True if all pieces keep it.
template <class Decide>
bool every_piece(const Leg& leg, const Decide& verdict) {
  // A turn that touches an obstacle from outside keeps its distance; its chord comes nearer by e.
  // Both e and the judge's own tolerance must fit in kLengthTolerance.
  constexpr double kShortest = kLengthTolerance / 4;
  // Longer pieces seldom decide: e is a seventh of the radius at a sixth of a circle.
  const int parts = int(std::ceil(std::abs(leg.turn) / (kPi / 3)));
  struct End {
    double t;
    Vec3 p;
  };
  std::vector<End> ends;  // of the pieces ahead, the nearest last
  ends.reserve(std::size_t(parts) + 8);
  for (int i = parts; i > 0; --i) {
    const double t = double(i) / parts;
    ends.push_back({t, leg.at(t)});
  }
  for (End begin{0, leg.from}; !ends.empty();) {
    const End end = ends.back();
    const double e = leg.sagitta() * (end.t - begin.t) * (end.t - begin.t);
    const double middle = (begin.t + end.t) / 2;
    const bool last = e <= kShortest || middle <= begin.t || middle >= end.t;
    switch (verdict(Piece{begin.p, end.p, e, last, begin.t, end.t})) {
      case Verdict::kept:
        begin = end;
        ends.pop_back();
        break;
      case Verdict::violated:
        return false;
      case Verdict::halve:
        if (last) {
          return false;
        }
        ends.push_back({middle, leg.at(middle)});
        break;
    }
  }
  return true;
}
}  // namespace altiplan
