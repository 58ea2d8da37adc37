// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {
namespace {

bool is_confidence(double confidence) { return confidence > 0 && confidence < 1; }

/// The end of a monotone condition: true at `yes`, false at `no`.
template <class Condition>
double boundary(double yes, double no, const Condition& is_met) {
  for (int step = 0; step < 100 && yes != no; ++step) {
    const double middle = (yes + no) / 2;
    (is_met(middle) ? yes : no) = middle;
  }
  return yes;
}

/// Tango's score of a true difference: standard normal if it is the true one.
double tango_score(double gained, double lost, double pairs, double difference) {
  // The chance of a loss that is most likely under this difference: the larger root of
  // 2 n q² + b q + c.
  const double b = -gained - lost + (2 * pairs - gained + lost) * difference;
  const double c = -lost * difference * (1 - difference);
  const double root = std::sqrt(std::max(b * b - 8 * pairs * c, 0.0));
  const double q = (root - b) / (4 * pairs);
  const double variance = pairs * (2 * q + difference * (1 - difference));
  const double excess = gained - lost - pairs * difference;
  return excess == 0 ? 0 : excess / std::sqrt(std::max(variance, 0.0));
}

/// The sorted sample between its values, from rank 1.
double at_rank(std::span<const double> sorted, double rank) {
  const double place = std::clamp(rank - 1, 0.0, double(sorted.size() - 1));
  const auto below = std::size_t(place);
  const double above = sorted[std::min(below + 1, sorted.size() - 1)];
  const double share = place - double(below);
  return share == 0 || sorted[below] == above ? sorted[below]
                                              : sorted[below] + share * (above - sorted[below]);
}
}  // namespace

std::optional<Interval> wilson(double successes, double trials, double confidence) {
  if (!(trials > 0 && successes >= 0 && successes <= trials) || !is_confidence(confidence)) {
    return std::nullopt;
  }
  const double n = trials;
  const double p = successes / n;
  const double z = normal_quantile((1 + confidence) / 2);
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  // If all or none succeed, the end is exactly 1 or 0, whatever the rounding.
  return Interval{successes == 0 ? 0 : std::clamp(centre - half, 0.0, p),
                  successes == trials ? 1 : std::clamp(centre + half, p, 1.0)};
}

std::optional<Interval> tango(double gained, double lost, double pairs, double confidence) {
  // A margin for numbers of an effective sample, which are rounded.
  if (!(pairs > 0 && gained >= 0 && lost >= 0 && gained + lost <= pairs * (1 + 1e-12)) ||
      !is_confidence(confidence)) {
    return std::nullopt;
  }
  const double z = normal_quantile((1 + confidence) / 2);
  const double estimate = std::clamp((gained - lost) / pairs, -1.0, 1.0);
  const auto is_within = [&](double difference) {
    return std::abs(tango_score(gained, lost, pairs, difference)) <= z;
  };
  return Interval{boundary(estimate, -1, is_within), boundary(estimate, 1, is_within)};
}

std::size_t fewest_units(double confidence, double q) {
  if (!is_confidence(confidence) || !(q > 0 && q < 1)) {
    return 0;
  }
  std::size_t units = 1;
  while (std::pow(std::max(q, 1 - q), double(units)) > (1 - confidence) / 2) {
    ++units;
  }
  return units;
}

std::optional<Interval> quantile_interval(std::span<const double> sample, double q, double units,
                                          double confidence) {
  if (sample.empty() || has_nan(sample) || !(units >= double(fewest_units(confidence, q))) ||
      fewest_units(confidence, q) == 0) {
    return std::nullopt;
  }
  // The order statistic of rank r among n lies below the quantile with the probability that a
  // beta variable of r and n + 1 - r does below q; it falls with r.
  const auto rank_with = [&](double probability) {
    return boundary(1, units, [&](double rank) {
      return beta_probability(rank, units + 1 - rank, q) >= probability;
    });
  };
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  const auto value_with = [&](double probability) {
    return at_rank(sorted, (rank_with(probability) - 0.5) * double(sorted.size()) / units + 0.5);
  };
  return Interval{value_with((1 + confidence) / 2), value_with((1 - confidence) / 2)};
}

std::size_t fewest_for_mean(double confidence) { return fewest_units(confidence) + 4; }

std::optional<Interval> mean_interval(double estimate, std::span<const double> deviations,
                                      double confidence) {
  const double n = double(deviations.size());
  double squares = 0;
  double cubes = 0;
  for (const double each : deviations) {
    squares += each * each;
    cubes += each * each * each;
  }
  const int degrees = int(deviations.size()) - 1;
  if (degrees < 3 || !(squares > 0) || !is_confidence(confidence) || !std::isfinite(squares) ||
      !std::isfinite(estimate)) {
    return std::nullopt;
  }
  const double error = std::sqrt(squares / (n - 1) / n);
  const double t = student_quantile((1 + confidence) / 2, degrees);
  Interval interval{estimate - error * t, estimate + error * t};
  // G1, and a little more: small samples understate skewness. The factor is by simulation.
  const double skewness =
      cubes / n / std::pow(squares / n, 1.5) * std::sqrt(n * (n - 1)) / (n - 2) * (1 + 4 / n);
  if (std::abs(skewness) > std::sqrt(6 / n) * (1 + 4 / n)) {
    // The inverse of Hall's cubic, which takes the skewness out of the studentized mean.
    const auto untransformed = [&](double u) {
      const double a = skewness / 3;
      return std::sqrt(n) / a * (std::cbrt(1 + 3 * a * (u / std::sqrt(n) - a / (2 * n))) - 1);
    };
    interval.low = std::min(interval.low, estimate - error * untransformed(t));
    interval.high = std::max(interval.high, estimate - error * untransformed(-t));
  }
  if (deviations.size() < fewest_for_mean(confidence)) {
    // The sample may lack a tail altogether; a third of the degrees, by simulation, allows for it.
    const double wide = error * student_quantile((1 + confidence) / 2, degrees / 3);
    interval.low = std::min(interval.low, estimate - wide);
    interval.high = std::max(interval.high, estimate + wide);
  }
  return interval;
}
}  // namespace altiplan::study
