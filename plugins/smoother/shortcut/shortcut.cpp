// SPDX-License-Identifier: Apache-2.0
// Random shortcuts, checked by the judge.
//
// Citation: R. Geraerts, M. H. Overmars: Creating High-quality Paths for Motion Planning. The
//   International Journal of Robotics Research 26(8), 2007, 845-863,
//   doi:10.1177/0278364907079280, procedure Shortcut.
// Guarantees: a new leg, and the legs that it joins, satisfy every constraint on legs; the route
//   never gets longer, and the largest violation of any constraint does not grow. Not the shortest
//   route possible.
// Complexity: O(k (log n + c) + s n) for k samples, s shortcuts taken, n waypoints and a leg check
//   c.
// Deviations: legs are checked exactly, with the turns at both ends of the shortcut (the paper
//   samples states, which have no turns). A point is sampled on the legs or, with probability
//   waypoint_share, moved to the nearest waypoint: then legs are not cut, which a minimum leg
//   length may forbid. It ends after a number of consecutive failures. No partial shortcuts:
//   coordinates that move independently are those of articulated robots. In a route with turns a
//   shortcut is the Dubins airplane's path between the poses, in wind the quickest.
// Symbols: pi the route; pi_a and pi_b the two random points on it.
#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/kit/smoothing/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"
#include "turning.hpp"

namespace {
using namespace altiplan;

struct Params {
  int iterations = 1000;
  int failures = 200;
  double waypoint_share = 0.5;

  void describe(Fields& f) {
    f("iterations", iterations).range(0, 10'000'000).doc("maximum number of random point pairs");
    f("failures", failures).at_least(1).doc("stop after this many consecutive failed pairs");
    f("waypoint_share", waypoint_share)
        .range(0, 1)
        .doc("fraction of points moved to the nearest waypoint; the others stay on the legs");
  }
};

/// A shortcut with a smaller gain, as a fraction of the route, is not worth its waypoints.
constexpr double kMinGain = 1e-5;

/// Shortens one route.
class Shortening {
 public:
  Shortening(Polyline route, const Request& request, double waypoint_share)
      : pi_(std::move(route)),
        request_(request),
        random_(request.random.sub("shortcut")),
        waypoint_share_(waypoint_share) {
    measure();
  }

  /// Samples two points and tries the straight leg between them; returns true if it was taken.
  bool shortcut() {
    Place a = draw();
    Place b = draw();
    if (b.from_start < a.from_start) {
      std::swap(a, b);
    }
    const bool straight_already = a.after >= b.before;
    const double gain = b.from_start - a.from_start - (b.at - a.at).norm();
    if (straight_already || gain <= kMinGain * from_start_.back()) {
      return false;
    }
    Polyline shorter(pi_.begin(), pi_.begin() + std::ptrdiff_t(a.before));
    shorter.insert(shorter.end(), {a.at, b.at});
    shorter.insert(shorter.end(), pi_.begin() + std::ptrdiff_t(b.after), pi_.end());
    // The leg a-b, and the adjacent ones that are cut, or whose turn changes.
    if (!legs_kept(shorter, a.before - (a.is_waypoint() ? 0 : 1),
                   a.before + (b.is_waypoint() ? 1 : 2)) ||
        (request_.objective &&
         costs_more(cost_of(Route(shorter), request_), cost_of(Route(pi_), request_)))) {
      return false;
    }
    pi_ = std::move(shorter);
    measure();
    return true;
  }

  bool is_done() const { return pi_.size() <= 2; }
  const Polyline& route() const { return pi_; }
  std::int64_t legs_checked() const { return legs_checked_; }

 private:
  struct Place {
    Vec3 at;
    double from_start;   ///< metres along the route
    std::size_t before;  ///< number of waypoints before it
    std::size_t after;   ///< the first waypoint after it
    bool is_waypoint() const { return after > before; }
  };

  void measure() {
    from_start_.assign(1, 0.0);
    for (std::size_t i = 1; i < pi_.size(); ++i) {
      from_start_.push_back(from_start_.back() + (pi_[i] - pi_[i - 1]).norm());
    }
  }

  Place draw() {
    const double metres = random_.uniform(0, from_start_.back());
    const bool to_waypoint = random_.uniform() < waypoint_share_;
    const auto end = std::upper_bound(from_start_.begin() + 1, from_start_.end() - 1, metres);
    const auto i = std::size_t(end - from_start_.begin());
    const double into = metres - from_start_[i - 1];
    const double leg = from_start_[i] - from_start_[i - 1];
    if (to_waypoint) {
      const std::size_t nearest = into < leg / 2 ? i - 1 : i;
      return {pi_[nearest], from_start_[nearest], nearest, nearest + 1};
    }
    return {pi_[i - 1] + into / leg * (pi_[i] - pi_[i - 1]), metres, i, i};
  }

  /// Checks the legs `first` to `last`, and past one without a heading the following legs.
  bool legs_kept(const Polyline& route, std::size_t first, std::size_t last) {
    std::optional<Approach> before = approach(route, first, request_.before_start());
    for (std::size_t i = first; i + 1 < route.size(); ++i) {
      if (i > last && has_heading(route[i] - route[i - 1])) {
        break;
      }
      ++legs_checked_;
      if (!leg_ok(before, route[i], route[i + 1], request_)) {
        return false;
      }
      before = onward(before, route[i]);
    }
    return true;
  }

  Polyline pi_;
  const Request& request_;
  RandomStream random_;
  double waypoint_share_;
  std::vector<double> from_start_;  // of each waypoint, metres along the route
  std::int64_t legs_checked_ = 0;
};

class Shortcut final : public Smoother {
 public:
  explicit Shortcut(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    Shortening shortening(without_repeats(route), request, params_.waypoint_share);
    return shortened(shortening, route, request);
  }

  PlanResult do_smooth_turns(const Route& route, const Request& request) const override {
    shortcut::TurnShortening shortening(without_repeats(route), request, params_.waypoint_share,
                                        kMinGain);
    return shortened(shortening, route, request);
  }

  template <class Kind>
  PlanResult shortened(Kind& shortening, const Route& route, const Request& request) const {
    BudgetWatch watch(request.budget);
    PlanResult result;
    std::int64_t drawn = 0;
    std::int64_t taken = 0;
    for (int in_vain = 0;
         drawn < params_.iterations && in_vain < params_.failures && !shortening.is_done();
         ++drawn) {
      result.budget_hit = watch.spent(std::uint64_t(drawn));
      if (result.budget_hit) {
        break;
      }
      const bool shorter = shortening.shortcut();
      taken += shorter ? 1 : 0;
      in_vain = shorter ? 0 : in_vain + 1;
    }
    result.status = PlanStatus::solved;
    result.counters = {
        {"expanded", drawn}, {"taken", taken}, {"legs_checked", shortening.legs_checked()}};
    // Constraints on whole routes are checked last.
    const Route shorter = taken > 0 ? Route(shortening.route()) : route;
    const bool accepted = taken > 0 && kit::Excess(check(shorter, request).violations)
                                           .within(kit::Excess(check(route, request).violations));
    result.route = accepted ? shorter : route;
    result.message =
        taken > 0 && !accepted
            ? "the shorter route would violate a constraint on whole routes: it is unchanged"
            : std::to_string(taken) + " shortcuts taken, of " + std::to_string(drawn) + " tried" +
                  (result.budget_hit ? "; the budget was used up" : "");
    return result;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "shortcut", Shortcut, Params,
                "straight legs, or Dubins paths where the route turns, between random points of it")
