// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/report/convergence.hpp"

namespace altiplan::study::report {

/// What the runs of a pipeline have by a time, or by so many evaluations.
struct AnytimeCurve {
  std::vector<double> at;      ///< seconds, or evaluations, ascending
  std::vector<Spread> costs;   ///< best cost so far over the best known one of the scenario
  std::vector<double> shares;  ///< of runs that have a route
};

/// How long the runs of a pipeline take to come that near to the best known cost.
struct TimeTo {
  double within = 0;  ///< share of that cost
  double share = 0;   ///< of the runs that do
  Spread time_s;      ///< infinite if that part of the runs does not
  Spread evaluations;
};

/// The costs of the routes of a pipeline's searches while they go on.
struct Anytime {
  std::size_t pipeline = 0;
  std::size_t runs = 0;
  AnytimeCurve by_time;
  AnytimeCurve by_evaluations;
  Spread first_route_s;
  std::vector<TimeTo> times_to;  ///< to within 5 % and 1 %
};

/// Of each pipeline, if any run of the study has a trace with iterations and their times; empty
/// otherwise. A run whose planner reports none has its route, if it solved, when its planning ends.
/// The best known cost of a scenario is the least of all runs and the published one.
std::vector<Anytime> anytime_of(const StudyData& data, const TraceSource& traces);
}  // namespace altiplan::study::report
