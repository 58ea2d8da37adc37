// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {
namespace {

std::vector<std::size_t> ascending(std::span<const double> sample) {
  std::vector<std::size_t> order(sample.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sample[a] < sample[b]; });
  return order;
}

/// Sum of t³ - t over the groups of t equal values.
double tie_sum(std::span<const double> sample) {
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::upper_bound(first, sorted.end(), *first);
    const double t = double(last - first);
    sum += t * (t * t - 1);
    first = last;
  }
  return sum;
}

/// Two-sided p-value of the sum of the positive ranks, with all 2^n sign patterns equally likely.
double exact_p(std::span<const double> ranks, double positive) {
  // Doubled ranks, since ties may have half ranks. chance[s] = P(sum of the ranks so far = s),
  // halved with each rank added: exact as long as 2^-n is.
  const std::size_t n = ranks.size();
  std::vector<double> chance(n * (n + 1) + 1, 0.0);
  chance[0] = 1;
  std::size_t top = 0;
  for (const double each : ranks) {
    const auto rank = std::size_t(2 * each);
    top += rank;
    for (std::size_t sum = top + 1; sum-- > 0;) {
      chance[sum] = (chance[sum] + (sum >= rank ? chance[sum - rank] : 0)) / 2;
    }
  }
  const auto at = chance.begin() + std::ptrdiff_t(2 * positive);
  const double less = std::accumulate(chance.begin(), at + 1, 0.0);
  const double greater = std::accumulate(at, chance.end(), 0.0);
  return std::min(1.0, 2 * std::min(less, greater));
}

/// Two-sided p-value by the normal approximation; corrected for ties, not for continuity.
double approximate_p(double n, double statistic, double ties) {
  const double mean = n * (n + 1) / 4;
  const double variance = (n * (n + 1) * (2 * n + 1) - ties / 2) / 24;
  return 2 * normal_tail(std::abs(statistic - mean) / std::sqrt(variance));
}

constexpr std::size_t kGreatestExact = 1000;
constexpr std::size_t kGreatestAutomatic = 50;
}  // namespace

std::vector<double> ranks(std::span<const double> sample) {
  if (has_nan(sample)) {
    return std::vector<double>(sample.size(), kNone);
  }
  const std::vector<std::size_t> order = ascending(sample);
  std::vector<double> rank(sample.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && sample[order[last]] == sample[order[first]]) {
      ++last;
    }
    for (std::size_t i = first; i < last; ++i) {
      rank[order[i]] = double(first + 1 + last) / 2;
    }
  }
  return rank;
}

std::optional<Wilcoxon> wilcoxon(std::span<const double> differences, WilcoxonMethod method) {
  Wilcoxon test;
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (std::isnan(difference)) {
      return std::nullopt;
    }
    if (difference == 0) {
      ++test.zeros;
      continue;
    }
    sizes.push_back(std::abs(difference));
    positive.push_back(difference > 0);
  }
  test.used = sizes.size();
  const double ties = tie_sum(sizes);
  test.ties = ties > 0;
  test.exact = method == WilcoxonMethod::exact ||
               (method == WilcoxonMethod::automatic && test.used <= kGreatestAutomatic);
  if (sizes.empty() || (test.exact && test.used > kGreatestExact)) {
    return std::nullopt;
  }
  const std::vector<double> rank = ranks(sizes);
  double above = 0;
  double below = 0;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    (positive[i] ? above : below) += rank[i];
  }
  test.statistic = std::min(above, below);
  test.rank_biserial = (above - below) / (above + below);
  test.p =
      test.exact ? exact_p(rank, above) : approximate_p(double(test.used), test.statistic, ties);
  return test;
}

std::optional<double> vargha_delaney(std::span<const double> x, std::span<const double> y) {
  if (x.empty() || y.empty() || has_nan(x) || has_nan(y)) {
    return std::nullopt;
  }
  std::vector<double> both(x.begin(), x.end());
  both.insert(both.end(), y.begin(), y.end());
  const std::vector<double> rank = ranks(both);
  const double n = double(x.size());
  const double sum = std::accumulate(rank.begin(), rank.begin() + std::ptrdiff_t(x.size()), 0.0);
  return (sum - n * (n + 1) / 2) / (n * double(y.size()));
}

std::optional<double> cliffs_delta(std::span<const double> x, std::span<const double> y) {
  const std::optional<double> a12 = vargha_delaney(x, y);
  return a12 ? std::optional(2 * *a12 - 1) : std::nullopt;
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<double> numbers;
  std::copy_if(p.begin(), p.end(), std::back_inserter(numbers),
               [](double value) { return !std::isnan(value); });
  const std::vector<std::size_t> order = ascending(numbers);
  std::vector<double> adjusted(numbers.size());
  double max_so_far = 0;
  for (std::size_t step = 0; step < order.size(); ++step) {
    max_so_far =
        std::max(max_so_far, std::min(1.0, double(order.size() - step) * numbers[order[step]]));
    adjusted[order[step]] = max_so_far;
  }
  std::vector<double> all(p.begin(), p.end());
  auto next = adjusted.begin();
  for (double& value : all) {
    value = std::isnan(value) ? value : *next++;
  }
  return all;
}

std::optional<Friedman> friedman(const std::vector<std::vector<double>>& treatments) {
  if (treatments.size() < 3 || treatments.front().empty()) {
    return std::nullopt;
  }
  const std::size_t blocks = treatments.front().size();
  for (const std::vector<double>& row : treatments) {
    if (row.size() != blocks || has_nan(row)) {
      return std::nullopt;
    }
  }
  const double k = double(treatments.size());
  const double n = double(blocks);
  std::vector<double> sums(treatments.size(), 0.0);
  double ties = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    std::vector<double> values;
    for (const std::vector<double>& row : treatments) {
      values.push_back(row[block]);
    }
    const std::vector<double> rank = ranks(values);
    std::transform(sums.begin(), sums.end(), rank.begin(), sums.begin(), std::plus<>());
    ties += tie_sum(values);
  }
  Friedman test;
  double squares = 0;
  for (const double sum : sums) {
    test.average_ranks.push_back(sum / n);
    squares += (sum - n * (k + 1) / 2) * (sum - n * (k + 1) / 2);
  }
  const double correction = 1 - ties / (k * (k * k - 1) * n);
  test.statistic = correction > 0 ? 12 / (k * n * (k + 1)) * squares / correction : kNone;
  test.p = chi_squared_tail(test.statistic, int(treatments.size()) - 1);
  return test;
}

double critical_difference(int k, std::int64_t n, double alpha) {
  if (k < 2 || n < 1 || !(alpha > 0 && alpha < 1)) {
    return kNone;
  }
  return studentized_range_quantile(1 - alpha, k) / std::sqrt(2.0) *
         std::sqrt(k * (k + 1.0) / (6.0 * double(n)));
}

std::vector<std::vector<std::size_t>> joined(std::span<const double> average_ranks,
                                             double critical_difference) {
  std::vector<std::vector<std::size_t>> bars;
  if (has_nan(average_ranks)) {
    return bars;
  }
  const std::vector<std::size_t> order = ascending(average_ranks);
  std::size_t reached = 0;
  for (std::size_t first = 0; first < order.size(); ++first) {
    std::size_t end = first + 1;
    while (end < order.size() &&
           average_ranks[order[end]] - average_ranks[order[first]] < critical_difference) {
      ++end;
    }
    if (end > first + 1 && end > reached) {
      bars.emplace_back(order.begin() + std::ptrdiff_t(first), order.begin() + std::ptrdiff_t(end));
      reached = end;
    }
  }
  return bars;
}
}  // namespace altiplan::study
