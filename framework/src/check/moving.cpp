// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "moving.hpp"
#include "pieces.hpp"
#include "uniform_motion.hpp"
#include "words.hpp"

namespace altiplan {
namespace {

/// Distance that the vehicle's sphere, which holds its body, must keep from moving obstacles.
double needed_in_time(const Request& request) {
  return std::max(request.limits.min_clearance, request.vehicle.reach_m());
}

bool turn_meets(const MovingObstacle& obstacle, const Leg& turn, double time_s,
                const Request& request) {
  const double needed = needed_in_time(request);
  const double duration = leg_duration(turn, time_s, request);
  return !every_piece(turn, [&](const Piece& piece) {
    const double t0 = time_s + piece.begin * duration;
    const double t1 = time_s + piece.end * duration;
    return !hits(obstacle, piece.a, t0, piece.b, t1, needed + piece.e)  ? Verdict::kept
           : hits(obstacle, piece.a, t0, piece.b, t1, needed - piece.e) ? Verdict::violated
                                                                        : Verdict::halve;
  });
}

bool leg_meets(const MovingObstacle& obstacle, const Leg& leg, double time_s,
               const Request& request) {
  if (leg.turns()) {
    return turn_meets(obstacle, leg, time_s, request);
  }
  return !in_uniform_motion(leg, time_s, request,
                            [&](const Vec3& a, double t0, const Vec3& b, double t1) {
                              return !hits(obstacle, a, t0, b, t1, needed_in_time(request));
                            });
}

/// When and where on a leg the vehicle is nearest to an obstacle.
struct Nearest {
  double distance = kInfinity;
  double time_s = 0;
  Vec3 at{0, 0, 0};
};

/// By halving the time; the first of equals.
Nearest nearest_in(const MovingObstacle& obstacle, Vec3 a, double t0, Vec3 b, double t1) {
  constexpr double kFineTime = 1e-6;  // seconds
  const double distance = separation(obstacle, a, t0, b, t1);
  while (t1 - t0 > kFineTime) {
    const double middle = (t0 + t1) / 2;
    const Vec3 half = (a + b) / 2;
    const bool is_first =
        separation(obstacle, a, t0, half, middle) <= separation(obstacle, half, middle, b, t1);
    (is_first ? t1 : t0) = middle;
    (is_first ? b : a) = half;
  }
  return {distance, t0, a};
}

Nearest nearest_on(const MovingObstacle& obstacle, const Leg& leg, double time_s,
                   const Request& request) {
  Nearest nearest;
  const auto look = [&](const Vec3& a, double t0, const Vec3& b, double t1) {
    if (separation(obstacle, a, t0, b, t1) < nearest.distance) {
      nearest = nearest_in(obstacle, a, t0, b, t1);
    }
    return true;
  };
  if (!leg.turns()) {
    in_uniform_motion(leg, time_s, request, look);
    return nearest;
  }
  const Polyline points = leg.chords(kChordTolerance);  // equal times apart
  const double step = leg_duration(leg, time_s, request) / double(points.size() - 1);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    look(points[i], time_s + double(i) * step, points[i + 1], time_s + double(i + 1) * step);
  }
  return nearest;
}
}  // namespace

bool avoids_moving(const Request& request) {
  const std::vector<MovingObstacle>& moving = request.world->moving();
  return std::any_of(moving.begin(), moving.end(),
                     [](const MovingObstacle& obstacle) { return obstacle.planned; });
}

const MovingObstacle* meets_moving(const Leg& leg, double time_s, const Request& request) {
  for (const MovingObstacle& obstacle : request.world->moving()) {
    if (obstacle.planned && leg_meets(obstacle, leg, time_s, request)) {
      return &obstacle;
    }
  }
  return nullptr;
}

std::vector<Violation> moving_violations(const Route& route, const Request& request) {
  std::vector<Violation> found;
  if (!avoids_moving(request)) {
    return found;
  }
  const double needed = needed_in_time(request);
  double time_s = request.start.time_s;
  for (std::size_t i = 0; i < route.leg_count() && std::isfinite(time_s); ++i) {
    const Leg leg = route.leg(i);
    if (const MovingObstacle* met = meets_moving(leg, time_s, request)) {
      const Nearest nearest = nearest_on(*met, leg, time_s, request);
      found.push_back({"moving", i, nearest.distance, needed,
                       "the distance from the moving obstacle '" + met->id + "' is " +
                           distance_text(nearest.distance) + " m, " + fixed(nearest.time_s) +
                           " s after the start at " + place(nearest.at) + ", below " +
                           fixed(needed) + " m",
                       "", "m"});
    }
    time_s += leg_duration(leg, time_s, request);
  }
  return found;
}
}  // namespace altiplan
