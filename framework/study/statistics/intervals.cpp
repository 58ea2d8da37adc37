// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {
namespace {

bool is_confidence(double confidence) { return confidence > 0 && confidence < 1; }

/// The values of a sample by group; each value its own group if there is only one group.
class Groups {
 public:
  explicit Groups(std::span<const std::size_t> groups) {
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      members[groups[i]].push_back(i);
    }
    if (members.size() > 1) {
      for (auto& [group, indices] : members) {
        members_.push_back(std::move(indices));
      }
      return;
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
      members_.push_back({i});
    }
  }

  std::size_t count() const { return members_.size(); }

  void draw(RandomStream stream, std::vector<std::size_t>& indices) const {
    indices.clear();
    for (std::size_t drawn = 0; drawn < members_.size(); ++drawn) {
      const auto group = stream.integer(0, std::int64_t(members_.size()) - 1);
      const std::vector<std::size_t>& members = members_[std::size_t(group)];
      indices.insert(indices.end(), members.begin(), members.end());
    }
  }

 private:
  std::vector<std::vector<std::size_t>> members_;
};

RandomStream stream_of(const RandomStream& stream, std::size_t number) {
  return stream.sub("resample", number);
}

/// NaN for an empty resample or an index outside the sample.
double of_resample(std::span<const double> sample, const std::vector<std::size_t>& indices,
                   const Statistic& statistic, std::vector<double>& drawn) {
  drawn.clear();
  for (const std::size_t index : indices) {
    if (index >= sample.size()) {
      return kNone;
    }
    drawn.push_back(sample[index]);
  }
  return drawn.empty() ? kNone : statistic(drawn);
}

std::optional<Interval> percentiles(std::vector<double> estimates, double confidence) {
  if (!is_confidence(confidence)) {
    return std::nullopt;
  }
  const double low = quantile_in_place(estimates, (1 - confidence) / 2);
  const double high = quantile_in_place(estimates, (1 + confidence) / 2);
  return std::isnan(low) || std::isnan(high) ? std::nullopt : std::optional(Interval{low, high});
}
}  // namespace

std::optional<Interval> wilson(std::int64_t successes, std::int64_t trials, double confidence) {
  if (trials < 1 || successes < 0 || successes > trials || !is_confidence(confidence)) {
    return std::nullopt;
  }
  const double n = double(trials);
  const double p = double(successes) / n;
  const double z = normal_quantile((1 + confidence) / 2);
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  // If all or none succeed, the end is exactly 1 or 0, whatever the rounding.
  return Interval{successes == 0 ? 0 : std::clamp(centre - half, 0.0, p),
                  successes == trials ? 1 : std::clamp(centre + half, p, 1.0)};
}

std::optional<Interval> bootstrap_interval(std::span<const double> sample,
                                           const Statistic& statistic,
                                           const std::vector<std::vector<std::size_t>>& resamples,
                                           double confidence) {
  std::vector<double> estimates;
  std::vector<double> drawn;
  for (const std::vector<std::size_t>& indices : resamples) {
    estimates.push_back(of_resample(sample, indices, statistic, drawn));
  }
  return percentiles(std::move(estimates), confidence);
}

std::vector<std::size_t> resample(std::span<const std::size_t> groups, const RandomStream& stream,
                                  std::size_t number) {
  std::vector<std::size_t> indices;
  Groups(groups).draw(stream_of(stream, number), indices);
  return indices;
}

std::size_t resampled_units(std::span<const std::size_t> groups) { return Groups(groups).count(); }

std::size_t fewest_units(double confidence, double q) {
  if (!is_confidence(confidence)) {
    return 0;
  }
  std::size_t units = 1;
  while (1 - std::pow(q, double(units)) - std::pow(1 - q, double(units)) < confidence) {
    ++units;
  }
  return units;
}

std::optional<Interval> bootstrap_interval(std::span<const double> sample,
                                           std::span<const std::size_t> groups,
                                           const Statistic& statistic, const RandomStream& stream,
                                           double confidence, std::size_t resamples) {
  const Groups grouped(groups);
  if (!is_confidence(confidence) || groups.size() != sample.size() ||
      grouped.count() < fewest_units(confidence)) {
    return std::nullopt;
  }
  std::vector<double> estimates;
  std::vector<double> drawn;
  std::vector<std::size_t> indices;
  for (std::size_t number = 0; number < resamples; ++number) {
    grouped.draw(stream_of(stream, number), indices);
    estimates.push_back(of_resample(sample, indices, statistic, drawn));
  }
  return percentiles(std::move(estimates), confidence);
}
}  // namespace altiplan::study
