// SPDX-License-Identifier: Apache-2.0
#include "altiplan/tuner.hpp"

#include <cmath>
#include <map>

#include "altiplan/error.hpp"

namespace altiplan {
namespace {

/// Of a sum of weights, and of a weight that was scaled to that sum.
constexpr double kSlack = 1e-9;

std::string text(double number) { return std::to_string(number); }

void expect_sound(const std::vector<Dimension>& space) {
  std::map<int, std::pair<double, double>> sums;  // of the least and the greatest weights
  for (const Dimension& d : space) {
    if (!std::isfinite(d.min) || !std::isfinite(d.max) || d.min > d.max) {
      throw Error("'" + d.name + "' cannot be tuned from " + text(d.min) + " to " + text(d.max) +
                  ": expected two finite numbers, the first not greater");
    }
    if (d.group >= 0) {
      sums[d.group].first += d.min;
      sums[d.group].second += d.max;
    }
  }
  for (const auto& [group, sum] : sums) {
    if (sum.first > 1 + kSlack || sum.second < 1 - kSlack) {
      throw Error("the weights of group " + std::to_string(group) + " sum to " + text(sum.first) +
                  " at least and " + text(sum.second) + " at most, expected 1 between the two");
    }
  }
}

[[noreturn]] void break_law_1(const std::string& how) {
  throw PluginError("violated the contract of its interface: " + how);
}

void expect_inside(const std::vector<double>& point, const std::vector<Dimension>& space) {
  if (point.size() != space.size()) {
    break_law_1("a point has " + std::to_string(point.size()) + " numbers for " +
                std::to_string(space.size()) + " dimensions");
  }
  std::map<int, double> sums;
  for (std::size_t i = 0; i < space.size(); ++i) {
    const Dimension& d = space[i];
    const double slack = d.group >= 0 ? kSlack : 0;
    if (!(point[i] >= d.min - slack && point[i] <= d.max + slack)) {
      break_law_1("'" + d.name + "' is " + text(point[i]) + ", outside " + text(d.min) + " to " +
                  text(d.max));
    }
    if (d.group >= 0) {
      sums[d.group] += point[i];
    }
  }
  for (const auto& [group, sum] : sums) {
    if (!(std::abs(sum - 1) <= kSlack)) {
      break_law_1("the weights of group " + std::to_string(group) + " sum to " + text(sum));
    }
  }
}
}  // namespace

Search::~Search() = default;
Tuner::~Tuner() = default;

std::vector<std::vector<double>> Search::ask() {
  std::vector<std::vector<double>> batch = do_ask();
  for (const std::vector<double>& point : batch) {
    expect_inside(point, space_);
  }
  asked_ = batch.size();
  return batch;
}

void Search::tell(std::span<const double> scores) {
  if (scores.size() != asked_) {
    throw Error("a search was told " + std::to_string(scores.size()) + " scores for " +
                std::to_string(asked_) + " points");
  }
  for (const double score : scores) {
    if (std::isnan(score)) {
      throw Error("a search was told a score that is not a number; a failure is infinity");
    }
  }
  asked_ = 0;
  do_tell(scores);
}

std::unique_ptr<Search> Tuner::begin(std::vector<Dimension> space, RandomStream random) const {
  expect_sound(space);
  std::unique_ptr<Search> search = do_begin(space, random);
  if (search == nullptr) {
    throw PluginError("violated the contract of its interface: it began no search");
  }
  search->space_ = std::move(space);
  return search;
}
}  // namespace altiplan
