// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace altiplan::study {

// Statistics of samples, independent of studies. docs/statistics.md lists the source of each and
// the equivalent SciPy call. For a sample with a NaN the result is NaN or nullopt, unless stated
// otherwise.

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Interval {
  double low = 0;
  double high = 0;
};

// ---- Distributions

/// Standard normal: P(Z > z).
double normal_tail(double z);
/// The z with P(Z <= z) = p; infinite for 0 and 1, NaN outside [0, 1].
double normal_quantile(double p);
/// P(X > x) of the chi-squared distribution with that many degrees of freedom (at least 1).
double chi_squared_tail(double x, int degrees);
/// P(Q <= q) of the studentized range of k >= 2 normal variables of known variance.
double studentized_range(double q, int k);
/// Its inverse; NaN if p is not in (0, 1) or k < 2.
double studentized_range_quantile(double p, int k);
/// Student's t: the t with P(T <= t) = p; NaN if p is not in (0, 1) or degrees < 1.
double student_quantile(double p, int degrees);
/// P(B <= x) of the beta distribution, for a, b > 0 and x in [0, 1].
double beta_probability(double a, double b, double x);

// ---- Summaries

bool has_nan(std::span<const double> sample);

/// Rounded to 12 significant digits, so that routes along the same points are equally long in
/// whatever order their legs are summed.
double in_12_digits(double value);

double mean(std::span<const double> sample);    ///< NaN if empty
double median(std::span<const double> sample);  ///< NaN if empty
/// Linear between order statistics (type 7 of Hyndman and Fan); NaN if empty, or q not in [0, 1].
double quantile(std::span<const double> sample, double q);

/// Tukey's box plot: whiskers end at the last value within 1.5 interquartile ranges of the box.
struct BoxPlot {
  double low_whisker = 0;
  double q1 = 0;
  double median = 0;
  double q3 = 0;
  double high_whisker = 0;
  std::vector<std::size_t> outliers;  ///< indices into the sample, in its order
};
/// Nothing if the sample is empty or a value is infinite.
std::optional<BoxPlot> box_plot(std::span<const double> sample);

/// Two values of one thing, of which less is better.
using Place = std::array<double, 2>;
/// Indices of the points that no other is at least as good as in both values, without being equal;
/// by the first value. Finite points.
std::vector<std::size_t> non_dominated(std::span<const Place> points);
/// The area between them and the reference: of places better than that in both values, and no
/// better than some point in both. Exact. E. Zitzler, L. Thiele, Multiobjective Optimization Using
/// Evolutionary Algorithms, PPSN V, 1998, doi:10.1007/BFb0056872.
double hypervolume(std::span<const Place> points, const Place& reference);

/// A point of a step function with the value `share` from `at` on.
struct CurvePoint {
  double at = 0;
  double share = 0;
  bool operator==(const CurvePoint&) const = default;
};

/// The share of all runs solved by each time. A run that did not solve has the time NaN and counts
/// only in the total. One point per distinct time.
std::vector<CurvePoint> solved_by(std::span<const double> times);

/// Dolan and Moré's performance profile, a curve per solver: the share of all problems that it
/// solved at a cost of at most `at` times the lowest of all solvers. `costs` has a row per solver,
/// one entry per problem, NaN if not solved. Zero over zero counts as 1, a positive cost over zero
/// as never. Nothing if rows differ in length or a cost is negative or infinite.
std::optional<std::vector<std::vector<CurvePoint>>> performance_profile(
    const std::vector<std::vector<double>>& costs);

// ---- Intervals

/// Wilson's score interval of a share; the numbers need not be whole. Nothing without trials, or if
/// successes are not within 0 … trials or confidence is not in (0, 1).
std::optional<Interval> wilson(double successes, double trials, double confidence);

/// Tango's score interval of the difference of two paired shares, given the numbers of pairs in
/// which only the first and only the second succeeded; not necessarily whole. Also without such
/// pairs it has a width: none of 20 leaves differences up to 0.16. Nothing for impossible numbers.
/// T. Tango, Statistics in Medicine 17, 1998, 891–908.
std::optional<Interval> tango(double gained, double lost, double pairs, double confidence);

/// The minimum number of units for an interval of the quantile q in (0, 1): the maximum of n lies
/// below it with probability q^n, the minimum above it with (1 - q)^n, and neither may exceed half
/// of 1 - confidence. 6 for a median, 72 for q = 0.95, 368 for q = 0.99 and 95 %; 0 for a
/// confidence or q not in (0, 1).
std::size_t fewest_units(double confidence, double q = 0.5);

/// The interval of a quantile between order statistics, by fractional ranks (A. D. Hutson, Journal
/// of Applied Statistics 26, 1999, 343–353): without assumptions on the distribution. `units`: the
/// number of independent values that the sample is worth, at most its size. Nothing for fewer than
/// fewest_units, an empty sample or one with a NaN.
std::optional<Interval> quantile_interval(std::span<const double> sample, double q, double units,
                                          double confidence);

/// The minimum number of units for a mean at this confidence: fewer show too little of a long tail.
/// 10 for 95 %.
std::size_t fewest_for_mean(double confidence);

/// The interval of a mean with the given deviations from it, one per independent unit: that of
/// Student's t, and where the sample's skewness exceeds its standard error, also what Hall's
/// transformation makes of it (P. Hall, Journal of the Royal Statistical Society B 54, 1992,
/// 221–228). Of fewer units than fewest_for_mean also that of Student's t with a third of the
/// degrees of freedom. Nothing for fewer than 4, or if all deviations are zero: how wide the
/// interval is cannot be seen then.
std::optional<Interval> mean_interval(double estimate, std::span<const double> deviations,
                                      double confidence);

// ---- Tests

/// Exact two-sided McNemar test of the numbers of pairs in which only the first and only the second
/// succeeded; 1 if both are 0, NaN for negative numbers.
double mcnemar(std::int64_t only_first, std::int64_t only_second);

/// Ranks from 1, equal values share the mean of theirs.
std::vector<double> ranks(std::span<const double> sample);

/// Method of the p-value: `automatic` is exact for at most 50 non-zero differences.
enum class WilcoxonMethod { automatic, exact, approximate };

struct Wilcoxon {
  double statistic = 0;  ///< the smaller of both sums of ranks
  double p = 0;          ///< two-sided
  /// Matched-pairs rank-biserial correlation, from -1 (all differences negative) to 1.
  double rank_biserial = 0;
  std::size_t used = 0;   ///< differences that are not zero
  std::size_t zeros = 0;  ///< dropped
  bool ties = false;      ///< differences of equal size
  bool exact = false;
};
/// Wilcoxon's signed-rank test of paired differences: zeros are dropped, differences of equal size
/// share the mean of their ranks. The exact test is the permutation test: given the sizes, all sign
/// patterns are equally likely. The approximation is corrected for ties, not for continuity.
/// Nothing if all differences are zero, or if `exact` is requested for more than 1000.
std::optional<Wilcoxon> wilcoxon(std::span<const double> differences,
                                 WilcoxonMethod method = WilcoxonMethod::automatic);

/// Vargha and Delaney's A12: the probability that a value of x exceeds one of y, ties counting
/// half. Nothing if a sample is empty.
std::optional<double> vargha_delaney(std::span<const double> x, std::span<const double> y);
/// Cliff's delta, 2 A12 - 1.
std::optional<double> cliffs_delta(std::span<const double> x, std::span<const double> y);

/// Holm's step-down adjusted p-values, in the order given. A NaN stays NaN and is not counted.
std::vector<double> holm(std::span<const double> p);

struct Friedman {
  double statistic = 0;               ///< corrected for ties; NaN if all are tied
  double p = 0;                       ///< by chi-squared; NaN likewise
  std::vector<double> average_ranks;  ///< one per treatment, 1 for the lowest values
};
/// Friedman's test: a row per treatment (3 or more), one entry per block (1 or more). Nothing for
/// fewer, or if rows differ in length.
std::optional<Friedman> friedman(const std::vector<std::vector<double>>& treatments);

/// Nemenyi's critical difference of average ranks of k treatments over n blocks; NaN for k < 2,
/// n < 1 or alpha not in (0, 1).
double critical_difference(int k, std::int64_t n, double alpha);

/// The bars of a critical-difference diagram: each is a maximal set of two or more treatments, no
/// two of which differ by the critical difference or more; indices by ascending rank.
std::vector<std::vector<std::size_t>> joined(std::span<const double> average_ranks,
                                             double critical_difference);
}  // namespace altiplan::study
