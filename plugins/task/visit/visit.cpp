// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "altiplan/environment.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/kit/tour.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"
#include "altiplan/task.hpp"

namespace altiplan::visit {
namespace {

struct StopParams {
  Point at;
  double hold_s = 0;
  bool land = false;
  bool drop = false;

  void describe(Fields& f) {
    f.point(at).required().doc("place to pass");
    f("hold_s", hold_s).unit("s").range(0, 65'535).doc("wait, on the ground with `land`");
    f("land", land).doc("go down to the ground, and up again");
    f("drop", drop).doc("let go of the cargo after the wait, which takes 1 s or more");
  }

  /// The vehicle has to be still to drop something where it should.
  Stop stop() const { return {drop ? std::max(hold_s, 1.0) : hold_s, land, drop}; }
  const char* first_key() const { return land ? "land" : drop ? "drop" : "hold_s"; }
};

struct Params {
  std::vector<StopParams> stops;
  bool closed = false;
  int rounds = 20'000;

  void describe(Fields& f) {
    f("stops", stops).min_items(1).required().doc("places to pass, in the best order");
    f("closed", closed).doc("true: without a goal the route ends where it began");
    f("rounds", rounds)
        .range(0, 1'000'000'000)
        .doc("perturbations of the order, of more than 12 places");
  }
};

/// Up to so many stops the order is exact.
constexpr std::size_t kExact = 12;

/// Seconds between places as the vehicle flies them straight: stops, then the two ends, which cost
/// nothing where they are free.
struct Times {
  std::size_t stops;
  std::vector<double> of;  ///< row by row

  std::size_t size() const { return stops + 2; }
  double operator()(std::size_t i, std::size_t j) const { return of[i * size() + j]; }
  std::size_t start() const { return stops; }
  std::size_t goal() const { return stops + 1; }
};

Times times_between(const std::vector<Vec3>& stops, const std::optional<Vec3>& start,
                    const std::optional<Vec3>& goal, const Request& request) {
  std::vector<std::optional<Vec3>> places(stops.begin(), stops.end());
  places.push_back(start);
  places.push_back(goal);
  Times times{stops.size(), {}};
  for (const auto& from : places) {
    for (const auto& to : places) {
      times.of.push_back(from && to && *from != *to ? flown_time(Route{*from, *to}, request) : 0);
    }
  }
  return times;
}

/// Held and Karp: the least time by the set of places passed and the last of them.
std::vector<std::size_t> exact_order(const Times& times) {
  const std::size_t n = times.stops;
  const std::size_t sets = std::size_t{1} << n;
  std::vector<double> minimum(sets * n, kInfinity);
  std::vector<std::size_t> before(sets * n, n);
  for (std::size_t i = 0; i < n; ++i) {
    minimum[(std::size_t{1} << i) * n + i] = times(times.start(), i);
  }
  for (std::size_t set = 1; set < sets; ++set) {
    for (std::size_t last = 0; last < n; ++last) {
      const double so_far = minimum[set * n + last];
      for (std::size_t next = 0; next < n && so_far < kInfinity; ++next) {
        const std::size_t bit = std::size_t{1} << next;
        const std::size_t at = (set | bit) * n + next;
        if ((set & bit) == 0 && so_far + times(last, next) < minimum[at]) {
          minimum[at] = so_far + times(last, next);
          before[at] = last;
        }
      }
    }
  }
  std::size_t set = sets - 1;
  std::size_t last = 0;
  for (std::size_t i = 1; i < n; ++i) {
    const auto whole = [&](std::size_t k) { return minimum[set * n + k] + times(k, times.goal()); };
    last = whole(i) < whole(last) ? i : last;
  }
  std::vector<std::size_t> order;
  while (last < n) {
    order.push_back(last);
    const std::size_t previous = before[set * n + last];
    set &= ~(std::size_t{1} << last);
    last = previous;
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// Costs of a tour of stops, and of a piece that leads from the goal to the start; `mixed` makes
/// one of the two directions.
template <class Mix>
std::vector<double> tour_costs(const Times& times, const Mix& mixed) {
  const std::size_t ends = 2 * (times.stops + 1);
  const auto place = [&](std::size_t end) {
    return end < 2 * times.stops ? end / 2 : end == ends - 2 ? times.goal() : times.start();
  };
  std::vector<double> cost(ends * ends);
  for (std::size_t i = 0; i < ends; ++i) {
    for (std::size_t j = 0; j < ends; ++j) {
      cost[i * ends + j] = mixed(times(place(i), place(j)), times(place(j), place(i)));
    }
  }
  return cost;
}

class Visit final : public Task {
 public:
  Visit(const Params& params, const Site& site) : params_(params) {
    for (std::size_t i = 0; i < params.stops.size(); ++i) {
      try {
        stops_.push_back(site.resolve(params.stops[i].at));
      } catch (const Error& error) {
        throw ParameterError("stops", "stop " + std::to_string(i) + ": " + error.what());
      }
      expect_possible(i, site);
    }
  }

 private:
  void expect_possible(std::size_t i, const Site& site) const {
    const StopParams& stop = params_.stops[i];
    const Vec3& at = stops_[i];
    const auto refuse = [&](const std::string& why) {
      throw ParameterError("stops." + std::to_string(i) + "." + stop.first_key(), why);
    };
    if (!stop.stop().acts()) {
      return;
    }
    if (site.vehicle.wing) {
      refuse("an aeroplane cannot wait in one place, or land and take off again on its way");
    }
    if (const auto same = std::find(stops_.begin(), stops_.begin() + std::ptrdiff_t(i), at);
        same != stops_.begin() + std::ptrdiff_t(i)) {
      refuse("expected at a place of its own, found at that of stop " +
             std::to_string(same - stops_.begin()));
    }
    if (stop.land && !site.before->ground(at.x(), at.y())) {
      refuse("no ground is known there: give a layer with ground, such as terrain");
    }
  }

  Box do_bounds() const override {
    Box box = Box::empty();
    for (const Vec3& p : stops_) {
      box = box.with(p);
    }
    return box;
  }

  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    TaskOrder made;
    BudgetWatch watch(request.budget);
    // A closed route without a start may begin at any of its places: at the first.
    const bool closes = params_.closed && !ends.goal;
    const auto start = ends.start ? ends.start : closes ? std::optional(stops_[0]) : std::nullopt;
    const auto goal = ends.goal ? ends.goal : closes ? start : std::nullopt;
    const Times times = times_between(stops_, start, goal, request);
    std::vector<std::size_t> order;
    double bound_s = 0;
    std::uint64_t rounds = 0;
    if (stops_.size() <= kExact) {
      order = exact_order(times);
    } else {
      std::tie(order, bound_s) = searched(times, request, watch, rounds);
      made.budget_hit = rounds < std::uint64_t(params_.rounds);
    }
    for (const std::size_t i : order) {
      made.passes.push_back({{stops_[i]}, {}, false, params_.stops[i].stop()});
    }
    if (closes && !ends.start) {  // from the first place, wherever it came in the order
      const auto first = std::find_if(made.passes.begin(), made.passes.end(),
                                      [&](const Pass& p) { return p.points[0] == stops_[0]; });
      std::rotate(made.passes.begin(), first, made.passes.end());
    }
    made.status = PlanStatus::solved;
    made.closes = closes;
    made.time_s = flown_time(made.route(ends, request), request);
    made.counters = {{"expanded", std::int64_t(rounds)}};
    double stops_s = 0;  // in any order
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      stops_s += params_.stops[i].stop().seconds(stops_[i], request);
    }
    const double legs_s = made.time_s - stops_s;
    made.bound_s = stops_s + bound_of(stops_.size() <= kExact ? legs_s : bound_s, request, legs_s);
    return made;
  }

  /// Of a vehicle that does not stop at waypoints, or in other speeds than its own, nothing is
  /// known.
  static double bound_of(double bound_s, const Request& request, double time_s) {
    const Vehicle& vehicle = request.vehicle;
    const bool adds_up =
        !vehicle.wing && !vehicle.acceleration.corner_radius_m && vehicle.speed_near.empty();
    return adds_up ? std::min(bound_s, time_s) : 0;
  }

  /// 2-opt, Or-opt and double bridges; the bound is a 1-tree's.
  std::pair<std::vector<std::size_t>, double> searched(const Times& times, const Request& request,
                                                       BudgetWatch& watch,
                                                       std::uint64_t& rounds) const {
    const std::size_t pieces = times.stops + 1;
    kit::Tour tour(pieces, tour_costs(times, [](double a, double b) { return (a + b) / 2; }));
    tour.construct();
    RandomStream random = request.random;
    tour.improve(random(), [&] {
      if (rounds >= std::uint64_t(params_.rounds) || watch.spent(rounds)) {
        return true;
      }
      ++rounds;
      return false;
    });
    std::vector<int> entries = tour.entries();
    const int last = int(times.stops);
    std::rotate(entries.begin(),
                std::find_if(entries.begin(), entries.end(), [&](int e) { return e / 2 == last; }),
                entries.end());
    const bool is_backwards = entries[0] % 2 == 1;
    std::vector<std::size_t> order;
    for (std::size_t i = 1; i < entries.size(); ++i) {
      order.push_back(std::size_t(entries[i] / 2));
    }
    if (is_backwards) {
      std::reverse(order.begin(), order.end());
    }
    constexpr int kSteps = 200;
    return {order, kit::tour_bound(
                       pieces, tour_costs(times, [](double a, double b) { return std::min(a, b); }),
                       tour.cost(), kSteps)};
  }

  Params params_;
  std::vector<Vec3> stops_;
};
}  // namespace
}  // namespace altiplan::visit

ALTIPLAN_PLUGIN(
    Task, "visit", altiplan::visit::Visit, altiplan::visit::Params,
    "passes places in the best order, exactly up to twelve; holds, lands and drops there")
