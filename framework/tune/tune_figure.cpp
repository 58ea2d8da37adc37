// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/figures/text.hpp"
#include "tune/tune_report.hpp"

namespace altiplan::tune {
namespace {

using study::report::Anchor;
using study::report::Axis;
using study::report::Canvas;
using study::report::pixels;

constexpr double kLeft = 66;
constexpr double kRight = study::report::kFigureWidth - 14;
constexpr double kTop = 30;  ///< below the label of what goes up
constexpr double kBottom = 238;

/// By iteration, from the first.
struct Curves {
  std::vector<double> best;  ///< so far; infinite while all has failed
  std::vector<double> mean;  ///< of the iteration's evaluations that have not failed; NaN of none
};

Curves curves_of(const Tuning& tuning) {
  Curves curves;
  std::vector<std::size_t> counts;
  for (const Evaluation& evaluation : tuning.evaluations) {
    if (evaluation.iteration == 0) {
      continue;
    }
    if (evaluation.iteration > curves.best.size()) {
      curves.best.push_back(curves.best.empty() ? kInfinity : curves.best.back());
      curves.mean.push_back(0);
      counts.push_back(0);
    }
    curves.best.back() = std::min(curves.best.back(), evaluation.score);
    if (std::isfinite(evaluation.score)) {
      curves.mean.back() += evaluation.score;
      ++counts.back();
    }
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    curves.mean[i] = counts[i] > 0 ? curves.mean[i] / double(counts[i]) : std::nan("");
  }
  return curves;
}

/// "Length, m" of a value, an expression as it is: its names carry their units.
std::string score_label(const TunePlan& plan, const Axis& up) {
  constexpr std::size_t kMaxCharacters = 60;
  const std::string metric = study::report::printable(plan.request.metric);
  const auto& values = plan.objective.values;
  const bool is_value = values.size() == 1 && values.front().name == metric;
  return study::report::axis_label(
      study::report::shortened(is_value ? study::report::metric_label(metric) : metric,
                               kMaxCharacters),
      up);
}
}  // namespace

study::report::Figure convergence_figure(const TunePlan& plan, const Tuning& tuning) {
  const Curves curves = curves_of(tuning);
  std::vector<double> all = curves.mean;
  all.insert(all.end(), curves.best.begin(), curves.best.end());
  all.push_back(tuning.as_it_is().score);
  const Axis up = Axis::around(all, kBottom, kTop);
  const Axis along(1, std::max(2.0, double(curves.best.size())), false, kLeft, kRight);
  Canvas canvas;
  study::report::draw_left(canvas, up, kLeft, kRight, kTop, score_label(plan, up));
  study::report::draw_bottom(canvas, along, kTop, kBottom, "Iteration, number");
  if (std::isfinite(tuning.as_it_is().score)) {
    const double y = up(tuning.as_it_is().score);
    canvas.line(kLeft, y, kRight, y, "reference");
  }
  std::vector<double> iterations(curves.best.size());
  std::iota(iterations.begin(), iterations.end(), 1);
  draw_curve(canvas, iterations, curves.mean, along, up, study::report::series_line(1));
  draw_curve(canvas, iterations, curves.best, along, up, study::report::series_line(0));
  double y = kBottom + study::report::kAxisHeight + 20;
  y = draw_key(canvas, kLeft, y, 0, "best so far");
  y = draw_key(canvas, kLeft, y, 1, "mean of the iteration, failures left out");
  canvas.line(kLeft, y - 4, kLeft + 26, y - 4, "reference");
  canvas.text(kLeft + 34, y, "the pipeline as it is");
  const std::string metric = study::report::printable(plan.request.metric);
  study::report::Grid numbers{{"iteration", "best", "mean"}, {}};
  for (std::size_t i = 0; i < curves.best.size(); ++i) {
    numbers.rows.push_back({std::to_string(i + 1), study::report::exact(curves.best[i]),
                            study::report::exact(curves.mean[i])});
  }
  return {"convergence",
          "Convergence of " + metric,
          metric + " over " + study::report::counted(plan.tuned_on, "scenario") + ", by " +
              plan.request.tuner,
          study::report::kFigureWidth,
          y + 12,
          canvas.take(),
          std::move(numbers)};
}
}  // namespace altiplan::tune
