// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {
namespace {

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * kPi); }

/// The z <= 0 with P(Z <= z) = p, for p in (0, 0.5].
double lower_quantile(double p) {
  // A start within 5e-4 (Abramowitz and Stegun 1964, 26.2.23), then Halley's method, which triples
  // the digits at each step.
  const double t = std::sqrt(-2 * std::log(p));
  double z = (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) -
             t;
  for (int step = 0; step < 3; ++step) {
    const double newton = (normal_tail(-z) - p) / normal_density(z);
    z -= newton / (1 + z * newton / 2);
  }
  return z;
}

/// P(a < Z <= b), both taken from the tail in which they are small.
double normal_between(double a, double b) {
  return a > 0 ? normal_tail(a) - normal_tail(b) : normal_tail(-b) - normal_tail(-a);
}
}  // namespace

double normal_tail(double z) { return std::erfc(z / std::sqrt(2.0)) / 2; }

double normal_quantile(double p) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!(p >= 0 && p <= 1)) {
    return kNone;
  }
  if (p == 0 || p == 1) {
    return p == 0 ? -kInfinity : kInfinity;
  }
  return p <= 0.5 ? lower_quantile(p) : -lower_quantile(1 - p);
}

// The regularised incomplete gamma function Q(degrees / 2, x / 2), which is a finite sum of
// positive terms for whole degrees: Abramowitz and Stegun 1964, 26.4.4 and 26.4.5.
double chi_squared_tail(double x, int degrees) {
  if (std::isnan(x) || degrees < 1) {
    return kNone;
  }
  if (x <= 0) {
    return 1;
  }
  const double half = x / 2;
  const bool even = degrees % 2 == 0;
  double sum = even ? 0 : std::erfc(std::sqrt(half));
  double term = even ? std::exp(-half) : std::exp(-half) * std::sqrt(half) * 2 / std::sqrt(kPi);
  for (double i = even ? 1 : 1.5; 2 * i <= degrees && term > 0; ++i) {
    sum += term;
    term *= half / i;
  }
  return std::min(sum, 1.0);
}

// k ∫ φ(z) [Φ(z) - Φ(z - q)]^(k-1) dz, over the greatest of the k variables. The trapezoidal rule
// converges faster than any power of the step for such a function, which ends like a normal density
// on both sides: this step gives all digits that erfc has.
double studentized_range(double q, int k) {
  if (std::isnan(q) || k < 2) {
    return kNone;
  }
  if (q <= 0) {
    return 0;
  }
  constexpr double kEnd = 10;
  constexpr double kStep = 1.0 / 32;
  double sum = 0;
  for (double z = -kEnd; z <= kEnd; z += kStep) {
    sum += normal_density(z) * std::pow(normal_between(z - q, z), k - 1);
  }
  return std::min(k * sum * kStep, 1.0);
}

double studentized_range_quantile(double p, int k) {
  if (!(p > 0 && p < 1) || k < 2) {
    return kNone;
  }
  double low = 0;
  double high = 1;
  while (studentized_range(high, k) < p && high < 64) {
    low = high;
    high *= 2;
  }
  for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2) {
    (studentized_range(middle, k) < p ? low : high) = middle;
  }
  return high;
}
}  // namespace altiplan::study
