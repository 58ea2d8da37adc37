// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

/// Margins beside the axis for the names.
constexpr double kRankLeft = 140;
constexpr double kRankRight = kFigureWidth - 140;
constexpr double kCharacter = 7;
constexpr double kAxisY = 58;
constexpr double kRankRow = 22;
constexpr double kBarStep = 9;

/// The length of the critical difference, above the axis.
void draw_critical(Canvas& canvas, const Axis& axis, double critical) {
  const double end = axis(1 + std::min(critical, axis.high() - 1));
  canvas.path("M" + pixels(kRankLeft) + " 20v8M" + pixels(end) + " 20v8M" + pixels(kRankLeft) +
                  " 24H" + pixels(end),
              ink_line(1.3));
  const bool beyond = critical > axis.high() - 1;
  canvas.text(kRankLeft, 14,
              "critical difference " + readable(critical, 3) + (beyond ? ", beyond the axis" : ""),
              "quiet");
}

void draw_axis(Canvas& canvas, const Axis& axis, std::size_t count) {
  canvas.line(kRankLeft, kAxisY, kRankRight, kAxisY, "ink_line");
  const std::size_t every = (count + 6) / 7;  // more numbers would not fit
  for (std::size_t rank = 1; rank <= count; ++rank) {
    canvas.line(axis(double(rank)), kAxisY - 5, axis(double(rank)), kAxisY, "ink_line");
    if ((rank - 1) % every == 0) {
      canvas.text(axis(double(rank)), kAxisY - 9, std::to_string(rank), "quiet", Anchor::middle);
    }
  }
}
}  // namespace

std::optional<Figure> rank_figure(const StudyData& data, const MetricAnalysis& metric) {
  if (!metric.ranking) {
    return std::nullopt;
  }
  const Ranking& ranking = *metric.ranking;
  const std::vector<double>& ranks = ranking.test.average_ranks;
  std::vector<std::size_t> order(ranks.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
  Canvas canvas;
  const Axis axis(1, double(ranks.size()), false, kRankLeft, kRankRight);
  draw_critical(canvas, axis, ranking.critical);
  draw_axis(canvas, axis, ranks.size());
  double below = kAxisY + 10;
  for (const auto& group : ranking.joined) {
    canvas.path("M" + pixels(axis(ranks[group.front()]) - 3) + " " + pixels(below) + "H" +
                    pixels(axis(ranks[group.back()]) + 3),
                ink_line(3.5));
    below += kBarStep;
  }
  // The better half is labelled on the left, the other on the right; leaders never cross.
  const std::size_t half = (order.size() + 1) / 2;
  for (std::size_t at = 0; at < order.size(); ++at) {
    const bool left = at < half;
    const double x = axis(ranks[order[at]]);
    const double y = below + 18 + kRankRow * double(left ? at : order.size() - 1 - at);
    canvas.path("M" + pixels(x) + " " + pixels(kAxisY) + "V" + pixels(y) + "H" +
                    pixels(left ? 0 : kFigureWidth),
                series_line(data.series_of(order[at]), 1.3));
    const double room = (left ? x : kFigureWidth - x) - 8;
    const std::string rank = readable(ranks[order[at]], 3);
    const std::string name =
        pipeline_label(data, order[at],
                       std::size_t(room / kCharacter) - std::min<std::size_t>(8, rank.size() + 2));
    canvas.text(left ? 0 : kFigureWidth, y - 5, left ? name + "  " + rank : rank + "  " + name,
                "ink", left ? Anchor::start : Anchor::end);
  }
  Grid grid{{"pipeline", "average_rank"}, {}};
  for (const std::size_t p : order) {
    grid.rows.push_back({data.pipelines[p].name, exact(ranks[p])});
  }
  grid.rows.push_back({"critical difference", exact(ranking.critical)});
  const std::string blocks =
      counted(ranking.blocks, ranking.of_scenarios ? "scenario" : "repetition");
  return Figure{"ranks-" + slug(metric.metric),
                "Average ranks by " + metric_title(metric.metric) + ", 1 is best",
                "Over " + blocks +
                    " that all pipelines solved. A thick bar joins pipelines that "
                    "differ by less than Nemenyi's critical difference at 5 %; Friedman's test: " +
                    p_equals(ranking.test.p) + ".",
                kFigureWidth,
                below + 12 + kRankRow * double(half),
                canvas.take(),
                std::move(grid)};
}
}  // namespace altiplan::study::report
