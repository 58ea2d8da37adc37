// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {
bool has_nan(std::span<const double> sample) {
  return std::any_of(sample.begin(), sample.end(), [](double x) { return std::isnan(x); });
}

namespace {

/// a + t (b - a), monotone in t and exact at both ends, as NumPy's.
double between(double a, double b, double t) {
  if (a == b || t == 0) {
    return a;
  }
  if (std::isinf(a) || std::isinf(b)) {
    return a + b;  // NaN only for infinities of opposite signs
  }
  return t < 0.5 ? a + (b - a) * t : b - (b - a) * (1 - t);
}

/// The step function that rises by 1 / all at each of the values.
std::vector<CurvePoint> steps(std::vector<double> values, std::size_t all) {
  std::sort(values.begin(), values.end());
  std::vector<CurvePoint> curve;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i + 1 == values.size() || values[i + 1] != values[i]) {
      curve.push_back({values[i], double(i + 1) / double(all)});
    }
  }
  return curve;
}

bool comparable(const std::vector<std::vector<double>>& costs) {
  return std::all_of(costs.begin(), costs.end(), [&](const std::vector<double>& row) {
    return row.size() == costs.front().size() &&
           std::none_of(row.begin(), row.end(),
                        [](double cost) { return cost < 0 || std::isinf(cost); });
  });
}

/// The cost as a multiple of the lowest.
double ratio(double cost, double min_cost) {
  return cost == min_cost ? 1 : cost / min_cost;  // infinite over zero
}
}  // namespace

double in_12_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

double mean(std::span<const double> sample) {
  if (sample.empty()) {
    return kNone;
  }
  return std::accumulate(sample.begin(), sample.end(), 0.0) / double(sample.size());
}

double quantile(std::span<const double> values, double q) {
  std::vector<double> sample(values.begin(), values.end());
  if (sample.empty() || !(q >= 0 && q <= 1) || has_nan(sample)) {
    return kNone;
  }
  const double place = q * double(sample.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  const auto at = sample.begin() + below;
  std::nth_element(sample.begin(), at, sample.end());
  if (at + 1 == sample.end()) {
    return *at;
  }
  return between(*at, *std::min_element(at + 1, sample.end()), place - double(below));
}

double median(std::span<const double> sample) { return quantile(sample, 0.5); }

std::optional<BoxPlot> box_plot(std::span<const double> sample) {
  if (sample.empty() ||
      !std::all_of(sample.begin(), sample.end(), [](double x) { return std::isfinite(x); })) {
    return std::nullopt;
  }
  BoxPlot box;
  box.q1 = quantile(sample, 0.25);
  box.median = median(sample);
  box.q3 = quantile(sample, 0.75);
  // A quartile may lie between an inlier and an outlier: keep whiskers outside the box.
  box.low_whisker = box.q1;
  box.high_whisker = box.q3;
  const double reach = 1.5 * (box.q3 - box.q1);
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (sample[i] < box.q1 - reach || sample[i] > box.q3 + reach) {
      box.outliers.push_back(i);
    } else {
      box.low_whisker = std::min(box.low_whisker, sample[i]);
      box.high_whisker = std::max(box.high_whisker, sample[i]);
    }
  }
  return box;
}

std::vector<CurvePoint> solved_by(std::span<const double> times) {
  std::vector<double> solved;
  std::copy_if(times.begin(), times.end(), std::back_inserter(solved),
               [](double time) { return !std::isnan(time); });
  return steps(std::move(solved), times.size());
}

std::optional<std::vector<std::vector<CurvePoint>>> performance_profile(
    const std::vector<std::vector<double>>& costs) {
  if (!comparable(costs)) {
    return std::nullopt;
  }
  std::vector<std::vector<CurvePoint>> curves;
  for (const std::vector<double>& row : costs) {
    std::vector<double> ratios;
    for (std::size_t problem = 0; problem < row.size(); ++problem) {
      double min_cost = row[problem];
      for (const std::vector<double>& other : costs) {
        min_cost = std::fmin(min_cost, other[problem]);  // ignores a NaN
      }
      const double multiple = std::isnan(row[problem]) ? kNone : ratio(row[problem], min_cost);
      if (std::isfinite(multiple)) {
        ratios.push_back(multiple);
      }
    }
    curves.push_back(steps(std::move(ratios), row.size()));
  }
  return curves;
}
}  // namespace altiplan::study
