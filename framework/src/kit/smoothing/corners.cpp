// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/smoothing/corners.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace altiplan::kit {

void Excess::add(const std::vector<Violation>& violations) {
  for (const Violation& broken : violations) {
    const double by = std::abs(broken.value - broken.limit);
    double& worst = worst_[{broken.constraint, broken.limit, broken.value < broken.limit}];
    worst = std::max(worst, by > 0 ? by : 1);
  }
}

void Excess::add(const Excess& other) {
  for (const auto& [rule, by] : other.worst_) {
    double& worst = worst_[rule];
    worst = std::max(worst, by);
  }
}

bool Excess::within(const Excess& other) const {
  // Tolerated increase of an excess by rounding, in a leg of the same direction or a part of a leg.
  // Far below the judge's own tolerances, so that three corners at one place still add up to
  // nothing.
  constexpr double kRounding = 1e-8;
  return std::all_of(worst_.begin(), worst_.end(), [&](const auto& entry) {
    const auto there = other.worst_.find(entry.first);
    return there != other.worst_.end() && entry.second <= there->second + kRounding;
  });
}

double radius_margin(double leg, double turn) {
  // Maximum displacement of a point by rounding: half of 1e-7 degree on two axes, half a centimetre
  // up.
  constexpr double kMoved = 0.0095;
  constexpr double kMax = 0.05;
  // The radius is leg / 2 / tan(turn / 2): both ends of a leg move, and both legs of a turn.
  return turn > 0 ? std::min(kMax, 2 * kMoved / leg * (1 + 2 / std::sin(std::min(turn, kPi / 2))))
                  : 0;
}

double Corner::fair_reach() const { return std::min(leg_into, leg_out_of) / 2; }

namespace {

bool near(const Vec3& a, const Vec3& b) { return (a - b).norm() <= kLengthTolerance; }

/// Appends a point unless it repeats the last one.
void append(Polyline& route, const Vec3& p) {
  if (p != route.back()) {
    route.push_back(p);
  }
}

class Rounding {
 public:
  Rounding(const Polyline& route, const Request& request, const CurveOf& curve_of)
      : original_(route),
        route_(without_repeats(route)),
        request_(request),
        curve_of_(curve_of),
        watch_(request.budget) {
    std::optional<Approach> before = request.before_start();
    for (std::size_t i = 0; i + 1 < route_.size() && !budget_ended(); ++i) {
      LegExcess leg{Excess(leg_violations(before, route_[i], route_[i + 1], request, i)), {}};
      if (!leg.with_turn.none()) {
        leg.alone = Excess(leg_violations(std::nullopt, route_[i], route_[i + 1], request, i));
      }
      legs_.push_back(std::move(leg));
      before = onward(before, route_[i]);
    }
  }

  RoundedRoute run() {
    // Judging a long route takes long: skipped once the budget has ended.
    const Excess allowed(budget_ended() ? std::vector<Violation>()
                                        : check(original_, request_).violations);
    if (budget_ended()) {
      return {.route = original_, .budget_hit = true};
    }
    const auto kept = [&] { return Excess(check(done_, request_).violations).within(allowed); };
    round_all();
    bool accepted = kept();
    if (!accepted && !budget_ended()) {
      // A constraint on the whole route, which no leg shows: checked for every curve.
      allowed_ = &allowed;
      round_all();
      accepted = kept();
    }
    count(accepted);
    if (result_.replaced == 0) {
      done_ = original_;
    }
    result_.route = std::move(done_);
    return std::move(result_);
  }

 private:
  static constexpr int kStays = -1;
  static constexpr std::size_t kNone = ~std::size_t{0};

  bool budget_ended() {
    result_.budget_hit = result_.budget_hit || watch_.spent(std::uint64_t(result_.attempts));
    return result_.budget_hit;
  }

  /// Excess of a leg of the route, and its excess without a leg before it.
  struct LegExcess {
    Excess with_turn;
    Excess alone;
  };

  struct State {
    int first = 0;         ///< candidates before this one are ruled out
    int chosen = kStays;   ///< the accepted candidate
    std::size_t done = 1;  ///< number of points of the route before this corner
    std::size_t from = 0;  ///< the waypoint that is the last of these; kNone: the end of a curve
    bool turns = false;    ///< true if the waypoint is a corner
    bool offered = false;  ///< true if it had a candidate
  };

  void round_all() {
    states_.assign(route_.size(), {});
    done_ = {route_.front()};
    for (next_ = 1; next_ + 1 < route_.size();) {
      State& state = states_[next_];
      state.done = done_.size();
      if (next_ > 1) {
        const State& before = states_[next_ - 1];
        state.from = before.chosen == kStays       ? next_ - 1
                     : before.done == done_.size() ? before.from  // it was cut out
                                                   : kNone;
      }
      state.chosen = choose();
      if (state.chosen == kStays && states_[next_ - 1].chosen != kStays &&
          !is_accepted(part_with({route_[next_]}))) {
        // The previous curve used too much of the leg.
        --next_;
        done_.resize(states_[next_].done);
        states_[next_].first = states_[next_].chosen + 1;
        continue;
      }
      if (state.chosen == kStays) {
        append(done_, route_[next_]);
      }
      ++next_;
    }
    append(done_, route_.back());
  }

  /// Applies the best candidate to the next corner and returns its number; kStays if none is
  /// accepted.
  int choose() {
    const Corner corner = corner_here();
    State& state = states_[next_];
    state.turns = corner.turn > 0;
    if (corner.turn > kPi - kAngleTolerance) {
      return kStays;
    }
    int chosen = kStays;
    Polyline best;
    for (int attempt = state.first;; ++attempt) {
      const std::optional<Polyline> curve = curve_of_(corner, attempt);
      if (!curve) {
        break;
      }
      if (budget_ended()) {
        break;
      }
      ++result_.attempts;
      state.offered = true;
      const Polyline part = part_with(*curve);
      const bool keeps_all = sound(part);
      if ((keeps_all || (chosen == kStays && is_accepted(part))) && keeps_whole_rules(*curve) &&
          keeps_cost(part)) {
        chosen = attempt;
        best = *curve;
        if (keeps_all) {
          break;
        }
      }
    }
    if (chosen != kStays) {
      append_curve(done_, best);
    }
    return chosen;
  }

  Corner corner_here() const {
    const Vec3 into = route_[next_] - route_[next_ - 1];
    const Vec3 out_of = route_[next_ + 1] - route_[next_];
    const double turn = turn_angle_in_space(into, out_of);
    return {route_[next_],
            into.normalized(),
            out_of.normalized(),
            turn > kAngleTolerance ? turn : 0,
            into.norm(),
            out_of.norm(),
            (route_[next_] - done_.back()).norm(),
            done_.size() > 1 ? turn_angle_in_space(done_.back() - done_[done_.size() - 2],
                                                   route_[next_] - done_.back())
                             : 0,
            next_ + 2 == route_.size()};
  }

  /// Appends the points of a curve; those equal to the adjacent waypoints up to rounding become
  /// these.
  void append_curve(Polyline& route, const Polyline& curve) const {
    for (const Vec3& p : curve) {
      if (!near(p, route.back())) {
        route.push_back(near(p, route_[next_ + 1]) ? route_[next_ + 1] : p);
      }
    }
  }

  /// From the last point so far over the curve to the next waypoint.
  Polyline part_with(const Polyline& curve) const {
    Polyline part = {done_.back()};
    append_curve(part, curve);
    append(part, route_[next_ + 1]);
    return part;
  }

  /// Calls judge(before, a, b) for the legs of a part until it returns false.
  template <class Judge>
  bool all_legs(const Polyline& part, const Judge& judge) const {
    std::optional<Approach> before = approach(done_, done_.size() - 1, request_.before_start());
    for (std::size_t i = 0; i + 1 < part.size(); ++i) {
      if (!judge(before, part[i], part[i + 1])) {
        return false;
      }
      before = onward(before, part[i]);
    }
    return true;
  }

  bool sound(const Polyline& part) const {
    return all_legs(part, [&](const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
      return leg_ok(before, a, b, request_);
    });
  }

  /// True if the part violates no constraint by more than the two legs of the corner: its first
  /// leg, in turning into it, by no more than the leg into the corner, or the one that began where
  /// it does; the others by no more than the corner.
  bool is_accepted(const Polyline& part) const {
    const LegExcess& into = legs_[next_ - 1];
    const LegExcess& out_of = legs_[next_];
    Excess first = into.with_turn;
    first.add(out_of.alone);
    if (states_[next_].from != kNone) {
      first.add(legs_[states_[next_].from].with_turn);
    }
    Excess others = into.alone;
    others.add(out_of.with_turn);
    const Excess* allowed = &first;
    return all_legs(part, [&](const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
      const bool ok =
          leg_ok(before, a, b, request_) ||
          (!allowed->none() && Excess(leg_violations(before, a, b, request_, 0)).within(*allowed));
      allowed = &others;
      return ok;
    });
  }

  bool keeps_whole_rules(const Polyline& curve) const {
    if (allowed_ == nullptr) {
      return true;
    }
    Polyline whole = done_;
    append_curve(whole, curve);
    for (std::size_t i = next_ + 1; i < route_.size(); ++i) {
      append(whole, route_[i]);
    }
    return Excess(check(whole, request_).violations).within(*allowed_);
  }

  /// True if the part costs no more than the corner, or the corner is not valid as it is.
  bool keeps_cost(const Polyline& part) const {
    if (!request_.objective) {
      return true;
    }
    const Polyline corner = part_with({route_[next_]});
    return !costs_more(cost_of(Route(part), request_), cost_of(Route(corner), request_)) ||
           !sound(corner);
  }

  /// Counts the outcomes of the corners, if the route with its curves is accepted at all.
  void count(bool accepted) {
    for (const State& state : states_) {
      const bool replaced = accepted && state.chosen != kStays;
      result_.corners += state.turns;
      result_.replaced += replaced;
      result_.refused += state.offered && !replaced;
    }
  }

  const Polyline& original_;
  const Polyline route_;
  const Request& request_;
  const CurveOf& curve_of_;
  BudgetWatch watch_;
  std::vector<LegExcess> legs_;      ///< of route_
  const Excess* allowed_ = nullptr;  ///< of the whole route, if checked
  std::vector<State> states_;        ///< of the waypoints of route_
  Polyline done_;                    ///< the points so far, to be followed by route_ from next_ on
  std::size_t next_ = 1;
  RoundedRoute result_;
};
}  // namespace

RoundedRoute round_corners(const Polyline& route, const Request& request, const CurveOf& curve_of) {
  return Rounding(route, request, curve_of).run();
}
}  // namespace altiplan::kit
