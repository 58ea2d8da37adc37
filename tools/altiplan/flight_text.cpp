// SPDX-License-Identifier: Apache-2.0
#include "flight_text.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/energy.hpp"
#include "commands.hpp"
#include "host/base/words.hpp"

namespace altiplan::cli {
namespace {

/// The steepest climb and descent that the vehicle flies more slowly than its speed.
std::string steep_legs(const Route& route, const Vehicle& vehicle) {
  double steepest[2] = {0, 0};  // up and down, radians
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const double climb = climb_angle(route[i + 1] - route[i]);
    double& maximum = steepest[climb < 0 ? 1 : 0];
    maximum = std::max(maximum, std::abs(climb));
  }
  std::string words;
  for (const int down : {0, 1}) {
    const double rate = down == 1 ? vehicle.sink_mps : vehicle.climb_mps;
    const double speed = rate / std::sin(steepest[down]);
    if (!vehicle.wing && speed < vehicle.speed_mps) {
      words += (words.empty() ? "; " : ", ") + fixed(degrees(steepest[down]), 1) + " degrees " +
               (down == 1 ? "down" : "up") + " at " + fixed(speed, 1) + " m/s";
    }
  }
  return words;
}

std::string battery_in_words(const Energy& energy) {
  if (!std::isfinite(energy.capacity_wh)) {
    return "";
  }
  const auto percent = [](double share) { return fixed(100 * share, 0) + " %"; };
  return " of " + fixed(energy.available_wh(), 1) + " Wh that may be used (battery " +
         fixed(energy.capacity_wh, 1) + " Wh" +
         (energy.usable < 1 ? ", usable " + percent(energy.usable) : "") + ", reserve " +
         percent(energy.reserve) + ")";
}
}  // namespace

std::string flown_in_words(const host::RunResult& result) {
  const Vehicle& vehicle = result.vehicle;
  const bool is_known = vehicle.energy != nullptr || vehicle.acceleration.takes_time() ||
                        std::isfinite(vehicle.climb_mps) || std::isfinite(vehicle.sink_mps);
  if (!result.accepted || !is_known) {
    return "";
  }
  const host::StepResult& step = result.steps[*result.accepted];
  std::string words = fixed(step.measures->time_s.value_or(0) / 60, 1) + " min";
  if (vehicle.energy != nullptr) {
    const double needed = step.measures->energy_wh.value_or(0);
    words += (std::isfinite(needed) ? ", " + fixed(needed, 1) + " Wh" : ", unknown energy") +
             battery_in_words(*vehicle.energy);
  }
  double farthest = 0;
  for (const Vec3& p : step.route) {
    farthest = std::max(farthest, (p - step.route.front()).head<2>().norm());
  }
  words += ", up to " + fixed(farthest / 1000, 3) + " km from the start" +
           steep_legs(step.route, vehicle);
  if (vehicle.energy != nullptr && std::isfinite(vehicle.energy->capacity_wh)) {
    const std::optional<double>& last_s = result.point_of_no_return_s;
    const bool always = last_s && *last_s >= step.measures->time_s.value_or(0);
    words += always ? "; the battery lasts for a straight way home to the end"
             : last_s
                 ? "; for a straight way home it lasts until " + fixed(*last_s / 60, 1) + " min"
                 : "; it does not last for a straight way home";
  }
  return words;
}

std::string stops_in_words(const host::RunResult& result) {
  std::string words;
  for (const Pass& pass : result.task ? result.task->passes : std::vector<Pass>{}) {
    const auto& [hold_s, lands, drops] = pass.stop;
    if (pass.stop.acts()) {
      const std::string seconds = hold_s > 0 ? host::with_digits(hold_s, 6) + " s" : "";
      words += (words.empty() ? "" : "; ") +
               (!lands            ? "waits " + seconds
                : seconds.empty() ? "lands"
                                  : "lands for " + seconds) +
               (drops ? " and drops its cargo" : "") + " at " + host::place(pass.points.back());
    }
  }
  return words;
}

void print_metrics(std::FILE* to, const char* of, const host::MetricValues& metrics) {
  for (const auto& [name, value] : metrics) {
    std::fprintf(to, "  %s of the %s: %s\n", name.c_str(), of, host::with_digits(value, 6).c_str());
  }
}

void print_flight(std::FILE* to, const host::FlightResult& flight, bool is_cut_short) {
  const std::optional<double>& separation = flight.min_separation_m;
  const bool is_inside = separation && *separation < 0;
  std::fprintf(to, "  flight: %s after %s s, %d collision%s, %s%s m%s, %zu replan%s\n",
               flight.reached ? "reached the goal"
               : is_cut_short ? "ended by the step's budget"
                              : "did not reach the goal",
               fixed(flight.measures.duration_s, 0).c_str(), flight.collisions,
               flight.collisions == 1 ? "" : "s", is_inside ? "" : "nearest ",
               fixed(is_inside ? -*separation : separation, 1).c_str(), is_inside ? " inside" : "",
               flight.replans.size(), flight.replans.size() == 1 ? "" : "s");
  if (flight.cross_track_p999_m) {
    std::fprintf(
        to, "  cross-track error: %s m, for 99.9 %% of the time %s m; height error: %s m\n",
        fixed(flight.cross_track_max_m, 1).c_str(), fixed(flight.cross_track_p999_m, 1).c_str(),
        fixed(flight.height_error_max_m, 1).c_str());
  }
  for (const host::Handover& handover : flight.handovers) {
    std::fprintf(to, "  %7s s  command to %s: %s\n", fixed(handover.at_s, 0).c_str(),
                 handover.to.c_str(), handover.why.c_str());
  }
  for (const host::Replan& replan : flight.replans) {
    if (replan.status != host::RunStatus::solved) {
      std::fprintf(to, "  %7s s  replan by %s: %s%s%s\n", fixed(replan.at_s, 0).c_str(),
                   replan.step.c_str(), name(replan.status), replan.message.empty() ? "" : ": ",
                   replan.message.c_str());
    }
  }
}
}  // namespace altiplan::cli
