// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kSuccesLeft = 8;
constexpr double kSuccesRight = kFigureWidth - 16;
constexpr double kBar = 14;
constexpr double kSuccesFirst = 16;  // base line of the first label

std::string solved_of(const Success& success) {
  return grouped(success.solved) + " of " + grouped(success.runs);
}

std::string breakdown(const Success& success) {
  std::string text;
  for (const auto& [outcome, count] : success.outcomes) {
    text += (text.empty() ? "" : " · ") + grouped(count) + " " + outcome_text(outcome);
  }
  return text.empty() ? "no runs" : text;
}

std::size_t all_runs(const Analysis& analysis) {
  std::size_t runs = 0;
  for (const Success& success : analysis.success) {
    runs += success.runs;
  }
  return runs;
}

/// Lines of at most that many characters, broken at the dots between the parts.
std::vector<std::string> wrapped(const std::string& text, std::size_t max_characters) {
  std::vector<std::string> lines(1);
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(" · ", at), text.size());
    const std::string part = text.substr(at, end - at);
    if (!lines.back().empty() && characters(lines.back()) + characters(part) + 3 > max_characters) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " · ") + part;
    at = end == text.size() ? end : end + std::string(" · ").size();
  }
  return lines;
}
}  // namespace

std::string pipeline_label(const StudyData& data, std::size_t pipeline,
                           std::size_t max_characters) {
  return shortened(printable(short_names(data)[pipeline]), max_characters);
}

std::size_t room_beside(const std::string& text) {
  constexpr double kBold = 7.6;  // widths of a character
  constexpr double kPlain = 6.9;
  const double room = kFigureWidth - 44 - kPlain * double(characters(text));
  return std::size_t(std::max(8.0, room / kBold));
}

std::string interval_text(double estimate, const std::optional<Interval>& interval, int digits) {
  std::string text = readable(estimate, digits);
  if (interval) {
    text += " [" + readable(interval->low, digits) + ", " + readable(interval->high, digits) + "]";
  }
  return text;
}

Figure success_figure(const StudyData& data, const Analysis& analysis) {
  constexpr double kRow = 42;
  Figure figure{"success",
                "Share of solved runs",
                "Bars: share of " + counted(all_runs(analysis), "run") +
                    " that solved; whiskers: 95 % interval.",
                kFigureWidth,
                0,
                "",
                {{"pipeline", "runs", "solved", "share", "low", "high", "interval_by"}, {}}};
  Canvas canvas;
  const Axis axis(0, 100, false, kSuccesLeft, kSuccesRight);
  const double bottom = kSuccesFirst + kRow * double(data.pipelines.size()) - 12;
  draw_bottom(canvas, axis, kSuccesFirst + 4, bottom, "solved, %");
  for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
    const Success& success = analysis.success[p];
    const double y = kSuccesFirst + kRow * double(p);
    const double share = success.runs > 0 ? double(success.solved) / double(success.runs) : kNone;
    const std::string right =
        success.runs > 0 ? percent(share) + "  ·  " + solved_of(success) : "no runs";
    canvas.text(kSuccesLeft, y, pipeline_label(data, p, room_beside(right)), "strong");
    canvas.text(kSuccesRight, y, right, "quiet", Anchor::end);
    canvas.rectangle(kSuccesLeft, y + 6, kSuccesRight - kSuccesLeft, kBar,
                     " class=\"track\" fill=\"#eef1f4\"");
    const Interval interval = success.interval.interval.value_or(Interval{kNone, kNone});
    if (success.runs > 0) {
      canvas.rectangle(kSuccesLeft, y + 6, axis(100 * share) - kSuccesLeft, kBar,
                       series_fill(data.series_of(p)) + " fill-opacity=\"0.5\"");
    }
    if (success.interval.interval) {
      const double low = axis(100 * interval.low);
      const double high = axis(100 * interval.high);
      const double middle = y + 6 + kBar / 2;
      canvas.path("M" + pixels(low) + " " + pixels(middle) + "H" + pixels(high) + "M" +
                      pixels(low) + " " + pixels(middle - 4) + "v8M" + pixels(high) + " " +
                      pixels(middle - 4) + "v8",
                  ink_line(1.5));
    }
    figure.numbers.rows.push_back(
        {data.pipelines[p].name, std::to_string(success.runs), std::to_string(success.solved),
         exact(share), exact(interval.low), exact(interval.high), success.interval.method});
  }
  figure.height = bottom + kAxisHeight;
  figure.body = canvas.take();
  return figure;
}

Figure outcome_figure(const StudyData& data, const Analysis& analysis) {
  Figure figure{"outcomes",
                "Outcomes of the runs",
                "Share of each outcome among " + counted(all_runs(analysis), "run") + ".",
                kFigureWidth,
                0,
                "",
                {{"pipeline", "outcome", "runs"}, {}}};
  Canvas canvas;
  std::set<std::string> used;
  double y = kSuccesFirst;
  for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
    const Success& success = analysis.success[p];
    canvas.text(kSuccesLeft, y, pipeline_label(data, p, 52), "strong");
    canvas.rectangle(kSuccesLeft, y + 6, kSuccesRight - kSuccesLeft, kBar,
                     " class=\"track\" fill=\"#eef1f4\"");
    double x = kSuccesLeft;
    for (const auto& [outcome, count] : success.outcomes) {
      const double width = (kSuccesRight - kSuccesLeft) * double(count) / double(success.runs);
      canvas.rectangle(x, y + 6, width, kBar, outcome_fill(outcome),
                       outcome_text(outcome) + ": " + grouped(count));
      x += width;
      used.insert(outcome);
      figure.numbers.rows.push_back({data.pipelines[p].name, outcome, std::to_string(count)});
    }
    y += 6 + kBar + 15;
    for (const std::string& line : wrapped(breakdown(success), 56)) {
      canvas.text(kSuccesLeft, y, line, "quiet");
      y += 15;
    }
    y += 9;
  }
  // The key: only outcomes that occur, in their order.
  std::vector<std::string> outcomes;
  for (const std::string& outcome : outcome_order()) {
    if (used.erase(outcome) > 0) {
      outcomes.push_back(outcome);
    }
  }
  outcomes.insert(outcomes.end(), used.begin(), used.end());
  double x = kSuccesLeft;
  for (const std::string& outcome : outcomes) {
    const std::string text = shortened(outcome_text(outcome), 24);
    const double width = 18 + 7.2 * double(characters(text)) + 12;
    if (x > kSuccesLeft && x + width > kSuccesRight) {
      x = kSuccesLeft;
      y += 18;
    }
    canvas.rectangle(x, y - 10, 13, 11, outcome_fill(outcome));
    canvas.text(x + 18, y, text, "ink");
    x += width;
  }
  figure.height = y + 10;
  figure.body = outcome_patterns(outcomes) + canvas.take();
  return figure;
}
}  // namespace altiplan::study::report
