// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/flight/flight_run.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host {
namespace {

constexpr int kMaxSteps = 1'000'000;
constexpr double kTimesDuration = 10;

/// The state in which the route begins: on a loiter circle, at a point that it leaves.
State first_state(const FlightSetup& setup) {
  State start = setup.request.start;
  if (start.loiter) {
    const Vec3& first = setup.route.front();
    const Vec3 course = start.loiter->course(start.position, first);
    const auto heading = setup.request.heading_on(course, first);
    start.velocity = heading ? setup.request.ground_velocity({first, *heading}) : course;
    start.position = first;
    start.loiter.reset();
  }
  return start;
}
}  // namespace

Flight::Flight(const FlightSetup& setup)
    : setup_(setup),
      world_(setup),
      request_(setup.request),
      truth_request_(setup.telemetry ? as_telemetry(setup.request) : setup.request),
      route_{FlightPath(setup.route), 0, 0, {}},
      events_(setup.events),
      state_(first_state(setup)),
      before_(setup.request.before_start(state_.position)),
      required_(std::max(request_.limits.min_clearance, request_.vehicle.radius_m)),
      simulated_(setup.vehicle == nullptr ? simulated_vehicle(request_.vehicle) : nullptr),
      vehicle_(setup.vehicle == nullptr ? simulated_.get() : setup.vehicle) {
  // Non-owning: the true world is owned, and changed, by world_.
  truth_request_.world =
      std::shared_ptr<const World>(std::shared_ptr<const World>(), &world_.truth());
  truth_request_.limits = limits_of_legs(truth_request_);
  result_.track.emplace_back(state_.time_s, state_.position);
}

FlightResult Flight::run() {
  // A failure ends the flight, but keeps the track.
  for (const auto part : {&Flight::fly_to_the_end, &Flight::release, &Flight::finish}) {
    try {
      (this->*part)();
    } catch (const ParameterError&) {
      throw;
    } catch (const VehicleLost& lost) {
      end_flight(RunStatus::not_reached, Reason::none, "");
      result_.message = lost.what();  // no other planner would have helped
    } catch (const std::exception& error) {
      end_flight(RunStatus::failed, reason_of(error),
                 "the flight with '" + setup_.pilot_name + "' failed: " + error.what());
    } catch (...) {
      end_flight(RunStatus::failed, Reason::threw,
                 "the flight with '" + setup_.pilot_name +
                     "' failed: it threw something that is not a std::exception");
    }
  }
  return std::move(result_);
}

void Flight::fly_to_the_end() {
  if (setup_.pilot != nullptr) {
    Request request = setup_.request;
    request.start = state_;
    request.goal = goal_of_pilot();
    pilot_ = setup_.pilot->begin(request);
    reach_ = pilot_->reach_m();
  }
  const double end = state_.time_s + max_time();
  take_off();
  if (setup_.always && pilot_ != nullptr) {
    hand_over(true, "the pilot flies all the way");
  }
  end_on_contact(state_.position, state_.time_s, state_.position, state_.time_s);
  meet_events();
  while (!ended_ && !passes_goal_ && !request_.goal.reached_at(state_.position)) {
    if (setup_.flown_s != nullptr) {
      setup_.flown_s->store(state_.time_s, std::memory_order_relaxed);
    }
    const bool late = state_.time_s >= end;
    if (late || ++steps_ > kMaxSteps) {
      end_flight(RunStatus::not_reached, late ? Reason::deadline : Reason::iterations,
                 (late ? time_out()
                       : "reached the maximum number of steps of a flight (step_s is "
                         "too short for this flight)") +
                     " at " + place(state_.position) + ", " + away() + " from the goal");
    } else if (setup_.request.budget.stop.stop_requested()) {
      end_flight(RunStatus::cancelled, Reason::none, "stopped at " + place(state_.position));
    } else {
      sense();
      replan_when_due();
      pilot_commands_ ? fly_pilot() : fly_route();
    }
  }
}

void Flight::release() { vehicle_->release(); }

void Flight::take_off() {
  const double airspeed = request_.vehicle.wing ? request_.vehicle.wing->airspeed_mps : kInfinity;
  for (const Vec3& place : route_.path.places_across(request_.wind)) {
    if (const double wind = request_.wind.at(place).norm(); wind >= airspeed) {
      char message[160];
      std::snprintf(message, sizeof message,
                    "the wind of %g m/s at a height of %.0f m is not below the airspeed of %g m/s: "
                    "the aeroplane cannot hold its course there",
                    wind, place.z(), airspeed);
      end_flight(RunStatus::not_reached, Reason::none, message);
      return;
    }
  }
  if (setup_.vehicle != nullptr && setup_.route.waits()) {
    end_flight(RunStatus::not_reached, Reason::none,
               "the route waits on its way, which is flown in simulations alone");
    return;
  }
  state_ = vehicle_->take_off(request_, route_, state_);
  result_.track.front() = {state_.time_s, state_.position};
}

double Flight::max_time() const {
  if (setup_.max_time_s) {
    return *setup_.max_time_s;
  }
  double duration = 0;
  for (std::size_t i = 0; i < setup_.route.leg_count(); ++i) {
    duration += leg_duration(setup_.route.leg(i), setup_.request);
  }
  return std::max(kTimesDuration * duration, 10 * setup_.step_s);
}

std::string Flight::time_out() const {
  return "timed out after " + with_digits(max_time(), 6) + " s" +
         (setup_.max_time_s ? " (max_time_s)" : " (ten times the route's duration)");
}

std::string Flight::away() const {
  return with_decimals(distance_from(request_.goal, state_.position), 1) + " m";
}

void Flight::end_flight(RunStatus status, Reason reason, std::string message) {
  ended_ = true;
  result_.status = status;
  result_.reason = reason;
  result_.message = std::move(message);
  if (status == RunStatus::not_reached && pilot_commands_ && setup_.replanner == nullptr) {
    result_.message +=
        "; the fly step has no replan: with replan: ID (of a plan step) a new route "
        "from there would be sought";
  }
  if (status != RunStatus::solved && !result_.replans.empty() &&
      (result_.replans.back().status == RunStatus::failed ||
       result_.replans.back().status == RunStatus::rejected)) {
    const Replan& last = result_.replans.back();
    result_.message += "; the last replan, by '" + last.step + "', " +
                       (last.status == RunStatus::failed ? "failed: " : "was not flown: ") +
                       last.message;
  }
}

FlightResult fly(const FlightSetup& setup) {
  if (setup.route.empty() || !setup.request.start.starts_at(setup.route.front())) {
    throw Error("expected a route that begins at the start");
  }
  if (!(setup.step_s > 0)) {
    throw Error("step_s must be greater than 0, found " + std::to_string(setup.step_s));
  }
  return Flight(setup).run();
}
}  // namespace altiplan::host
