// SPDX-License-Identifier: Apache-2.0
#include "host/flight.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

#include "altiplan/error.hpp"
#include "host/flight_path.hpp"
#include "host/flight_world.hpp"

namespace altiplan::host {
namespace {

constexpr double kMargin = 0.05;         ///< of the pilot's reach: nearer than this the pilot flies
constexpr double kClearMargin = 0.075;   ///< and beyond this the route is clear again
constexpr double kLeastWay = 1e-3;       ///< metres: the rest of a leg is flown with the step
const double kGentleTurn = radians(30);  ///< of a hand-back, at both ends of its leg
constexpr int kMostStuck = 3;
constexpr int kMostSteps = 1'000'000;
constexpr double kTimesDuration = 10;

std::string place(const Vec3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.0f, %.0f, %.0f)", p.x(), p.y(), p.z());
  return text;
}

class Flight {
 public:
  explicit Flight(const FlightSetup& setup)
      : setup_(setup),
        world_(setup),
        request_(setup.request),
        path_(setup.route),
        events_(setup.events),
        state_(setup.request.start),
        before_(setup.request.before_start()),
        required_(std::max(request_.limits.min_clearance, request_.vehicle.radius_m)) {
    if (setup.pilot != nullptr) {
      pilot_ = setup.pilot->begin(setup.request);
      reach_ = pilot_->reach_m();
    }
    result_.track.emplace_back(state_.time_s, state_.position);
  }

  FlightResult run() {
    const double end = state_.time_s + max_time();
    if (setup_.always && pilot_ != nullptr) {
      hand_over(true, "the pilot flies all the way");
    }
    while (!ended_ && !request_.goal.reached_at(state_.position)) {
      if (state_.time_s >= end || ++steps_ > kMostSteps) {
        end_flight(Status::not_reached, "the flight's time ended at " + place(state_.position) +
                                            ", " + away() + " from the goal");
        break;
      }
      if (setup_.request.budget.stop.stop_requested()) {
        end_flight(Status::cancelled, "stopped at " + place(state_.position));
        break;
      }
      meet_events();
      sense();
      replan_when_due();
      if (pilot_commands_) {
        fly_pilot();
      } else {
        fly_route();
      }
    }
    finish();
    return std::move(result_);
  }

 private:
  double max_time() const {
    if (setup_.max_time_s) {
      return *setup_.max_time_s;
    }
    double duration = 0;
    for (std::size_t i = 0; i + 1 < setup_.route.size(); ++i) {
      duration += leg_duration(*setup_.request.world, setup_.request.vehicle, setup_.route[i],
                               setup_.route[i + 1]);
    }
    return std::max(kTimesDuration * duration, 10 * setup_.step_s);
  }

  std::string away() const {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f m", (request_.goal.position - state_.position).norm());
    return text;
  }

  void end_flight(Status status, std::string message) {
    ended_ = true;
    result_.status = status;
    result_.message = std::move(message);
  }

  void hand_over(bool to_pilot, std::string why) {
    pilot_commands_ = to_pilot;
    result_.handovers.push_back(
        {state_.time_s, to_pilot ? setup_.pilot_name : "route", std::move(why)});
  }

  // Events and sensing.

  void meet_events() {
    for (auto event = events_.begin(); event != events_.end();) {
      const bool due = (event->at_s && state_.time_s >= *event->at_s) ||
                       (event->when_near && (state_.position - event->when_near->at).norm() <=
                                                event->when_near->within_m);
      if (!due) {
        ++event;
        continue;
      }
      if (event->kind == FlightEvent::Kind::move_goal) {
        request_.goal.position = event->vector;
        path_.move_end(pilot_commands_ ? path_.at(progress_) : state_.position, progress_,
                       event->vector);
        progress_ = 0;
        end_moved_ = true;
        ask_replan();
      } else {
        world_.apply(*event, state_.time_s);
      }
      event = events_.erase(event);
    }
  }

  void sense() {
    const std::vector<Change> changes = world_.sense(state_.position, state_.time_s);
    request_.world = world_.known();
    changes_.insert(changes_.end(), changes.begin(), changes.end());
    replan_changes_.insert(replan_changes_.end(), changes.begin(), changes.end());
    if (setup_.replanner == nullptr) {
      return;
    }
    if ((setup_.when == ReplanWhen::any_change && !changes.empty()) ||
        (!world_.fresh().empty() && rest_is_blocked())) {
      ask_replan();
    }
  }

  // What the route ahead meets.

  /// A layer that the route was not planned around and that comes nearer than `room` to the leg.
  const std::string* unplanned_near(const Vec3& a, const Vec3& b, double room) const {
    for (const Layer& layer : request_.world->layers()) {
      if (world_.fresh().count(layer.id) > 0 && layer.environment->blocked(a, b, room)) {
        return &layer.id;
      }
      if (end_moved_ && layer.environment->blocked(a, b, required_)) {
        return &layer.id;
      }
    }
    return nullptr;
  }

  bool rest_is_blocked() const {
    bool blocked = false;
    path_.for_each_leg(progress_, path_.length(), [&](const Vec3& a, const Vec3& b) {
      blocked = blocked || unplanned_near(a, b, required_) != nullptr;
    });
    return blocked;
  }

  /// The same with moving obstacles, for a leg begun at time t0.
  const std::string* danger_on(const Vec3& a, double t0, const Vec3& b, double t1,
                               double room) const {
    if (const std::string* layer = unplanned_near(a, b, room)) {
      return layer;
    }
    for (const MovingObstacle& obstacle : request_.world->moving()) {
      if (hits(obstacle, a, t0, b, t1, room)) {
        return &obstacle.id;
      }
    }
    return nullptr;
  }

  /// What endangers the stretch of path from `from` on, as far as the pilot reaches.
  const std::string* danger_ahead(double from, double t, double speed, double room) const {
    const std::string* danger = nullptr;
    path_.for_each_leg(from, from + reach_, [&](const Vec3& a, const Vec3& b) {
      const double t1 = t + (b - a).norm() / speed;
      if (danger == nullptr) {
        danger = danger_on(a, t, b, t1, room);
      }
      t = t1;
    });
    return danger;
  }

  double speed() const {
    return request_.vehicle.speed_at(request_.world->clearance(state_.position));
  }

  // The route.

  void fly_route() {
    if (pilot_ != nullptr) {
      const double room = required_ + kMargin * reach_;
      if (const std::string* danger = danger_ahead(progress_, state_.time_s, speed(), room)) {
        hand_over(true, "the route ahead comes too near to '" + *danger + "'");
        fly_pilot();
        return;
      }
    }
    double left = setup_.step_s;
    while (!ended_ && left > 0) {
      const Vec3 next = path_.next_waypoint(progress_);
      const Vec3 way = next - state_.position;
      const double to_next = way.norm();
      if (to_next <= kLeastWay && progress_ + kLeastWay >= path_.length()) {
        if (!request_.goal.reached_at(state_.position)) {
          end_flight(Status::not_reached, "the route ended " + away() + " from the goal");
        }
        return;
      }
      if (to_next == 0) {
        progress_ = path_.end_of_leg(progress_);
        continue;
      }
      const double v = speed();
      const bool whole = to_next - v * left <= kLeastWay;
      const double run = whole ? to_next : v * left;
      progress_ = whole ? path_.end_of_leg(progress_) : progress_ + run;
      const double dt = run / v;
      fly_leg({state_.time_s + dt, whole ? next : Vec3(state_.position + way / to_next * run),
               way / to_next * v});
      left -= dt;
      if (request_.goal.reached_at(state_.position)) {
        return;
      }
    }
  }

  // The pilot.

  void fly_pilot() {
    progress_ = path_.nearest(state_.position, progress_, progress_ + 2 * reach_);
    if (!setup_.always && hand_back()) {
      fly_route();
      return;
    }
    rest_.clear();
    path_.append_waypoints_after(progress_, rest_);
    Observation seen;
    seen.state = state_;
    seen.local_target = local_target();
    seen.goal = request_.goal;
    seen.rest = rest_;
    seen.world = request_.world.get();
    seen.changes = changes_;
    seen.moving = world_.sensed(state_.position, state_.time_s);
    seen.max_dt_s = setup_.step_s;
    PilotStep step = pilot_->step(seen);
    changes_.clear();
    if (step.outcome == PilotStep::Outcome::stuck) {
      stuck(std::string(step.why));
      return;
    }
    const double dt = step.next.time_s - state_.time_s;
    const double run = (step.next.position - state_.position).norm();
    if (run > top_speed() * dt * (1 + 1e-6) + kLengthTolerance) {
      throw PluginError("broke a law of its interface: a step faster than the vehicle");
    }
    fly_leg(step.next);
  }

  double top_speed() const {
    double top = request_.vehicle.speed_mps;
    for (const SpeedNear& near : request_.vehicle.speed_near) {
      top = std::max(top, near.speed_mps);
    }
    return top;
  }

  void stuck(const std::string& why) {
    ask_replan();
    if (++stuck_ > kMostStuck) {
      end_flight(Status::not_reached, "the pilot '" + setup_.pilot_name + "' is stuck at " +
                                          place(state_.position) + ", " + away() +
                                          " from the goal: " + why);
    }
  }

  /// A point of the path half the pilot's reach ahead, farther where that is covered.
  Vec3 local_target() const {
    double s = progress_ + reach_ / 2;
    while (s < path_.length() && !is_free(path_.at(s))) {
      s += reach_ / 20;
    }
    return s < path_.length() ? path_.at(s) : request_.goal.position;
  }

  bool is_free(const Vec3& p) const {
    const double room = required_ + kMargin * reach_;
    return unplanned_near(p, p, room) == nullptr &&
           std::none_of(request_.world->moving().begin(), request_.world->moving().end(),
                        [&](const MovingObstacle& moving) {
                          return signed_distance(moving.at(state_.time_s), p) < room;
                        });
  }

  /// Takes the nearest way back to the path that stays clear; false where there is none.
  bool hand_back() {
    const double room = required_ + kClearMargin * reach_;
    for (int k = 1; k <= 8; ++k) {
      const double s = std::min(progress_ + reach_ * k / 8, path_.length());
      const Vec3 q = path_.at(s);
      const Vec3 leg = q - state_.position;
      if (leg.norm() <= kLeastWay) {
        continue;
      }
      const Vec3 onward = s < path_.length() ? Vec3(path_.next_waypoint(s) - q) : leg;
      const double t1 = state_.time_s + leg.norm() / speed();
      if (turn_angle_in_space(state_.velocity, leg) <= kGentleTurn &&
          turn_angle_in_space(leg, onward) <= kGentleTurn &&
          leg_ok(before_, state_.position, q, request_) &&
          danger_on(state_.position, state_.time_s, q, t1, room) == nullptr &&
          danger_ahead(s, t1, speed(), room) == nullptr) {
        path_.rejoin(state_.position, s);
        progress_ = 0;
        hand_over(false, "clear: a straight leg leads back to the route");
        return true;
      }
      if (s == path_.length()) {
        break;
      }
    }
    return false;
  }

  // One leg flown, by whomever.

  void fly_leg(const State& next) {
    const Vec3 a = state_.position;
    const double t0 = state_.time_s;
    const double t1 = next.time_s;
    const Vec3& b = next.position;
    if (a == b) {
      state_ = next;
      return;
    }
    separation_ = world_.separation_below(separation_, a, t0, b, t1);
    Request truth = track_request_in_truth();
    for (Violation& violation : leg_violations(before_, a, b, truth, result_.track.size() - 1)) {
      result_.check.violations.push_back(std::move(violation));
    }
    result_.track.emplace_back(t1, b);
    before_ = a;
    state_ = next;
    if (const std::string* met = world_.contact(a, t0, b, t1, request_.vehicle.radius_m)) {
      ++result_.collisions;
      end_flight(Status::collided, "collided with '" + *met + "' near " + place(b));
    }
  }

  Request track_request_in_truth() const {
    Request request = request_;
    request.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), &world_.truth());
    return request;
  }

  // Replanning.

  void ask_replan() {
    if (setup_.replanner != nullptr && !replan_due_ && state_.time_s >= next_replan_) {
      replan_due_ = state_.time_s + setup_.replan_latency_s;
    }
  }

  /// The new route begins where the vehicle is when it comes.
  void replan_when_due() {
    if (!replan_due_ || state_.time_s < *replan_due_) {
      return;
    }
    replan_due_.reset();
    next_replan_ = state_.time_s + std::max(10.0, setup_.replan_latency_s);
    Request request = setup_.route_request;
    request.start = state_;
    request.goal = request_.goal;
    request.world = world_.known();
    if (setup_.replan_within_s) {
      request.budget.deadline =
          Budget::Clock::now() + std::chrono::duration_cast<Budget::Clock::duration>(
                                     std::chrono::duration<double>(*setup_.replan_within_s));
    }
    const auto began = std::chrono::steady_clock::now();
    const PlanResult plan = setup_.replanner->update(state_, request.goal, request.world,
                                                     replan_changes_, request.budget);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    replan_changes_.clear();
    result_.replans.push_back(
        {state_.time_s, setup_.replan_step, took.count(), plan.status, plan.counters});
    if (plan.status != Status::solved || !check(plan.route, request).ok()) {
      return;
    }
    Route route = plan.route;
    for (const Smoother* smoother : setup_.smoothers) {
      const PlanResult smooth = smoother->smooth(route, request);
      if (smooth.status == Status::solved && check(smooth.route, request).ok()) {
        route = smooth.route;
      }
    }
    path_ = FlightPath(std::move(route));
    progress_ = 0;
    stuck_ = 0;
    end_moved_ = false;
    world_.route_is_new();
    if (pilot_commands_ && !setup_.always) {
      hand_over(false, "a new route");
    }
  }

  // The end.

  void finish() {
    result_.reached = !ended_ && request_.goal.reached_at(state_.position);
    Request truth = track_request_in_truth();
    Route track;
    for (const auto& [t, p] : result_.track) {
      track.push_back(p);
    }
    result_.measures = measure(track, truth);
    result_.measures.duration_s = state_.time_s - setup_.request.start.time_s;
    if (std::isfinite(separation_)) {
      result_.min_separation_m = separation_;
    }
    if (pilot_ != nullptr) {
      result_.counters = pilot_->counters();
    }
    result_.counters.insert(result_.counters.begin(), {"steps", steps_});
    judge_whole(track, truth);
    if (!ended_) {
      const CheckResult& check = result_.check;
      result_.status = check.ok() ? Status::solved : Status::rejected;
      result_.message = check.ok() ? "reached the goal"
                                   : "reached the goal, but " + check.violations.front().message;
    }
  }

  /// What check() asks of a route as a whole; the legs were judged in the world of their time.
  void judge_whole(const Route& track, const Request& request) {
    std::vector<Violation>& found = result_.check.violations;
    if (!result_.reached) {
      found.push_back({"goal", track.size() - 1, (track.back() - request.goal.position).norm(),
                       request.goal.tolerance_m, "the flight ended " + away() + " from the goal"});
    }
    const double total = length(track);
    if (total > request.limits.max_route_length + kLengthTolerance) {
      found.push_back({"route_length", 0, total, request.limits.max_route_length,
                       "the flight is longer than the route may be"});
    }
    for (const NamedConstraint& named : request.constraints) {
      for (Violation& violation : named.constraint->violations(track, request)) {
        violation.constraint = named.name;
        found.push_back(std::move(violation));
      }
    }
  }

  const FlightSetup& setup_;
  FlightWorld world_;
  Request request_;  ///< of the track, in the known world as it is now
  FlightPath path_;
  std::vector<FlightEvent> events_;  ///< still to come
  State state_;
  std::optional<Vec3> before_;
  double required_;
  std::unique_ptr<Pilot> pilot_;
  double reach_ = 0;
  bool pilot_commands_ = false;
  bool ended_ = false;
  bool end_moved_ = false;  ///< the last leg was never judged
  double progress_ = 0;     ///< metres along the path
  double separation_ = kInfinity;
  int steps_ = 0;
  int stuck_ = 0;
  std::optional<double> replan_due_;
  double next_replan_ = -kInfinity;
  std::vector<Change> changes_;         ///< not yet told to the pilot
  std::vector<Change> replan_changes_;  ///< not yet told to the session
  std::vector<Vec3> rest_;
  FlightResult result_;
};
}  // namespace

FlightResult fly(const FlightSetup& setup) {
  if (setup.route.empty() || setup.route.front() != setup.request.start.position) {
    throw Error("a flight needs a route that begins at the start");
  }
  if (!(setup.step_s > 0)) {
    throw Error("step_s must be greater than 0, found " + std::to_string(setup.step_s));
  }
  try {
    return Flight(setup).run();
  } catch (const ParameterError&) {
    throw;
  } catch (const std::exception& error) {
    FlightResult result;
    result.message = "the flight with '" + setup.pilot_name + "' failed: " + error.what();
    result.track = {{setup.request.start.time_s, setup.request.start.position}};
    return result;
  }
}
}  // namespace altiplan::host
