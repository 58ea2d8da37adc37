// SPDX-License-Identifier: Apache-2.0
#include "altiplan/check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "altiplan/drawing.hpp"
#include "altiplan/energy.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/total_limit.hpp"
#include "leg_judge.hpp"
#include "moving.hpp"
#include "words.hpp"

namespace altiplan {
namespace {
/// Calls `judge(request)` in each wind: a leg of which no time is known may be flown in any.
template <class Judge>
void in_every_wind(const Request& request, const Judge& judge) {
  if (request.wind.changes.empty()) {
    judge(request);
    return;
  }
  Request then = request;
  then.wind = request.wind.in_force(-kInfinity);
  judge(then);
  for (const Wind::Change& change : request.wind.changes) {
    then.wind = request.wind.in_force(change.from_s);
    judge(then);
  }
}
}  // namespace

bool leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
            const Request& request) {
  bool ok = true;
  const auto note = [&](const auto&) { return ok = false; };
  in_every_wind(request,
                [&](const Request& then) { LegJudge(before, a, b, then, 0, note).judge(); });
  return ok;
}

bool leg_ok(const std::optional<Approach>& before, const Leg& leg, const Request& request) {
  bool ok = true;
  const auto note = [&](const auto&) { return ok = false; };
  in_every_wind(request,
                [&](const Request& then) { LegJudge(before, leg, then, 0, note).judge(); });
  return ok;
}

bool turn_ok(const Approach& before, const Vec3& a, const Vec3& b, const Request& request) {
  bool ok = true;
  const auto note = [&](const auto&) { return ok = false; };
  const std::optional<Approach> approach = before;
  LegJudge(approach, a, b, request, 0, note).judge_bend();
  return ok;
}

std::vector<Violation> leg_violations(const std::optional<Approach>& before, const Leg& leg,
                                      const Request& request, std::size_t index) {
  std::vector<Violation> all;
  const auto add = [&](const auto& violation) {
    Violation found = violation();
    const bool is_one_wind = request.wind.changes.empty();
    if (is_one_wind || std::find(all.begin(), all.end(), found) == all.end()) {
      all.push_back(std::move(found));
    }
    return true;
  };
  in_every_wind(request,
                [&](const Request& then) { LegJudge(before, leg, then, index, add).judge(); });
  return all;
}

namespace {
/// The chords of a route as constraints see them, and the leg of each point; the last point is the
/// last waypoint.
Polyline chords_of(const Route& route, std::vector<std::size_t>& leg_of) {
  Polyline points;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Polyline part = route.leg(i).chords(kChordTolerance);
    points.insert(points.end(), part.begin(), part.end() - 1);
    leg_of.resize(points.size(), i);
  }
  points.push_back(route.back());
  leg_of.push_back(route.leg_count());
  return points;
}

void check_course(const Vec3& course, const Vec3& wanted, const char* rule, std::size_t at,
                  const char* what, std::vector<Violation>& found) {
  const double off = turn_angle_horizontal(course, wanted);
  if (off > kAngleTolerance && off * std::max(1.0, course.norm()) > kLengthTolerance) {
    found.push_back(beyond(rule, at, degrees(off), 0, "deg", what, false));
  }
}

/// The ends of a route that is not empty; a loiter circle is left tangentially.
void check_ends(const Route& route, const Request& request, std::vector<Violation>& found) {
  const State& start = request.start;
  const Goal& goal = request.goal;
  const auto off_circle = [](const Loiter& loiter, const Vec3& centre, const Vec3& p) {
    const double across = std::hypot(p.x() - centre.x(), p.y() - centre.y()) - loiter.radius;
    return std::hypot(across, p.z() - centre.z());
  };
  if (!start.starts_at(route.front())) {
    const double off = start.loiter ? off_circle(*start.loiter, start.position, route.front())
                                    : (route.front() - start.position).norm();
    found.push_back({"start", 0, off, 0,
                     "the route begins " + distance_text(off) + " m from the " +
                         (start.loiter ? "loiter circle of the start" : "start"),
                     "", "m"});
  } else if (start.loiter) {
    std::size_t first = 0;
    while (first < route.leg_count() && !route.leg(first).has_heading()) {
      ++first;
    }
    if (first < route.leg_count()) {
      check_course(route.leg(first).track(0), start.loiter->course(start.position, route.front()),
                   "start_heading", first, "the angle between the first leg and the loiter circle",
                   found);
    }
  }
  if (!goal.reached_at(route.back())) {
    const double off = goal.loiter ? off_circle(*goal.loiter, goal.position, route.back())
                                   : (route.back() - goal.position).norm();
    found.push_back(
        {"goal", route.size() - 1, off, goal.tolerance_m,
         goal.loiter
             ? "the route ends " + distance_text(off) + " m from the loiter circle of the goal"
             : "the route ends " + fixed(off) + " m from the goal, whose tolerance is " +
                   fixed(goal.tolerance_m) + " m",
         "", "m"});
  }
}
}  // namespace

namespace {
/// Of the legs themselves: chords of a turn are shorter than it.
std::vector<Violation> total_violations(const NamedConstraint& named, const TotalLimit& limit,
                                        const Route& route, const Request& request) {
  std::vector<Violation> all =
      answer_of(named, [&](const Constraint&) { return limit.violations_of(route, request); });
  for (Violation& violation : all) {
    violation.constraint = named.name;
  }
  return all;
}
}  // namespace

CheckResult check(const Route& route, const Request& request) {
  CheckResult result;
  std::vector<Violation>& found = result.violations;
  if (route.empty()) {
    found.push_back({"route", 0, 0, 0, "there is no route"});
    return result;
  }
  check_ends(route, request, found);
  if (request.vehicle.body != nullptr && !request.wind.changes.empty()) {
    found.push_back(
        {"body", 0, 0, 0, "how the vehicle's body turns where the wind changes is not judged"});
  }
  Arrival arrival{request.before_start(route.front()), request.start.time_s};
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    if (const double gap = (leg.from - route[i]).norm(); !(gap <= kLengthTolerance)) {
      found.push_back({"route", i, gap, 0,
                       "the leg begins " + distance_text(gap) + " m from the end of the one before",
                       "", "m"});
    }
    for (Violation& violation : leg_violations(arrival, leg, request, i)) {
      found.push_back(std::move(violation));
    }
    const double after_s = arrival.time_s - request.start.time_s;
    if (request.objective && !std::isfinite(request.objective->cost(leg, after_s, request))) {
      found.push_back({"objective", i, kInfinity, kInfinity,
                       "the objective has no cost for the leg: part of it lies where no value is "
                       "given"});
    }
    arrival = arrival.onward(leg, request);
  }
  if (request.objective && request.objective->traits().waypoints &&
      !std::isfinite(cost_of(route, request)) &&
      std::none_of(found.begin(), found.end(),
                   [](const Violation& v) { return v.constraint == "objective"; })) {
    found.push_back({"objective", 0, kInfinity, kInfinity,
                     "the objective has no cost for the route as a whole"});
  }
  Request then = request;
  then.wind = request.wind.in_force(arrival.time_s);
  const std::optional<Approach>& before = arrival.before;
  if (const auto course = then.arrival_course(route.back()); course && before) {
    const Vec3 heading = before->heading_at(route.back());
    // On a border of layers of wind, that of the last leg may be the one below.
    const Vec3 below = route.back() - Vec3(0, 0, kLengthTolerance);
    const Vec3 other = *then.arrival_course(below);
    const bool is_other =
        turn_angle_horizontal(heading, other) < turn_angle_horizontal(heading, *course);
    check_course(heading, is_other ? other : *course, "goal_heading", route.size() - 1,
                 "the angle between the course on arrival and the goal's", found);
  }
  for (Violation& violation : moving_violations(route, request)) {
    found.push_back(std::move(violation));
  }
  const double total = length(route);
  if (total > request.limits.max_route_length + kLengthTolerance) {
    found.push_back(beyond("route_length", 0, total, request.limits.max_route_length, "m",
                           "the route's length", false));
  }
  if (request.vehicle.energy != nullptr) {
    if (const auto violation = energy_violation(
            flown_energy(route, request, *request.vehicle.energy->power), request.vehicle)) {
      found.push_back(*violation);
    }
  }
  std::vector<std::size_t> leg_of;
  const Polyline points = route.is_straight() ? route.waypoints() : chords_of(route, leg_of);
  for (const NamedConstraint& named : request.constraints) {
    const auto* limit = dynamic_cast<const TotalLimit*>(named.constraint.get());
    for (Violation& violation : limit != nullptr ? total_violations(named, *limit, route, request)
                                                 : violations_of(named, points, request)) {
      violation.at = leg_of.empty() ? violation.at : leg_of[violation.at];
      if (std::find(found.begin(), found.end(), violation) == found.end()) {  // of a leg
        found.push_back(std::move(violation));
      }
    }
  }
  return result;
}

namespace {
/// ": 'Prison'", the part of the layer that a violation at a place is of, where it has a name.
std::string part_of(const Violation& violation, const Vec3& p, const Request& request) {
  const Layer* layer = request.world->find(violation.layer);
  const auto drawing = layer != nullptr ? layer->environment->drawing() : std::nullopt;
  const std::string part = drawing ? name_at(*drawing, p) : "";
  return part.empty() || part == violation.layer ? "" : ": '" + part + "'";
}
}  // namespace

std::string point_problem(const Vec3& p, const Request& request) {
  // A point has no leg: violations that only a leg of zero length has are left out.
  const std::vector<Violation> found = [&] {
    if (request.limits.min_leg <= 0 && request.constraints.empty()) {
      return leg_violations(std::nullopt, Leg::straight(p, p), request, 0);
    }
    Request alone = request;
    alone.limits.min_leg = 0;
    alone.constraints.clear();
    return leg_violations(std::nullopt, Leg::straight(p, p), alone, 0);
  }();
  return found.empty() ? ""
                       : place(p) + " cannot be flown: " + found.front().message +
                             part_of(found.front(), p, request);
}

namespace {
std::string loiter_problem(const Vec3& centre, const Loiter& loiter, const Request& request) {
  const bool is_one =
      request.wind.changes.empty() && request.wind.is_uniform(loiter.circle(centre).box());
  const double wind = is_one ? request.wind.at(centre).norm() : request.wind.max_speed();
  const std::string which = "circle of radius " + fixed(loiter.radius) + " m around " +
                            place(centre) + " cannot be flown: ";
  if (wind >= request.air_speed()) {
    return which + "the wind of " + fixed(wind) + " m/s is as fast as the aeroplane (" +
           fixed(request.air_speed()) + " m/s)";
  }
  Request alone = request;
  alone.limits.min_leg = 0;
  alone.limits.max_leg = kInfinity;
  alone.constraints.clear();
  // The circle is flown over the ground: downwind at the greatest speed, which takes a bank angle
  // of tan = speed² / (g radius) where the limit's circle takes airspeed² / (g radius).
  const double fastest = 1 + wind / request.air_speed();
  alone.limits.min_turn_radius *= fastest * fastest;
  alone.wind = {};
  const std::vector<Violation> found =
      leg_violations(std::nullopt, loiter.circle(centre), alone, 0);
  return found.empty() ? "" : which + found.front().message;
}
}  // namespace

std::string start_problem(const Request& request) {
  const State& start = request.start;
  return start.loiter ? loiter_problem(start.position, *start.loiter, request)
                      : point_problem(start.position, request);
}

std::string goal_problem(const Request& request) {
  const Goal& goal = request.goal;
  return goal.loiter ? loiter_problem(goal.position, *goal.loiter, request)
                     : point_problem(goal.position, request);
}

namespace {
/// True if every limit is at least as tight as it was; false if one is not a number.
bool no_looser(const Limits& now, const Limits& was) {
  const auto ground = [](const Limits& limits) {
    return limits.min_ground_clearance.value_or(-kInfinity);
  };
  return now.min_clearance >= was.min_clearance && ground(now) >= ground(was) &&
         now.altitude.size() >= was.altitude.size() && now.min_leg >= was.min_leg &&
         now.max_leg <= was.max_leg && now.max_turn_horizontal <= was.max_turn_horizontal &&
         now.max_turn_space <= was.max_turn_space && now.min_turn_radius >= was.min_turn_radius &&
         now.max_climb <= was.max_climb && now.max_descent() <= was.max_descent() &&
         now.max_route_length <= was.max_route_length &&
         std::equal(was.altitude.begin(), was.altitude.end(), now.altitude.begin(),
                    [](const AltitudeBand& a, const AltitudeBand& b) {
                      return a.datum == b.datum && b.min >= a.min && b.max <= a.max;
                    }) &&
         std::none_of(now.altitude.begin(), now.altitude.end(), [](const AltitudeBand& band) {
           return std::isnan(band.min) || std::isnan(band.max);
         });
}
}  // namespace

void apply_constraints(Request& request, std::vector<NamedConstraint> constraints, AppliesTo to) {
  request.limits = Limits{};
  request.limits.min_clearance = request.vehicle.radius_m;
  if (request.vehicle.wing) {
    request.limits.min_turn_radius = request.vehicle.wing->turn_radius();
    request.limits.max_climb = request.vehicle.wing->climb;
    request.limits.max_sink = request.vehicle.wing->sink;
  }
  request.constraints.clear();
  for (NamedConstraint& named : constraints) {
    const AppliesTo applies = named.constraint->applies_to();
    if (applies == AppliesTo::both || applies == to) {
      const Limits before = request.limits;
      answer_of(named, [&](const Constraint& asked) { asked.tighten(request.limits, request); });
      if (!no_looser(request.limits, before)) {
        throw PluginError(
            "the constraint '" + named.name +
            "' violated the contract of its interface: it loosened a limit or set it to NaN");
      }
      named.admits_all =
          answer_of(named, [](const Constraint& asked) { return asked.admits_all(); });
      request.constraints.push_back(std::move(named));
    }
  }
}
}  // namespace altiplan
