// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "altiplan/leg.hpp"
#include "altiplan/world.hpp"

namespace altiplan {

/// A piece of a turn by its chord a–b. Each point of the piece has a partner on the chord, and each
/// point of the chord one on the piece, at the same height and at most `e` metres away.
struct Piece {
  Vec3 a;
  Vec3 b;
  double e;
  bool last;  ///< too short to be halved again
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
  const double parts = std::ceil(std::abs(leg.turn) / (kPi / 3));
  std::vector<std::pair<double, double>> open;
  for (double i = parts; i > 0; --i) {
    open.emplace_back((i - 1) / parts, i / parts);
  }
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    const double e = leg.sagitta() * (end - begin) * (end - begin);
    const double middle = (begin + end) / 2;
    const bool last = e <= kShortest || middle <= begin || middle >= end;
    switch (verdict(Piece{leg.at(begin), leg.at(end), e, last})) {
      case Verdict::kept:
        break;
      case Verdict::violated:
        return false;
      case Verdict::halve:
        if (last) {
          return false;
        }
        open.emplace_back(middle, end);
        open.emplace_back(begin, middle);
        break;
    }
  }
  return true;
}

/// The layer that blocks a turn for a sphere of radius r, or null. By bisection: a piece is free if
/// its chord is free for r + e, and blocked if its chord is blocked for r - e.
inline const Layer* blocked_by(const World& world, const Leg& turn, double r) {
  const Layer* layer = nullptr;
  const bool is_free = every_piece(turn, [&](const Piece& piece) {
    layer = world.blocked_by(piece.a, piece.b, r + piece.e);
    if (layer == nullptr) {
      return Verdict::kept;
    }
    const bool is_blocked = r > piece.e && world.blocked(piece.a, piece.b, r - piece.e);
    return is_blocked ? Verdict::violated : Verdict::halve;
  });
  return is_free ? nullptr : layer;
}
}  // namespace altiplan
