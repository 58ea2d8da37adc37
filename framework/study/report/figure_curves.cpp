// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kCurveLeft = 48;
constexpr double kCurveRight = kFigureWidth - 16;
constexpr double kCurveTop = 12;
constexpr double kCurveBottom = 232;
/// Profiles crowd near 1: beyond that ratio the axis is logarithmic.
constexpr double kWideProfile = 5;

using Curve = std::vector<CurvePoint>;

double end_of(const Curve& curve) { return curve.empty() ? 0 : curve.back().share; }

/// The value of the curve at x.
double share_at(const Curve& curve, double x) {
  const auto after = std::upper_bound(curve.begin(), curve.end(), x,
                                      [](double at, const CurvePoint& p) { return at < p.at; });
  return after == curve.begin() ? 0 : (after - 1)->share;
}

/// The steps of the curve, without those below a screen's resolution.
void draw_steps(Canvas& canvas, const Curve& curve, const Axis& axis, const Axis& up,
                std::size_t series) {
  std::string d = "M" + pixels(axis(axis.low())) + " " + pixels(up(0));
  std::string last_x;
  std::string last_y = pixels(up(0));
  for (std::size_t at = 0; at < curve.size(); ++at) {
    const std::string x = pixels(axis(curve[at].at));
    const std::string y = pixels(up(curve[at].share));
    const bool same_column = at + 1 < curve.size() && pixels(axis(curve[at + 1].at)) == x;
    if (same_column || y == last_y) {
      continue;  // the next step has the same coordinates
    }
    d += x == last_x ? "" : "H" + x;
    d += "V" + y;
    last_x = x;
    last_y = y;
  }
  canvas.path(d + "H" + pixels(axis(axis.high())), series_line(series));
}

/// All curves, and below them the key with the end value of each.
double draw_curves(Canvas& canvas, const StudyData& data, const std::vector<Curve>& curves,
                   const Axis& axis, const std::string& label, const std::string& ends) {
  const Axis up(0, 1, false, kCurveBottom, kCurveTop);
  draw_shares(canvas, kCurveLeft, kCurveRight, kCurveTop, kCurveBottom);
  draw_bottom(canvas, axis, kCurveTop, kCurveBottom, label);
  for (std::size_t p = 0; p < curves.size(); ++p) {
    const std::size_t series = data.series_of(p);
    draw_steps(canvas, curves[p], axis, up, series);
    // Marks distinguish the curves without colours; each curve has them at different positions.
    for (int n = 0; n < 4; ++n) {
      const double share = (n + 0.35 + 0.6 * double(p % 7) / 7) / 4;
      const double px = kCurveLeft + share * (kCurveRight - kCurveLeft);
      const double low = axis.logarithmic() ? std::log(axis.low()) : axis.low();
      const double high = axis.logarithmic() ? std::log(axis.high()) : axis.high();
      const double place = low + share * (high - low);
      const double at = axis.logarithmic() ? std::exp(place) : place;
      canvas.mark(px, up(share_at(curves[p], at)), series, 3.2);
    }
  }
  double y = kCurveBottom + kAxisHeight + 20;
  for (std::size_t p = 0; p < curves.size(); ++p) {
    canvas.path("M" + pixels(kCurveLeft) + " " + pixels(y - 4) + "h26",
                series_line(data.series_of(p)));
    canvas.mark(kCurveLeft + 13, y - 4, data.series_of(p), 3.4);
    canvas.text(kCurveLeft + 34, y, pipeline_label(data, p, 34), "ink");
    canvas.text(kCurveRight, y, percent(end_of(curves[p])) + ends, "quiet", Anchor::end);
    y += 18;
  }
  return y - 6;
}

Grid curve_numbers(const StudyData& data, const std::vector<Curve>& curves, const char* at) {
  Grid grid{{"pipeline", at, "share"}, {}};
  for (std::size_t p = 0; p < curves.size(); ++p) {
    for (const CurvePoint& point : curves[p]) {
      grid.rows.push_back({data.pipelines[p].name, exact(point.at), exact(point.share)});
    }
  }
  return grid;
}

std::vector<double> places(const std::vector<Curve>& curves) {
  std::vector<double> all;
  for (const Curve& curve : curves) {
    for (const CurvePoint& point : curve) {
      all.push_back(point.at);
    }
  }
  return all;
}

/// Explains how runs that did not solve, or lack the value, are counted.
std::string unsolved_text(std::size_t runs, std::size_t unsolved) {
  if (unsolved == 0) {
    return runs == 1 ? "The one run solved." : "All " + grouped(runs) + " runs solved.";
  }
  return "Of " + counted(runs, "run") + "; the " + (unsolved == 1 ? "one" : grouped(unsolved)) +
         " that did not solve " + (unsolved == 1 ? "counts" : "count") + " only in the total.";
}
}  // namespace

std::optional<Figure> effort_figure(const StudyData& data, const std::string& metric) {
  const std::size_t column = data.column(metric);
  if (column == data.columns.size()) {
    return std::nullopt;
  }
  std::vector<std::vector<double>> values(data.pipelines.size());
  std::size_t unsolved = 0;
  for (const RunRow& row : data.rows) {
    const double value = row.solved() ? row.values[column] : kNone;
    values[row.pipeline].push_back(std::isfinite(value) ? value : kNone);
    unsolved += !std::isfinite(value);
  }
  std::vector<Curve> curves;
  for (const auto& of_pipeline : values) {
    curves.push_back(solved_by(of_pipeline));
  }
  const std::vector<double> all = places(curves);
  if (all.empty()) {
    return std::nullopt;
  }
  const Axis axis = Axis::around(all, kCurveLeft, kCurveRight);
  Canvas canvas;
  const double height =
      draw_curves(canvas, data, curves, axis, axis_label(metric_label(metric), axis), " solved");
  const std::string title = metric_title(metric);
  return Figure{"solved-by-" + slug(metric),
                "Share of all runs solved, by " + std::string(1, char(std::tolower(title[0]))) +
                    title.substr(1),
                unsolved_text(data.rows.size(), unsolved),
                kFigureWidth,
                height,
                canvas.take(),
                curve_numbers(data, curves, "at")};
}

std::optional<Figure> profile_figure(const StudyData& data, const MetricAnalysis& metric) {
  if (metric.better == Better::higher || data.pipelines.size() < 2) {
    return std::nullopt;
  }
  const std::size_t column = data.column(metric.metric);
  std::vector<std::vector<double>> costs(data.pipelines.size());
  for (const Pair& pair : distinct_pairs(data, metric.metric)) {
    if (std::find(pair.rows.begin(), pair.rows.end(), kNoRow) != pair.rows.end()) {
      continue;
    }
    for (std::size_t p = 0; p < pair.rows.size(); ++p) {
      const RunRow& row = data.rows[pair.rows[p]];
      const double value = row.solved() ? row.values[column] : kNone;
      costs[p].push_back(std::isfinite(value) ? value : kNone);
    }
  }
  const auto curves = performance_profile(costs);
  if (!curves || places(*curves).empty()) {
    return std::nullopt;
  }
  std::vector<double> all = places(*curves);
  all.push_back(1);
  const double highest = *std::max_element(all.begin(), all.end());
  // From 1: no ratio to the lowest is smaller.
  const bool wide = highest > kWideProfile;
  const Axis axis(1, std::max(highest * (wide ? 1.1 : 1), 1.001), wide, kCurveLeft, kCurveRight);
  Canvas canvas;
  const double height = draw_curves(canvas, data, *curves, axis,
                                    axis_label("ratio to the lowest of all pipelines", axis), "");
  return Figure{"profile-" + slug(metric.metric),
                "Performance profile of " + metric_title(metric.metric),
                "The share of " + counted(costs.front().size(), "pair") +
                    " (scenario, repetition) that a pipeline solved at a cost of at most this "
                    "ratio to the lowest of all; a curve begins at the share of pairs in which the "
                    "pipeline had the lowest cost.",
                kFigureWidth,
                height,
                canvas.take(),
                curve_numbers(data, *curves, "times_the_least")};
}
}  // namespace altiplan::study::report
