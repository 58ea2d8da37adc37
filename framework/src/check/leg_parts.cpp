// SPDX-License-Identifier: Apache-2.0
#include "leg_parts.hpp"

#include "altiplan/attributed.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/leg_limits.hpp"
#include "altiplan/nearest_place.hpp"
#include "altiplan/what_blocks.hpp"
#include "pieces.hpp"
#include "words.hpp"

namespace altiplan {

std::string turn_problem(const Leg& turn) {
  if (!is_well_formed(turn)) {
    return "a figure of the turn is not finite, or beyond what a leg may have";
  }
  const Vec3 end = Leg::turning({turn.from, turn.heading}, turn.turn, turn.radius,
                                turn.to.z() - turn.from.z(), turn.drift)
                       .to;
  const double off = (turn.to - end).norm();
  return off <= kLengthTolerance ? ""
                                 : "the turn leads to " + place(end) + ", " + distance_text(off) +
                                       " m from the end of its leg";
}

std::string wait_problem(const Leg& wait, const Request& request) {
  if (!is_well_formed(wait)) {
    return "a wait takes a time above 0, at one place, and does not turn";
  }
  if (request.vehicle.wing) {
    return "an aeroplane cannot wait in one place";
  }
  const double wind = request.wind.at(wait.from).norm();
  return wind < request.air_speed()
             ? ""
             : "the vehicle cannot wait at " + place(wait.from) + ": the wind of " + fixed(wind) +
                   " m/s is as fast as it is (" + fixed(request.air_speed()) + " m/s)";
}

Violation too_near(const Layer* layer, const Leg& leg, const Request& request, std::size_t at) {
  const double needed = required_clearance(request);
  const Polyline points = leg.chords(kChordTolerance / 10);
  NearestLeg nearest{0, kInfinity};
  for (const Layer& other : request.world->layers()) {
    const auto its = nearest_leg(*other.environment, points, nearest.distance);
    if (its && (&other == layer ||
                other.environment->blocked(points[its->leg], points[its->leg + 1], needed))) {
      nearest = *its;
      layer = &other;
    }
  }
  const double clearance = nearest.distance;
  // The layer may block from around: outside a keep-in zone.
  const std::string inside = "inside what '" + layer->id + "' blocks";
  std::string where = clearance == -kInfinity ? "lies " + inside
                      : clearance < 0
                          ? "lies up to " + fixed(-clearance) + " m " + inside
                          : "comes to " + fixed(clearance) + " m of '" + layer->id + "'";
  if (const auto* reasons = dynamic_cast<const WhatBlocks*>(layer->environment.get())) {
    const std::string what =
        reasons->what_blocks(points[nearest.leg], points[nearest.leg + 1], clearance);
    where += what.empty() ? "" : " (" + what + ")";
  }
  return {"clearance",
          at,
          clearance,
          needed,
          where + ", where " + fixed(needed) + " m of clearance are needed",
          layer->id,
          "m"};
}

Violation body_violation(const Layer& layer, const Leg& leg, const Request& request,
                         std::size_t at) {
  const auto nearest = nearest_leg(*layer.environment, leg.chords(kChordTolerance / 10), kInfinity);
  const double clearance = nearest ? nearest->distance : kInfinity;
  const double reach = request.vehicle.reach_m();
  return {"body",
          at,
          0,
          0,
          "between " + place(leg.from) + " and " + place(leg.to) + " the vehicle's body meets '" +
              layer.id + "', which the route itself passes at " + fixed(clearance) +
              " m (the body reaches " + fixed(reach) + " m from the route)",
          layer.id};
}

Vec3 ground_ends(const World& world, const Vec3& a, const Vec3& b) {
  if (!world.ground_below(a, a)) {
    return a;
  }
  double known = 0;
  double unknown = 1;
  for (int i = 0; i < 50; ++i) {
    const double t = (known + unknown) / 2;
    (world.ground_below(a, a + t * (b - a)) ? known : unknown) = t;
  }
  return a + unknown * (b - a);
}

namespace {
bool is_blocked(const Environment& layer, const Leg& turn, double r) {
  return !every_piece(turn, [&](const Piece& piece) {
    if (!layer.blocked(piece.a, piece.b, r + piece.e)) {
      return Verdict::kept;
    }
    const bool surely = r > piece.e && layer.blocked(piece.a, piece.b, r - piece.e);
    return surely ? Verdict::violated : Verdict::halve;
  });
}
}  // namespace

const Layer* blocked_by(const World& world, const Leg& turn, const Box& box, double r,
                        const AboveGround& above) {
  const Box reach = box.grown(r + kLengthTolerance);
  const bool is_high =
      above.height - kLengthTolerance >= r * std::sqrt(1 + above.slope * above.slope);
  const auto blocks = [&](const Environment& layer) {
    const Box bounds = layer.bounds();  // its ground reaches further down
    if (bounds.min.x() > reach.max.x() || bounds.max.x() < reach.min.x() ||
        bounds.min.y() > reach.max.y() || bounds.max.y() < reach.min.y() ||
        bounds.max.z() < reach.min.z()) {
      return false;
    }
    const Ground* ground = is_high ? layer.ground() : nullptr;
    return !(ground != nullptr && ground->is_all()) && is_blocked(layer, turn, r);
  };
  for (const Layer& layer : world.layers()) {
    if (attributed([&] { return "the layer '" + layer.id + "' (" + layer.plugin + ")"; },
                   [&] { return blocks(*layer.environment); })) {
      return &layer;
    }
  }
  return nullptr;
}
}  // namespace altiplan
