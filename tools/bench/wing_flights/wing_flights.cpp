// SPDX-License-Identifier: Apache-2.0
// Flights of the accepted routes of results, along their turns and along polylines whose corners
// take the place of turns, as ground stations draw them: what a margin has to cover.
#include <algorithm>
#include <cmath>

#include "host/flight/flight.hpp"
#include "host/import_export/written_route.hpp"
#include "host/mission/mission.hpp"
#include "host/result/stored_result.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

/// Corners for turns of up to 120 degrees; the ends of others.
Polyline with_corners(const Route& route) {
  Polyline points{route.front()};
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    const bool is_corner = leg.turns() && std::abs(leg.turn) < radians(120);
    points.push_back(is_corner ? host::corner_of(leg) : leg.to);
  }
  if (points.back() != route.back()) {
    points.push_back(route.back());
  }
  return without_repeats(points);
}

struct Flown {
  std::vector<double> across;
  int flights = 0;
  int arrived = 0;
  int violated = 0;

  void add(host::FlightSetup setup, const Route& route) {
    setup.route = route;
    const host::FlightResult result = host::fly(setup);
    ++flights;
    arrived += result.reached;
    violated += !result.check.ok();
    across.push_back(result.cross_track_p999_m.value_or(kInfinity));
  }

  Json row(const char* route) const {
    return {{"route", route},
            {"flights", flights},
            {"arrived", arrived},
            {"with_violations", violated},
            {"cross_track_p999_m", median(across)},
            {"p95_m", quantile(across, 0.95)},
            {"max_m", quantile(across, 1)}};
  }
};

Json fly_all(const std::vector<std::string>& files) {
  Flown turns;
  Flown corners;
  for (const std::string& file : files) {
    const host::StoredResult stored = host::read_result(file, {});
    if (!stored.route) {
      continue;
    }
    const host::Mission mission =
        host::build_mission(host::load_config(stored.pipeline, stored.overrides), 1);
    host::FlightSetup setup;
    setup.request = mission.track_request;
    setup.route_request = mission.request;
    setup.truth = mission.truth;
    turns.add(setup, *stored.route);
    corners.add(setup, with_corners(*stored.route));
  }
  return {{"flights", Json::array({turns.row("turns"), corners.row("corners")})}};
}
}  // namespace

void add_wing_flights(Subcommands& all) {
  const auto files = std::make_shared<std::vector<std::string>>();
  CLI::App& command =
      all.add("wing-flights", "fly aeroplanes along the turns of results, and along their corners",
              [=](const Given&) { return fly_all(*files); });
  command.add_option("result", *files, "results of altiplan run")->required();
}
}  // namespace altiplan::bench
