// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"
#include "study/report/panels.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kBoxLeft = 12;
constexpr double kBoxRight = kFigureWidth - 16;
constexpr double kBoxRow = 44;
constexpr double kBoxFirst = 16;
constexpr double kTitle = 24;    // of a panel
constexpr double kBetween = 14;  // panels
/// Up to that many runs are all shown as points.
constexpr std::size_t kFew = 40;
/// Maximum number of points of a box; more would smear.
constexpr std::size_t kBoxMaxPoints = 150;

/// The sample's indices shown as points: all of a small sample, otherwise the farthest outliers.
std::vector<std::size_t> shown_points(const Sample& sample) {
  std::vector<std::size_t> shown;
  if (sample.values.size() <= kFew) {
    for (std::size_t at = 0; at < sample.values.size(); ++at) {
      shown.push_back(at);
    }
    return shown;
  }
  shown = sample.box->outliers;
  const auto far = [&](std::size_t at) { return std::abs(sample.values[at] - sample.box->median); };
  std::stable_sort(shown.begin(), shown.end(),
                   [&](std::size_t a, std::size_t b) { return far(a) > far(b); });
  shown.resize(std::min(shown.size(), kBoxMaxPoints));
  return shown;
}

void draw_box(Canvas& canvas, const BoxPlot& box, const Axis& axis, double y, std::size_t series) {
  constexpr double kHalf = 7;
  const double low = axis(box.low_whisker);
  const double q1 = axis(box.q1);
  const double q3 = axis(box.q3);
  const double high = axis(box.high_whisker);
  canvas.path("M" + pixels(low) + " " + pixels(y) + "H" + pixels(q1) + "M" + pixels(q3) + " " +
                  pixels(y) + "H" + pixels(high) + "M" + pixels(low) + " " + pixels(y - 4) + "v8M" +
                  pixels(high) + " " + pixels(y - 4) + "v8",
              series_line(series, 1.3));
  canvas.rectangle(q1, y - kHalf, std::max(0.5, q3 - q1), 2 * kHalf, series_fill_pale(series));
  canvas.rectangle(q1, y - kHalf, std::max(0.5, q3 - q1), 2 * kHalf, series_line(series, 1.3));
  const double middle = axis(box.median);
  canvas.path("M" + pixels(middle) + " " + pixels(y - kHalf) + "v" + pixels(2 * kHalf),
              series_line(series, 3));
}

/// "12.3 m", "straight".
std::string with_unit(const MetricAnalysis& metric, double value, int digits) {
  const std::string unit = metric_unit(metric.metric);
  const bool bare = unit.empty() || is_straight(metric.metric, value);
  return readable_value(metric.metric, value, digits) + (bare ? "" : " " + unit);
}

/// Draws one pipeline's row; returns the number of outliers without a point.
std::size_t draw_row(Canvas& canvas, const StudyData& data, const MetricAnalysis& metric,
                     std::size_t p, const Sample& sample, const Axis& axis, double y) {
  const std::string right = sample.box ? "median " + with_unit(metric, sample.box->median, 4) +
                                             "  ·  n = " + grouped(sample.values.size())
                                       : "no solved run has a value";
  canvas.text(kBoxLeft, y, pipeline_label(data, p, room_beside(right)), "strong");
  canvas.text(kBoxRight, y, right, "quiet", Anchor::end);
  if (!sample.box) {
    return 0;
  }
  const std::size_t series = data.series_of(p);
  draw_box(canvas, *sample.box, axis, y + 15, series);
  const std::vector<std::size_t> shown = shown_points(sample);
  for (const std::size_t at : shown) {
    // Spread over the height of the box by the run's index, so that equal values stay visible.
    const double shift = double(at * 7 % 11) - 5;
    const RunRow& row = data.rows[sample.rows[at]];
    canvas.point(axis(sample.values[at]), y + 15 + shift, series, sample.rows[at],
                 run_name(data, row) + ": " + with_unit(metric, sample.values[at], 6));
  }
  const bool all = sample.values.size() <= kFew;
  return all ? 0 : sample.box->outliers.size() - shown.size();
}

void add_numbers(Grid& grid, const StudyData& data, const std::string& name, const Sample& sample,
                 const std::string& panel) {
  grid.rows.push_back({name, "n", std::to_string(sample.values.size()), "", "", panel});
  if (!sample.box) {
    return;
  }
  const BoxPlot& box = *sample.box;
  for (const auto& [part, value] : {std::pair("low_whisker", box.low_whisker),
                                    {"q1", box.q1},
                                    {"median", box.median},
                                    {"q3", box.q3},
                                    {"high_whisker", box.high_whisker}}) {
    grid.rows.push_back({name, part, exact(value), "", "", panel});
  }
  for (const std::size_t at : box.outliers) {
    const RunRow& row = data.rows[sample.rows[at]];
    grid.rows.push_back({name, "outlier", exact(sample.values[at]),
                         data.scenarios[row.scenario].name, std::to_string(row.repetition), panel});
  }
}

/// The values in the panel's scenarios.
Sample part_of(const StudyData& data, const Sample& sample, const Panel& panel) {
  Sample part;
  for (std::size_t at = 0; at < sample.values.size(); ++at) {
    if (panel.has[data.rows[sample.rows[at]].scenario]) {
      part.values.push_back(sample.values[at]);
      part.rows.push_back(sample.rows[at]);
    }
  }
  part.box = box_plot(part.values);
  return part;
}

/// A box for each pipeline, of the values in the panel's scenarios.
class BoxPanel {
 public:
  BoxPanel(const StudyData& data, const MetricAnalysis& metric, Panel panel)
      : data_(data), metric_(metric), panel_(std::move(panel)) {
    for (const Sample& sample : metric.samples) {
      samples_.push_back(part_of(data, sample, panel_));
      runs_ += samples_.back().values.size();
    }
  }

  std::size_t runs() const { return runs_; }
  std::size_t hidden() const { return hidden_; }

  /// Returns the y below it.
  double draw(Canvas& canvas, double y) {
    if (!panel_.title.empty()) {
      canvas.text(kBoxLeft, y + kBoxFirst, panel_.title);
      y += kTitle;
    }
    std::vector<double> values;
    for (const Sample& sample : samples_) {
      for (const double value : sample.values) {
        // Otherwise the axis spans 1e-13 degrees.
        values.push_back(without_noise(metric_.metric, value));
      }
    }
    const Axis axis = Axis::around(values, kBoxLeft, kBoxRight);
    const double bottom = y + kBoxFirst + kBoxRow * double(samples_.size()) - 10;
    draw_bottom(canvas, axis, y + kBoxFirst + 4, bottom,
                axis_label(metric_label(metric_.metric), axis));
    for (std::size_t p = 0; p < samples_.size(); ++p) {
      hidden_ += draw_row(canvas, data_, metric_, p, samples_[p], axis,
                          y + kBoxFirst + kBoxRow * double(p));
    }
    return bottom + kAxisHeight;
  }

  void add_to(Grid& grid) const {
    for (std::size_t p = 0; p < samples_.size(); ++p) {
      add_numbers(grid, data_, data_.pipelines[p].name, samples_[p], panel_.title);
    }
  }

 private:
  const StudyData& data_;
  const MetricAnalysis& metric_;
  Panel panel_;
  std::vector<Sample> samples_;  ///< one per pipeline
  std::size_t runs_ = 0;
  std::size_t hidden_ = 0;
};

std::string caption_of(const MetricAnalysis& metric, std::size_t panels, std::size_t runs,
                       std::size_t hidden) {
  std::string caption = counted(runs, "solved run") +
                        counted_once(metric.repeating, Counted::values) +
                        ". Box: quartiles and median; whiskers: the last value within 1.5 "
                        "interquartile ranges; points: outliers, or all of up to " +
                        std::to_string(kFew) + " runs.";
  if (panels > 1) {
    caption += " Scenarios whose medians differ tenfold have panels of their own.";
  }
  if (hidden > 0) {
    caption += " " + counted(hidden, "outlier") + " nearer to the box not drawn.";
  }
  return caption;
}
}  // namespace

Figure box_figure(const StudyData& data, const MetricAnalysis& metric) {
  std::vector<Panel> panels = panels_of(data, metric);
  if (panels.empty()) {
    panels.push_back({"", std::vector<bool>(data.scenarios.size(), true)});
  }
  Canvas canvas;
  Grid grid{{"pipeline", "part", "value", "scenario", "repetition", "panel"}, {}};
  std::size_t runs = 0;
  std::size_t hidden = 0;
  double y = 0;
  for (const Panel& panel : panels) {
    BoxPanel boxes(data, metric, panel);
    y = boxes.draw(canvas, y == 0 ? 0 : y + kBetween);
    boxes.add_to(grid);
    runs += boxes.runs();
    hidden += boxes.hidden();
  }
  return {"boxes-" + slug(metric.metric),
          metric_title(metric.metric) + " of solved runs",
          caption_of(metric, panels.size(), runs, hidden),
          kFigureWidth,
          y,
          canvas.take(),
          std::move(grid)};
}
}  // namespace altiplan::study::report
