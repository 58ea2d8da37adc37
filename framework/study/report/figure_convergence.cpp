// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "host/view/series_colors.hpp"
#include "study/figures/text.hpp"
#include "study/report/figures.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kConvergenceLeft = 66;
constexpr double kConvergenceRight = kFigureWidth - 14;
constexpr double kConvergenceTop = 30;
constexpr double kConvergenceBottom = 214;
constexpr double kAliveTop = 246;
constexpr double kAliveBottom = 296;

/// A spread by iteration, as points of the figure.
struct Band {
  std::vector<double> x;
  std::vector<Spread> y;
};

/// A best length holds until the next one is found; a population has all iterations.
Band band_of(const Convergence& convergence, const std::vector<Spread>& spreads) {
  Band band;
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    if (i > 0 && !convergence.is_population) {
      band.x.push_back(convergence.iterations[i]);
      band.y.push_back(spreads[i - 1]);
    }
    band.x.push_back(convergence.iterations[i]);
    band.y.push_back(spreads[i]);
  }
  return band;
}

void draw(Canvas& canvas, const Band& band, const Axis& along, const Axis& up, std::size_t series) {
  draw_spread(canvas, band.x, band.y, along, up, series);
}

Axis axis_up(const std::vector<const std::vector<Spread>*>& all, double bottom, double top) {
  std::vector<double> values;
  for (const std::vector<Spread>* spreads : all) {
    for (const Spread& spread : *spreads) {
      values.insert(values.end(), {spread.low, spread.median, spread.high});
    }
  }
  return Axis::around(values, bottom, top);
}

Grid numbers_of(const Convergence& convergence) {
  Grid grid{{"iteration"}, {}};
  std::vector<const std::vector<Spread>*> spreads{&convergence.best};
  std::vector<std::string> names{"best"};
  if (convergence.is_population) {
    spreads.insert(spreads.end(), {&convergence.mean, &convergence.alive});
    names.insert(names.end(), {"mean", "alive"});
  }
  for (const std::string& name : names) {
    for (const char* part : {"_p10", "_median", "_p90"}) {
      grid.columns.push_back(name + part);
    }
  }
  const auto cell = [](double value) { return std::isfinite(value) ? exact(value) : ""; };
  for (std::size_t i = 0; i < convergence.iterations.size(); ++i) {
    grid.rows.push_back({exact(convergence.iterations[i])});
    for (const std::vector<Spread>* of : spreads) {
      const Spread& spread = (*of)[i];
      for (const double value : {spread.low, spread.median, spread.high}) {
        grid.rows.back().push_back(cell(value));
      }
    }
  }
  return grid;
}

std::string caption_of(const Convergence& convergence) {
  return "Median of " + counted(convergence.runs, "run") +
         " and the band from the 10th to the 90th percentile" +
         (convergence.is_ratio ? "; lengths relative to the final best of their run" : "") +
         ". A best length is infinite while there is no route.";
}

std::string place(double x, double y) { return pixels(x) + " " + pixels(y); }

/// The area between the percentiles, where both are finite.
void fill(Canvas& canvas, const std::vector<double>& x, const std::vector<Spread>& y,
          const Axis& along, const Axis& up, std::size_t series) {
  std::string d;
  std::string there;
  std::string back;
  const auto close = [&] {
    d += there.empty() ? "" : "M" + there.substr(1) + back + "Z";
    there.clear();
    back.clear();
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(y[i].low) && std::isfinite(y[i].high)) {
      there += "L" + place(along(x[i]), up(y[i].high));
      back = "L" + place(along(x[i]), up(y[i].low)) + back;
    } else {
      close();
    }
  }
  close();
  if (!d.empty()) {
    canvas.path(d, series_fill_pale(series));
  }
}
}  // namespace

void draw_spread(Canvas& canvas, const std::vector<double>& x, const std::vector<Spread>& y,
                 const Axis& along, const Axis& up, std::size_t series) {
  fill(canvas, x, y, along, up, series);
  std::vector<double> medians;
  for (const Spread& spread : y) {
    medians.push_back(spread.median);
  }
  draw_curve(canvas, x, medians, along, up, series_line(series));
}

Figure convergence_figure(const StudyData& data, const Convergence& convergence) {
  const bool is_population = convergence.is_population;
  const std::size_t best = data.series_of(convergence.pipeline);
  const std::size_t mean = best + host::kSeriesColors.size();  // the same colour, dashed
  const double last = convergence.iterations.back();
  const double first = convergence.iterations.front();
  const Axis along(first, std::max(last, first + 1), false, kConvergenceLeft, kConvergenceRight);
  Canvas canvas;
  const Axis up = is_population ? axis_up({&convergence.best, &convergence.mean},
                                          kConvergenceBottom, kConvergenceTop)
                                : axis_up({&convergence.best}, kConvergenceBottom, kConvergenceTop);
  draw_left(canvas, up, kConvergenceLeft, kConvergenceRight, kConvergenceTop,
            axis_label(convergence.is_ratio ? "Length / final best" : "Length, m", up));
  const double bottom = is_population ? kAliveBottom : kConvergenceBottom;
  draw_bottom(canvas, along, kConvergenceTop, bottom, "Iteration, number");
  if (is_population) {
    draw(canvas, band_of(convergence, convergence.mean), along, up, mean);
    double highest = 1;
    for (const Spread& spread : convergence.alive) {
      highest = std::max(highest, spread.high);
    }
    const Axis alive(0, 1.04 * highest, false, kAliveBottom, kAliveTop);
    draw_left(canvas, alive, kConvergenceLeft, kConvergenceRight, kAliveTop,
              "Found a route in the iteration, number");
    draw(canvas, band_of(convergence, convergence.alive), along, alive, best);
  }
  draw(canvas, band_of(convergence, convergence.best), along, up, best);
  double y = bottom + kAxisHeight + 20;
  y = draw_key(canvas, kConvergenceLeft, y, best, "best so far");
  y = is_population ? draw_key(canvas, kConvergenceLeft, y, mean, "mean of the iteration") : y;
  const std::string step = convergence.is_only_step ? "" : ", step " + printable(convergence.step);
  return {"convergence-" + slug(data.pipelines[convergence.pipeline].name) +
              (step.empty() ? "" : "-" + slug(convergence.step)),
          "Convergence of " + pipeline_label(data, convergence.pipeline) + step,
          caption_of(convergence),
          kFigureWidth,
          y - 6,
          canvas.take(),
          numbers_of(convergence)};
}
}  // namespace altiplan::study::report
