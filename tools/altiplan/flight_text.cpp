// SPDX-License-Identifier: Apache-2.0
#include "flight_text.hpp"

#include "commands.hpp"
#include "host/base/words.hpp"

namespace altiplan::cli {

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
