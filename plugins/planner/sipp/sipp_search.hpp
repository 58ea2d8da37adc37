// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/lattice_search.hpp"
#include "altiplan/kit/lattice/open_list.hpp"
#include "altiplan/measures.hpp"
#include "safe_times.hpp"

namespace altiplan::sipp {

inline constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A safe interval of a cell, or of the start.
struct State {
  Times safe;
  double g = kInfinity;  ///< earliest arrival known, seconds
  double departure = 0;  ///< from the parent
  std::uint32_t parent = kNone;
  std::uint32_t cell = kNone;  ///< kNone: the start, where it is no centre of a cell
  bool last = true;            ///< of the cell's intervals, which follow one another
  bool closed = false;
};

/// A part of the world that is closed at times, which are longer by a millisecond at both ends.
struct Closure {
  const Environment* what = nullptr;
  std::vector<Times> closed;
};

/// One search from request.start to request.goal among `movers` and `closures`, at one speed in
/// still air.
class Search : kit::LatticeSearch {
 public:
  /// All arguments must outlive it.
  Search(const Request& request, const kit::SearchSettings& settings, const kit::Lattice& lattice,
         const std::vector<Mover>& movers, const std::vector<Closure>& closures)
      : LatticeSearch(request, settings, lattice, kInfinity),
        movers_(movers),
        closures_(closures),
        needed_(std::max(request.limits.min_clearance, request.vehicle.radius_m)),
        fastest_(fastest_of(request.vehicle)),
        first_(lattice.size(), kNone) {
    open_.clear(std::max((goal_ - start_).norm() / fastest_, 1.0) * 1e-12);
    for (kit::DirectionMask left = lattice.steps(); left != 0; left &= left - 1) {
      longest_leg_ = std::max(longest_leg_, lattice.step_length(__builtin_ctz(left)));
    }
    for (const Vec3& end : {start_, goal_}) {
      for (const kit::Lattice::Link& link : lattice.links(end)) {
        longest_leg_ = std::max(longest_leg_, link.length);
      }
    }
  }

  PlanResult run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (!open_.empty()) {
      const std::uint32_t index = open_.pop().node;
      if (index == kGoal) {
        return with_times(goal_parent_, true, false);
      }
      if (states_[index].closed) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
        status = ended();
        break;
      }
      states_[index].closed = true;
      expand(index);
    }
    if (fallback_ != kNone) {
      return with_times(fallback_, false, status != PlanStatus::no_route);
    }
    progress_.memory_full = memory_full();
    PlanResult result = without(status, true).result;
    result.message += "; among " + std::to_string(movers_.size()) + " moving obstacles";
    return result;
  }

 private:
  static constexpr std::uint32_t kGoal = kNone - 1;  ///< the goal on the open list

  void begin() {
    const double now = request_.start.time_s;
    find_unsafe(start_);
    safe_times(unsafe_, now, safe_);
    if (safe_.empty() || safe_.front().begin > now) {
      return;
    }
    const std::vector<kit::Lattice::Link> links = lattice_.links(start_);
    if (links.front().length == 0) {
      const std::uint32_t index = states_of(links.front().cell, start_);
      states_[index].g = now;
      if (!rules_.cell_blocked(links.front().cell)) {
        push(index, links.front().cell);
      }
      return;
    }
    states_.push_back({});
    states_.back().safe = safe_.front();
    states_.back().g = now;
    note_near(start_);
    for (const kit::Lattice::Link& link : links) {
      const Vec3 there = lattice_.position(link.cell);
      if (!rules_.cell_blocked(link.cell) &&
          rules_.any_leg_ok(request_.before_start(), start_, there)) {
        move(0, start_, link.cell, there, link.length);
      }
    }
  }

  /// The first of the cell's states; all are made at once. kNone if it is never safe.
  std::uint32_t states_of(const Cell& c, const Vec3& at) {
    std::uint32_t& first = first_[lattice_.index(c)];
    if (first == kNone) {
      find_unsafe(at);
      safe_times(unsafe_, request_.start.time_s, safe_);
      first = std::uint32_t(states_.size());
      for (const Times& safe : safe_) {
        states_.push_back({});
        states_.back().safe = safe;
        states_.back().cell = lattice_.index(c);
        states_.back().last = &safe == &safe_.back();
      }
      if (safe_.empty()) {  // one that no vehicle reaches
        states_.push_back({});
        states_.back().cell = lattice_.index(c);
      }
    }
    return first;
  }

  static double fastest_of(const Vehicle& vehicle) {
    const double vertical = std::max(vehicle.climb_mps, vehicle.sink_mps);
    return std::isfinite(vertical) ? std::hypot(vehicle.speed_mps, vertical) : vehicle.speed_mps;
  }
  double seconds(const Vec3& from, const Vec3& to, double length) const {
    const Vehicle& vehicle = request_.vehicle;
    const bool has_rate = std::isfinite(vehicle.climb_mps) || std::isfinite(vehicle.sink_mps);
    return has_rate ? leg_duration(Leg::straight(from, to), request_) : length / vehicle.speed_mps;
  }

  void push(std::uint32_t index, const Cell& c) {
    ++progress_.generated;
    const double g = states_[index].g;
    open_.push(g + to_goal_(c) / fastest_, g, index);
  }

  /// Sets `unsafe_` to the times at which a vehicle at p meets something.
  void find_unsafe(const Vec3& p) {
    unsafe_.clear();
    for (const Mover& mover : movers_) {
      if (const Times times = unsafe_at(p, mover);
          !times.empty() && times.end > request_.start.time_s) {
        unsafe_.push_back(times);
      }
    }
    for (const Closure& closure : closures_) {
      if (closure.what->blocked(p, p, needed_)) {
        unsafe_.insert(unsafe_.end(), closure.closed.begin(), closure.closed.end());
      }
    }
  }

  /// Notes the movers, and the closures, that come near any leg from p.
  void note_near(const Vec3& p) {
    near_closures_.clear();
    for (const Closure& closure : closures_) {
      if (closure.what->blocked(p, p, needed_ + longest_leg_)) {
        near_closures_.push_back(&closure);
      }
    }
    near_.clear();
    for (const Mover& mover : movers_) {
      if (const Times times = unsafe_at(p, mover, longest_leg_); !times.empty()) {
        near_.push_back({&mover, times});
      }
    }
  }

  /// The earliest departure from `from_s` to `until_s` on a leg from p to q that meets no mover;
  /// infinite if there is none.
  double departure(double from_s, double until_s) const {
    for (std::size_t i = 0; i < unsafe_departures_.size() && from_s <= until_s; ++i) {
      // Sorted by their begin: an interval once behind stays behind.
      const Times& times = unsafe_departures_[i];
      if (times.begin < from_s && from_s < times.end) {
        from_s = times.end;
      }
    }
    return from_s <= until_s ? from_s : kInfinity;
  }

  void find_unsafe_departures(const State& from, const Vec3& p, const Vec3& q, double duration) {
    unsafe_departures_.clear();
    for (const Near& near : near_) {
      if (near.times.end <= from.g || near.times.begin >= from.safe.end + duration) {
        continue;
      }
      if (const Times times = unsafe_departures(p, q, duration, *near.mover); !times.empty()) {
        unsafe_departures_.push_back(times);
      }
    }
    for (const Closure* closure : near_closures_) {
      if (closure->what->blocked(p, q, needed_)) {
        for (const Times& times : closure->closed) {
          unsafe_departures_.push_back({times.begin - duration, times.end});
        }
      }
    }
    std::sort(unsafe_departures_.begin(), unsafe_departures_.end(),
              [](const Times& a, const Times& b) { return a.begin < b.begin; });
  }

  /// Reaches every safe interval of the cell that a leg from the state reaches, as early as it
  /// does.
  void move(std::uint32_t from, const Vec3& p, const Cell& c, const Vec3& q, double length) {
    const double duration = seconds(p, q, length);
    std::uint32_t to = states_of(c, q);
    const State here = states_[from];
    bool is_known = false;
    for (bool more = true; more; ++to) {
      State& there = states_[to];
      more = !there.last;
      if (there.closed || there.safe.empty() || there.safe.end < here.g + duration ||
          there.safe.begin > here.safe.end + duration ||
          std::max(there.safe.begin, here.g + duration) >= there.g) {
        continue;
      }
      if (!is_known) {
        find_unsafe_departures(here, p, q, duration);
        is_known = true;
      }
      const double leaves = departure(std::max(here.g, there.safe.begin - duration),
                                      std::min(here.safe.end, there.safe.end - duration));
      const double arrives = std::max(leaves + duration, there.safe.begin);
      if (arrives < there.g) {
        there.g = arrives;
        there.departure = leaves;
        there.parent = from;
        push(to, c);
      }
    }
  }

  void expand(std::uint32_t index) {
    const Cell c = lattice_.cell(states_[index].cell);
    const Vec3 here = position_of(index);
    ++progress_.expanded;
    remember_nearest(here);
    if (request_.trace != nullptr) {
      const State& state = states_[index];
      request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(index),
                           state.parent == kNone ? -1 : std::int64_t(state.parent), here,
                           state.g + to_goal_(c) / fastest_});
    }
    note_near(here);
    try_goal(index, c, here);
    kit::DirectionMask free =
        rules_.legs_free(std::nullopt, c, here, rules_.candidates(c, kit::kHere));
    for (; free != 0; free &= free - 1) {
      const int d = __builtin_ctz(free);
      const Cell o = kit::offset(d);
      const Cell to{c[0] + o[0], c[1] + o[1], c[2] + o[2]};
      move(index, here, to, lattice_.position(to), lattice_.step_length(d));
    }
  }

  void try_goal(std::uint32_t index, const Cell& c, const Vec3& here) {
    const State& state = states_[index];
    if (const kit::Lattice::Link* link = to_goal_.link_of(c)) {
      if (link->length == 0 || rules_.any_leg_ok(std::nullopt, here, goal_)) {
        const double duration = seconds(here, goal_, link->length);
        find_unsafe_departures(state, here, goal_, duration);
        const double leaves = link->length == 0 ? state.g : departure(state.g, state.safe.end);
        if (leaves + duration < goal_g_) {
          goal_g_ = leaves + duration;
          goal_departure_ = leaves;
          goal_parent_ = index;
          open_.push(goal_g_, goal_g_, kGoal);
        }
        return;
      }
    }
    if (request_.goal.reached_at(here) && (fallback_ == kNone || state.g < states_[fallback_].g)) {
      fallback_ = index;
    }
  }

  bool memory_full() const {
    return first_.size() * sizeof(std::uint32_t) + states_.capacity() * sizeof(State) +
               open_.bytes() >
           settings_.max_bytes;
  }

  /// The start, where it is the centre of its cell but for rounding.
  Vec3 position_of(std::uint32_t index) const {
    const State& state = states_[index];
    return state.parent == kNone ? start_ : lattice_.position(lattice_.cell(state.cell));
  }

  /// The route over the states to `last`, with the waits between arrivals and departures.
  PlanResult with_times(std::uint32_t last, bool at_goal, bool budget_hit) const {
    struct Stop {
      Vec3 at;
      double wait_s;
    };
    std::vector<Stop> stops;
    double left = at_goal ? goal_departure_ : states_[last].g;
    for (std::uint32_t index = last; index != kNone; index = states_[index].parent) {
      stops.push_back({position_of(index), left - states_[index].g});
      left = states_[index].departure;
    }
    if (at_goal && to_goal_.link_of(lattice_.cell(states_[last].cell))->length == 0 &&
        stops.size() > 1) {
      stops.front().at = goal_;
    } else if (at_goal) {
      stops.insert(stops.begin(), {goal_, 0});
    }
    Route route{stops.back().at};
    double waits = 0;
    for (auto stop = stops.rbegin(); stop != stops.rend(); ++stop) {
      if (stop != stops.rbegin()) {
        route.push_back(Leg::straight(route.back(), stop->at));
      }
      if (stop->wait_s > 0) {
        route.push_back(Leg::hold(stop->at, stop->wait_s));
        waits += stop->wait_s;
      }
    }
    const double arrival = at_goal ? goal_g_ : states_[last].g;
    PlanResult result = with({}, arrival, at_goal, budget_hit).result;
    result.message = "a route of " + std::to_string(length(route)) + " m in " +
                     std::to_string(arrival - request_.start.time_s) + " s, " +
                     std::to_string(waits) + " s of them waiting, among " +
                     std::to_string(movers_.size()) + " moving obstacles; " +
                     std::to_string(progress_.expanded) + " states expanded";
    result.route = std::move(route);
    return result;
  }

  struct Near {
    const Mover* mover;
    Times times;  ///< at which it is near
  };

  const std::vector<Mover>& movers_;
  const std::vector<Closure>& closures_;
  double needed_;                     ///< distance from closures
  double fastest_;                    ///< speed in the fastest direction
  double longest_leg_ = 0;            ///< of steps and links
  std::vector<std::uint32_t> first_;  ///< by cell: the first of its states
  std::vector<State> states_;
  kit::OpenList open_;
  std::vector<Near> near_;  ///< of the state that is expanded
  std::vector<const Closure*> near_closures_;
  std::vector<Times> unsafe_departures_;
  std::vector<Times> unsafe_;
  std::vector<Times> safe_;
  double goal_g_ = kInfinity;
  double goal_departure_ = 0;
  std::uint32_t goal_parent_ = kNone;
  std::uint32_t fallback_ = kNone;  ///< within the goal's tolerance, where it has no link
};
}  // namespace altiplan::sipp
