// SPDX-License-Identifier: Apache-2.0
#include "altiplan/nearest_place.hpp"

#include <algorithm>
#include <vector>

#include "altiplan/measures.hpp"
#include "deepest_place.hpp"

namespace altiplan {
namespace {

/// Bisects the leg down to a place for which `is_met`(from, to) holds, as it does for the whole
/// leg.
template <class IsMet>
double share_where(const Vec3& a, const Vec3& b, const IsMet& is_met) {
  constexpr double kFine = 1e-4;  // metres
  const double total = (b - a).norm();
  double from = 0;
  double to = 1;
  while ((to - from) * total > kFine) {
    const double middle = (from + to) / 2;
    const Vec3 at = a + middle * (b - a);
    (is_met(Vec3(a + from * (b - a)), at) ? to : from) = middle;
  }
  // Exactly the ends, as they may be waypoints.
  return from == 0 ? 0 : to == 1 ? 1 : (from + to) / 2;
}

/// Distance to the nearest ground found by a search with decreasing steps from `point`, which is
/// near it.
double nearest_about(const Ground& ground, const Vec3& p, const Vec3& point) {
  constexpr double kFine = 1e-3;  // metres
  double best = (p - point).norm();
  Vec3 at = point;
  for (double step = 0.01 * best; step > kFine;) {
    const Vec3 from = at;
    for (int n = 0; n < 9; ++n) {
      const int row = n / 3;
      const double x = from.x() + step * (n % 3 - 1);
      const double y = from.y() + step * (row - 1);
      const Vec3 next(x, y, ground.height(x, y).value_or(-kInfinity));
      if (const double distance = (p - next).norm(); distance < best) {
        best = distance;
        at = next;
      }
    }
    step = at == from ? step / 3 : step;
  }
  return best;
}
}  // namespace

DeepestPlace deepest_place(const Environment& solid, const Vec3& a, const Vec3& b) {
  const double total = (b - a).norm();
  const double tolerance = std::max(1e-3, total * 1e-4);
  DeepestPlace deepest{kInfinity, 0};
  const auto look = [&](double share) {
    const double here = solid.clearance(a + share * (b - a));
    if (here < deepest.clearance) {
      deepest = {here, share};
    }
    return here;
  };
  look(0);
  look(1);
  std::vector<std::pair<double, double>> open{{0, 1}};
  while (!open.empty()) {
    const auto [t0, t1] = open.back();
    open.pop_back();
    const double middle = (t0 + t1) / 2;
    if (look(middle) - (t1 - t0) / 2 * total < deepest.clearance - tolerance) {
      open.emplace_back(t0, middle);
      open.emplace_back(middle, t1);
    }
  }
  return deepest;
}

// The legs nearest by the clearance of their midpoints are measured first, and the others only if
// they may be nearer.
std::optional<NearestLeg> nearest_leg(const Environment& environment, const Polyline& route,
                                      double enough) {
  std::vector<NearestLeg> candidates;
  const double spare = environment.over_approximation() + 2 * kLengthTolerance;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const double clearance = environment.clearance((route[i] + route[i + 1]) / 2);
    const double at_least = clearance - (route[i + 1] - route[i]).norm() / 2 - spare;
    candidates.push_back({i, std::isnan(at_least) ? -kInfinity : at_least});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const NearestLeg& x, const NearestLeg& y) { return x.distance < y.distance; });
  std::optional<NearestLeg> nearest;
  for (const auto& [leg, at_least] : candidates) {
    if (at_least >= enough) {
      break;
    }
    const double its = leg_clearance(environment, route[leg], route[leg + 1], enough);
    if (its < enough) {
      enough = its;
      nearest = {leg, its};
    }
  }
  return nearest;
}

double nearest_share(const Environment& environment, const Vec3& a, const Vec3& b,
                     double clearance) {
  if (clearance < 0) {
    return deepest_place(environment, a, b).share;
  }
  // Slightly more than the error of leg_clearance.
  const double met = clearance * (1 + 1e-8) + 4 * kLengthTolerance;
  return share_where(
      a, b, [&](const Vec3& from, const Vec3& to) { return environment.blocked(from, to, met); });
}

std::optional<NearestLeg> lowest_leg(const World& world, const Polyline& route) {
  // Legs that begin low first: the others are then known to be higher without a search.
  std::vector<NearestLeg> legs;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    legs.push_back({i, world.ground_gap(route[i], route[i], kInfinity)});
  }
  std::stable_sort(legs.begin(), legs.end(), [](const NearestLeg& x, const NearestLeg& y) {
    return x.distance < y.distance;
  });
  std::optional<NearestLeg> lowest;
  for (const auto& [leg, begins] : legs) {
    const double min_gap = lowest ? lowest->distance : kInfinity;
    const double gap = world.ground_gap(route[leg], route[leg + 1], min_gap);
    if (gap == -kInfinity) {
      return std::nullopt;
    }
    if (gap < min_gap) {
      lowest = {leg, gap};
    }
  }
  return lowest;
}

double lowest_share(const World& world, const Vec3& a, const Vec3& b, double height) {
  const double met = height + kLengthTolerance;
  return share_where(a, b, [&](const Vec3& from, const Vec3& to) {
    return world.ground_gap(from, to, met) < met;
  });
}

double place_clearance(const Environment& environment, const Vec3& p) {
  constexpr double kFine = 5e-4;  // metres
  constexpr double kFar = 1e7;
  const auto is_free = [&](double r) { return !environment.blocked(p, p, r); };
  double free = environment.clearance(p);  // a lower bound
  if (!std::isfinite(free)) {
    return free;
  }
  if (!is_free(0)) {
    return std::min(free, 0.0);
  }
  free = std::max(free, 0.0);
  double met = free + kFine;
  if (!is_free(met)) {
    // The distance itself for most layers, or less by up to the over-approximation.
    for (met = free; free > 0 && !is_free(free);) {
      met = free;
      free = std::max(0.0, free - environment.over_approximation() - kFine);
    }
  } else if (const Ground* ground = environment.ground(); ground != nullptr && ground->is_all()) {
    environment.near(p, kInfinity,
                     [&](const Nearby& nearby) { met = nearest_about(*ground, p, nearby.point); });
    for (const double less : {kFine, met / 1000, met / 20}) {  // nearly always the first
      if (is_free(met - less)) {
        free = std::max(free, met - less);
        break;
      }
      met -= less;
    }
  } else {
    while (is_free(met)) {
      free = met;
      met *= 2;
      if (met > kFar) {
        return kInfinity;
      }
    }
  }
  while (met - free > 1.5 * kFine) {
    const double middle = (free + met) / 2;
    (is_free(middle) ? free : met) = middle;
  }
  return met;
}
}  // namespace altiplan
