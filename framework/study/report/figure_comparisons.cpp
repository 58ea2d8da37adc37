// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kComparisonLeft = 12;
constexpr double kComparisonRight = kFigureWidth - 16;
constexpr double kComparisonFirst = 16;
constexpr double kComparisonRow = 44;
constexpr double kSecondLine = 15;
constexpr std::size_t kMaxRows = 16;

using Rows = std::vector<const Comparison*>;

/// The comparisons to draw: all, or those with the lowest p.
Rows drawn(const MetricAnalysis& metric) {
  Rows all;
  for (const Comparison& comparison : metric.comparisons) {
    if (comparison.used > 0) {
      all.push_back(&comparison);
    }
  }
  if (all.size() > kMaxRows) {
    std::stable_sort(all.begin(), all.end(), [](const Comparison* a, const Comparison* b) {
      const auto p = [](const Comparison* c) { return std::isnan(c->p_holm) ? 2 : c->p_holm; };
      return p(a) < p(b);
    });
    all.resize(kMaxRows);
  }
  return all;
}

Axis axis_of(const Rows& rows, bool ratio) {
  std::vector<double> values{ratio ? 1.0 : 0.0};
  for (const Comparison* row : rows) {
    const auto& [median, interval, units, test] = row->effect;
    values.push_back(median);
    values.push_back(interval ? interval->low : median);
    values.push_back(interval ? interval->high : median);
  }
  return Axis::around(values, kComparisonLeft, kComparisonRight);
}

std::string effect_text(const Comparison& row) {
  return interval_text(row.effect.median, row.effect.interval);
}

/// True if the names of some comparison do not fit into one line.
bool need_two_lines(const StudyData& data, const Rows& rows) {
  return std::any_of(rows.begin(), rows.end(), [&](const Comparison* row) {
    return characters(pipeline_label(data, row->pipeline)) +
               characters(pipeline_label(data, row->against)) + 3 >
           room_beside(effect_text(*row));
  });
}

/// "ours / theirs", in the order of the table.
void draw_names(Canvas& canvas, const StudyData& data, const Comparison& row, bool ratio, double y,
                bool two_lines) {
  const std::string against = (ratio ? "/ " : "− ") + pipeline_label(data, row.against, 50);
  if (two_lines) {
    canvas.text(kComparisonLeft, y,
                pipeline_label(data, row.pipeline, room_beside(effect_text(row))), "strong");
    canvas.text(kComparisonLeft, y + kSecondLine, against, "strong");
  } else {
    canvas.text(kComparisonLeft, y, pipeline_label(data, row.pipeline) + " " + against, "strong");
  }
  canvas.text(kComparisonRight, y, effect_text(row), "quiet", Anchor::end);
}

void draw_effect(Canvas& canvas, const PairedEffect& effect, const Axis& axis, double y,
                 std::size_t series) {
  if (effect.interval) {
    canvas.path("M" + pixels(axis(effect.interval->low)) + " " + pixels(y) + "H" +
                    pixels(axis(effect.interval->high)),
                ink_line(2));
  }
  canvas.mark(axis(effect.median), y, series, 4);
}

Grid numbers_of(const StudyData& data, const MetricAnalysis& metric) {
  Grid grid{{"pipeline", "against", "effect_is", "effect", "low", "high", "n", "n_of", "n_differ",
             "p", "p_holm", "rank_biserial", "pairs_both_solved", "pairs"},
            {}};
  for (const Comparison& row : metric.comparisons) {
    const Interval interval = row.effect.interval.value_or(Interval{kNone, kNone});
    const Units& units = row.effect.units;
    grid.rows.push_back({data.pipelines[row.pipeline].name, data.pipelines[row.against].name,
                         metric.is_ratio ? "ratio" : "difference", exact(row.effect.median),
                         exact(interval.low), exact(interval.high), std::to_string(units.count),
                         units.of_scenarios ? "scenarios" : "repetitions",
                         std::to_string(row.effect.test ? row.effect.test->used : 0),
                         exact(row.p()), exact(row.p_holm), exact(row.rank_biserial()),
                         std::to_string(row.used), std::to_string(row.pairs)});
  }
  return grid;
}

std::string caption_of(const MetricAnalysis& metric, const Rows& rows) {
  const bool less_is_better = metric.better == Better::lower;
  std::string caption = "Median over the pairs that both solved" +
                        counted_once(metric.repeating, Counted::pairs) + " of " +
                        (metric.is_ratio ? "A / B" : "A − B") +
                        ", with its 95 % interval. Left of the dashed line A, the first "
                        "pipeline, has "
                        "less" +
                        (less_is_better ? " (is better)" : "") + ", right of it more" +
                        (less_is_better ? "." : " (is better).");
  const auto all = std::count_if(metric.comparisons.begin(), metric.comparisons.end(),
                                 [](const Comparison& comparison) { return comparison.used > 0; });
  if (rows.size() < std::size_t(all)) {
    caption += " " + std::to_string(rows.size()) + " of " +
               counted(std::size_t(all), "comparison") +
               ", those with the lowest p; the table has all.";
  }
  return caption;
}
}  // namespace

Figure comparison_figure(const StudyData& data, const MetricAnalysis& metric) {
  const Rows rows = drawn(metric);
  const bool ratio = metric.is_ratio;
  const Axis axis = axis_of(rows, ratio);
  const double more = need_two_lines(data, rows) ? kSecondLine : 0;
  const double bottom = kComparisonFirst + (kComparisonRow + more) * double(rows.size()) - 10;
  const std::string unit = ratio ? "" : metric_unit(metric.metric);
  const std::string label =
      (ratio ? "median ratio" : "median difference") + (unit.empty() ? "" : ", " + unit);
  Canvas canvas;
  draw_bottom(canvas, axis, kComparisonFirst + 4, bottom, axis_label(label, axis));
  double y = kComparisonFirst;
  for (const Comparison* row : rows) {
    draw_names(canvas, data, *row, ratio, y, more > 0);
    const double none = axis(ratio ? 1 : 0);
    canvas.line(none, y + more + 5, none, y + more + 26,
                "reference");  // without crossing the texts
    draw_effect(canvas, row->effect, axis, y + more + 15, data.series_of(row->pipeline));
    y += kComparisonRow + more;
  }
  const std::string title = metric_title(metric.metric) + ", pipeline against pipeline";
  return {"pairs-" + slug(metric.metric), title,         caption_of(metric, rows), kFigureWidth,
          bottom + kAxisHeight,           canvas.take(), numbers_of(data, metric)};
}
}  // namespace altiplan::study::report
