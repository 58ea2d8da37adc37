// SPDX-License-Identifier: Apache-2.0
#include "study/report/anytime.hpp"

#include <algorithm>
#include <cmath>

#include "study/statistics/statistics.hpp"

namespace altiplan::study::report {
namespace {

constexpr std::size_t kPoints = 100;  // of a curve
constexpr double kNear[] = {0.05, 0.01};

/// The best cost from a moment on.
struct Gain {
  double time_s = 0;
  double evaluations = 0;
  double cost = 0;
};
using Gains = std::vector<Gain>;  // of a run, by time

double value(const StudyData& data, const RunRow& row, const char* name) {
  const std::size_t column = data.column(name);
  return column < row.values.size() ? row.values[column] : kNone;
}

Gains gains_of_trace(const Progress& progress) {
  Gains gains;
  for (const Iteration& iteration : progress.iterations) {
    const double best = gains.empty() ? kInfinity : gains.back().cost;
    if (iteration.best < best && std::isfinite(iteration.time_s)) {
      gains.push_back({iteration.time_s, iteration.expanded, iteration.best});
    }
  }
  return gains;
}

/// True if the progress has times, which former versions did not write.
bool is_timed(const std::vector<Progress>& progress) {
  return !progress.empty() && std::isfinite(progress.front().iterations.front().time_s);
}

Gains gains_of_result(const StudyData& data, const RunRow& row) {
  const double cost = row.solved() ? value(data, row, "cost") : kNone;
  return std::isfinite(cost)
             ? Gains{{value(data, row, "plan_time_s"), value(data, row, "expanded"), cost}}
             : Gains();
}

/// From the least to the greatest, evenly by ratio.
std::vector<double> places(const std::vector<const Gains*>& runs, double Gain::*at) {
  double low = kInfinity;
  double high = 0;
  for (const Gains* gains : runs) {
    for (const Gain& gain : *gains) {
      if (gain.*at > 0) {
        low = std::min(low, gain.*at);
        high = std::max(high, gain.*at);
      }
    }
  }
  std::vector<double> all;
  for (std::size_t n = 0; n < kPoints && high > 0; ++n) {
    all.push_back(low * std::pow(high / low, double(n) / double(kPoints - 1)));
  }
  if (!all.empty()) {
    all.back() = high;  // whatever the rounding
  }
  return all;
}

AnytimeCurve curve_of(const std::vector<const Gains*>& runs, const std::vector<double>& places,
                      double Gain::*at) {
  AnytimeCurve curve;
  curve.at = places;
  for (const double place : places) {
    std::vector<double> costs;
    for (const Gains* gains : runs) {
      const auto after = std::find_if(gains->begin(), gains->end(),
                                      [&](const Gain& gain) { return gain.*at > place; });
      costs.push_back(after == gains->begin() ? kInfinity : (after - 1)->cost);
    }
    const auto found =
        std::count_if(costs.begin(), costs.end(), [](double cost) { return std::isfinite(cost); });
    curve.shares.push_back(double(found) / double(costs.size()));
    curve.costs.push_back(spread_of(std::move(costs)));
  }
  return curve;
}

TimeTo time_to(const std::vector<const Gains*>& runs, double within) {
  TimeTo to{within, 0, {}, {}};
  std::vector<double> times;
  std::vector<double> evaluations;
  for (const Gains* gains : runs) {
    const auto near = std::find_if(gains->begin(), gains->end(),
                                   [&](const Gain& gain) { return gain.cost <= 1 + within; });
    const bool came = near != gains->end();
    to.share += came ? 1 / double(runs.size()) : 0;
    times.push_back(came ? near->time_s : kInfinity);
    evaluations.push_back(came ? near->evaluations : kInfinity);
  }
  to.time_s = spread_of(std::move(times));
  to.evaluations = spread_of(std::move(evaluations));
  return to;
}
}  // namespace

std::vector<Anytime> anytime_of(const StudyData& data, const TraceSource& traces) {
  std::vector<Gains> all;  // one per row
  std::vector<double> best(data.scenarios.size(), kInfinity);
  bool timed = false;
  for (const RunRow& row : data.rows) {
    const std::vector<Progress> progress = progress_of(traces(row));
    timed = timed || is_timed(progress);
    all.push_back(is_timed(progress) ? gains_of_trace(progress.front())
                                     : gains_of_result(data, row));
    double& of_scenario = best[row.scenario];
    of_scenario = std::fmin(of_scenario, value(data, row, "reference"));
    of_scenario = all.back().empty() ? of_scenario : std::min(of_scenario, all.back().back().cost);
  }
  if (!timed) {
    return {};
  }
  std::vector<std::vector<const Gains*>> runs(data.pipelines.size());
  std::vector<const Gains*> any;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    const double least = best[data.rows[r].scenario];
    for (Gain& gain : all[r]) {
      gain.cost = gain.cost == least ? 1 : gain.cost / least;  // also where both are 0
    }
    runs[data.rows[r].pipeline].push_back(&all[r]);
    any.push_back(&all[r]);
  }
  const std::vector<double> times = places(any, &Gain::time_s);
  const std::vector<double> evaluations = places(any, &Gain::evaluations);
  std::vector<Anytime> found;
  for (std::size_t p = 0; p < runs.size(); ++p) {
    Anytime anytime;
    anytime.pipeline = p;
    anytime.runs = runs[p].size();
    if (runs[p].empty()) {
      continue;
    }
    anytime.by_time = curve_of(runs[p], times, &Gain::time_s);
    anytime.by_evaluations = curve_of(runs[p], evaluations, &Gain::evaluations);
    anytime.first_route_s = time_to(runs[p], kInfinity).time_s;
    for (const double within : kNear) {
      anytime.times_to.push_back(time_to(runs[p], within));
    }
    found.push_back(std::move(anytime));
  }
  return found;
}
}  // namespace altiplan::study::report
