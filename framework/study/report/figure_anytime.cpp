// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kLeft = 66;
constexpr double kRight = kFigureWidth - 14;
constexpr double kTop = 30;
constexpr double kBottom = 200;
constexpr double kShareTop = 226;
constexpr double kShareBottom = 290;

const AnytimeCurve& curve_of(const Anytime& anytime, bool by_evaluations) {
  return by_evaluations ? anytime.by_evaluations : anytime.by_time;
}

Grid numbers_of(const StudyData& data, const std::vector<Anytime>& all, bool by_evaluations) {
  Grid grid{{"pipeline", by_evaluations ? "evaluations" : "seconds", "with_a_route", "cost_p10",
             "cost_median", "cost_p90"},
            {}};
  const auto cell = [](double value) { return std::isfinite(value) ? exact(value) : ""; };
  for (const Anytime& anytime : all) {
    const AnytimeCurve& curve = curve_of(anytime, by_evaluations);
    for (std::size_t i = 0; i < curve.at.size(); ++i) {
      const Spread& cost = curve.costs[i];
      grid.rows.push_back({data.pipelines[anytime.pipeline].name, exact(curve.at[i]),
                           exact(curve.shares[i]), cell(cost.low), cell(cost.median),
                           cell(cost.high)});
    }
  }
  return grid;
}

/// Of the finite costs, from 1 on.
Axis axis_of_costs(const std::vector<Anytime>& all, bool by_evaluations) {
  std::vector<double> costs{1};
  for (const Anytime& anytime : all) {
    for (const Spread& cost : curve_of(anytime, by_evaluations).costs) {
      costs.insert(costs.end(), {cost.low, cost.median, cost.high});
    }
  }
  std::erase_if(costs, [](double cost) { return !std::isfinite(cost); });
  return Axis::around(costs, kBottom, kTop);
}
}  // namespace

std::optional<Figure> anytime_figure(const StudyData& data, const std::vector<Anytime>& all,
                                     bool by_evaluations) {
  if (all.empty() || curve_of(all.front(), by_evaluations).at.empty()) {
    return std::nullopt;
  }
  const std::vector<double>& at = curve_of(all.front(), by_evaluations).at;
  const double last = std::max(at.back(), at.front() * 1.001);
  const Axis along(at.front(), last, last > 30 * at.front(), kLeft, kRight);
  const Axis up = axis_of_costs(all, by_evaluations);
  const Axis shares(0, 1, false, kShareBottom, kShareTop);
  Canvas canvas;
  draw_left(canvas, up, kLeft, kRight, kTop, axis_label("Cost / best known", up));
  draw_shares(canvas, kLeft, kRight, kShareTop, kShareBottom);
  draw_bottom(canvas, along, kTop, kShareBottom,
              axis_label(by_evaluations ? "Evaluations, number" : "Time, s", along));
  double y = kShareBottom + kAxisHeight + 20;
  for (const Anytime& anytime : all) {
    const AnytimeCurve& curve = curve_of(anytime, by_evaluations);
    const std::size_t series = data.series_of(anytime.pipeline);
    draw_spread(canvas, curve.at, curve.costs, along, up, series);
    draw_curve(canvas, curve.at, curve.shares, along, shares, series_line(series));
    y = draw_key(canvas, kLeft, y, series, pipeline_label(data, anytime.pipeline));
  }
  return Figure{
      by_evaluations ? "anytime-evaluations" : "anytime-time",
      std::string("Cost of the best route so far, by ") + (by_evaluations ? "evaluations" : "time"),
      "Above the median over runs and the band from the 10th to the 90th percentile, of "
      "the cost over the least known of the scenario; a run without a route counts as "
      "infinite. Below the share of runs that have a route." +
          std::string(by_evaluations ? " Evaluations are in each planner's own unit." : ""),
      kFigureWidth,
      y - 6,
      canvas.take(),
      numbers_of(data, all, by_evaluations)};
}
}  // namespace altiplan::study::report
