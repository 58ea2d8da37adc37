// SPDX-License-Identifier: Apache-2.0
// The only file that includes Boost.Math, which is slow to compile.
#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {
namespace {

namespace math = boost::math;

/// Never throws: undefined values are NaN, overflow is infinite. Doubles are not promoted, so that
/// results do not depend on the width of the machine's long double.
using Quiet = math::policies::policy<math::policies::domain_error<math::policies::ignore_error>,
                                     math::policies::pole_error<math::policies::ignore_error>,
                                     math::policies::overflow_error<math::policies::ignore_error>,
                                     math::policies::evaluation_error<math::policies::ignore_error>,
                                     math::policies::promote_double<false>>;
using Normal = math::normal_distribution<double, Quiet>;
using ChiSquared = math::chi_squared_distribution<double, Quiet>;
using Student = math::students_t_distribution<double, Quiet>;
using Binomial = math::binomial_distribution<double, Quiet>;

/// P(a < Z <= b), computed from the tail in which both are small.
double normal_between(double a, double b) {
  return a > 0 ? normal_tail(a) - normal_tail(b) : normal_tail(-b) - normal_tail(-a);
}
}  // namespace

double normal_tail(double z) { return std::erfc(z / std::sqrt(2.0)) / 2; }

double normal_quantile(double p) { return math::quantile(Normal(), p); }

double chi_squared_tail(double x, int degrees) {
  if (std::isnan(x) || degrees < 1) {
    return kNone;
  }
  if (x <= 0 || std::isinf(x)) {  // outside Boost's domain
    return x <= 0 ? 1 : 0;
  }
  return math::cdf(math::complement(ChiSquared(degrees), x));
}

// k ∫ φ(z) [Φ(z) - Φ(z - q)]^(k-1) dz, over the maximum of the k variables; Boost.Math lacks this
// distribution. The integrand decays like a normal density on both sides, so the trapezoidal rule
// converges faster than any power of the step: this step gives full precision.
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
    sum += math::pdf(Normal(), z) * std::pow(normal_between(z - q, z), k - 1);
  }
  return std::min(k * sum * kStep, 1.0);
}

double studentized_range_quantile(double p, int k) {
  if (!(p > 0 && p < 1) || k < 2) {
    return kNone;
  }
  double low = 0;
  double high = 64;  // beyond it the probability rounds to 1
  while (std::nextafter(low, high) < high) {
    const double middle = (low + high) / 2;
    (studentized_range(middle, k) < p ? low : high) = middle;
  }
  return high;
}

double student_quantile(double p, int degrees) {
  return p > 0 && p < 1 && degrees >= 1 ? math::quantile(Student(degrees), p) : kNone;
}

double beta_probability(double a, double b, double x) { return math::ibeta(a, b, x, Quiet()); }

// The binomial distribution of only_first among all discordant pairs, with chance 1/2, which is
// symmetric.
double mcnemar(std::int64_t only_first, std::int64_t only_second) {
  if (only_first < 0 || only_second < 0) {
    return kNone;
  }
  const Binomial chance(double(only_first) + double(only_second), 0.5);
  return std::min(1.0, 2 * math::cdf(chance, double(std::min(only_first, only_second))));
}
}  // namespace altiplan::study
