// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "first_run.hpp"

namespace altiplan::cli {

struct SurveyArguments : FirstArguments {
  std::string area;
  std::string camera;
  std::string from;
  std::optional<double> gsd_cm;
  std::optional<double> agl_m;
  double overlap = 75;
  double sidelap = 70;
  double tolerance = 5;
  std::vector<double> offsets;
  double width_m = 0;
  std::optional<double> flight_minutes;
  bool json = false;
};

/// A part of the route, from take-off to landing.
struct Flight {
  Route route;
  std::vector<Polyline> lines;  ///< along which photos are taken
  std::string file;             ///< of the plan
  host::PlanReport report;
  host::LegHeights heights;  ///< above ground, where photos are taken, as they may be flown
};

/// What is flown, and the verdict on it.
struct Surveyed {
  host::RunResult result;
  std::vector<std::string> choices;
  std::vector<std::string> zone_layers;
  std::vector<Flight> flights;  ///< none: there is no mission
  std::string too_long;         ///< why a flight takes more than it may; "" if none does
  std::string voids;
  double shown = 0;  ///< share of the area

  bool passed() const {
    return too_long.empty() && std::all_of(flights.begin(), flights.end(),
                                           [](const Flight& each) { return each.report.passed(); });
  }
  std::vector<Polyline> lines() const {
    std::vector<Polyline> all;
    for (const Flight& flight : flights) {
      all.insert(all.end(), flight.lines.begin(), flight.lines.end());
    }
    return all;
  }
};

/// Plans, cuts the route into flights, writes and judges them; tries again nearer to the height of
/// the photos, and with shorter flights, as the verdicts ask. `first` becomes that of the last try.
Surveyed survey_in(const std::filesystem::path& folder, const SurveyArguments& arguments,
                   host::RouteWish wish, std::optional<host::FirstRoute>& first,
                   Interrupt& interrupt);
}  // namespace altiplan::cli
