// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kParetoLeft = 56;
constexpr double kParetoRight = kFigureWidth - 16;
constexpr double kParetoTop = 24;
constexpr double kParetoBottom = 244;

/// The value of a metric at a place, where less is better.
double shown(const Trade& trade, const Place& place, std::size_t k) {
  return trade.is_negated[k] ? -place[k] : place[k];
}

Axis axis_of(const Trade& trade, std::size_t k, double from, double to) {
  std::vector<double> values{shown(trade, trade.reference, k)};
  for (const Place& place : trade.places) {
    values.push_back(shown(trade, place, k));
  }
  return Axis::around(values, from, to);
}

std::string reference_text(const Trade& trade) {
  return "(" + readable(shown(trade, trade.reference, 0)) + ", " +
         readable(shown(trade, trade.reference, 1)) + ")";
}
}  // namespace

Figure pareto_figure(const StudyData& data, const Trade& trade) {
  const Axis along = axis_of(trade, 0, kParetoLeft, kParetoRight);
  const Axis up = axis_of(trade, 1, kParetoBottom, kParetoTop);
  const auto x = [&](const Place& place) { return along(shown(trade, place, 0)); };
  const auto y = [&](const Place& place) { return up(shown(trade, place, 1)); };
  Canvas canvas;
  draw_left(canvas, up, kParetoLeft, kParetoRight, kParetoTop,
            axis_label(metric_label(trade.metrics[1]), up));
  draw_bottom(canvas, along, kParetoTop, kParetoBottom,
              axis_label(metric_label(trade.metrics[0]), along));
  // The border of what some pipeline is at least as good as: steps from point to point.
  std::string d =
      "M" + pixels(x(trade.places[trade.front.front()])) + " " + pixels(y(trade.reference));
  for (const std::size_t at : trade.front) {
    d += "H" + pixels(x(trade.places[at])) + "V" + pixels(y(trade.places[at]));
  }
  canvas.path(d + "H" + pixels(x(trade.reference)), ink_line(1));
  Grid numbers{{"pipeline", trade.metrics[0], trade.metrics[1], "non_dominated"}, {}};
  double key = kParetoBottom + kAxisHeight + 20;
  for (std::size_t i = 0; i < trade.pipelines.size(); ++i) {
    const std::size_t p = trade.pipelines[i];
    const bool is_on_front =
        std::find(trade.front.begin(), trade.front.end(), i) != trade.front.end();
    canvas.mark(x(trade.places[i]), y(trade.places[i]), data.series_of(p), 4,
                data.pipelines[p].name);
    canvas.mark(kParetoLeft + 13, key - 4, data.series_of(p), 3.4);
    canvas.text(kParetoLeft + 34, key, pipeline_label(data, p, 34), "ink");
    canvas.text(kParetoRight, key, is_on_front ? "non-dominated" : "", "quiet", Anchor::end);
    key += 18;
    numbers.rows.push_back({data.pipelines[p].name, exact(shown(trade, trade.places[i], 0)),
                            exact(shown(trade, trade.places[i], 1)), is_on_front ? "1" : "0"});
  }
  const std::size_t left_out = data.pipelines.size() - trade.pipelines.size();
  return {"pareto-" + slug(trade.metrics[0]) + "-" + slug(trade.metrics[1]),
          metric_title(trade.metrics[0]) + " against " + metric_title(trade.metrics[1]),
          "Medians over " + counted(trade.pairs, "pair") +
              " (scenario, repetition) that all pipelines shown solved" +
              (left_out > 0 ? "; " + counted(left_out, "pipeline") + " solved none" : "") +
              ". Hypervolume of the front " + readable(trade.hypervolume) +
              (trade.share == trade.share
                   ? ", " + percent(trade.share) + " of the rectangle from the best of both values"
                   : std::string()) +
              ", up to the reference point " + reference_text(trade) +
              ": the worst of both values, and a tenth of their range more.",
          kFigureWidth,
          key - 6,
          canvas.take(),
          std::move(numbers)};
}
}  // namespace altiplan::study::report
