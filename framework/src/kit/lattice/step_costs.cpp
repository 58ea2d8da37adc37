// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/step_costs.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace altiplan::kit {
namespace {

// Integers whose products with sqrt 2, or with sqrt 2 and sqrt 3, are nearer to integers than for
// any smaller one (the coarsest is the customary ratio).
constexpr std::uint32_t kSquares[] = {70, 408, 985, 2378, 5741, 33461, 195025, 1136689, 6625109};
constexpr std::uint32_t kCubes[] = {41, 1463, 4109, 20586, 192070, 326491, 2151016};
// Steps of this accuracy need no finer ones; a search is faster with coarser keys.
constexpr double kFineEdge = 25000;

/// Cost of an edge: one of the records if there are any, else any integer.
double edge_cost(std::span<const std::uint32_t> records, StepCosts::Scale scale, double maximum) {
  if (scale == StepCosts::Scale::ratio) {
    return std::min(maximum, double(records.front()));
  }
  if (scale == StepCosts::Scale::fine) {
    maximum = std::min(maximum, kFineEdge);
  }
  const auto beyond = std::upper_bound(records.begin(), records.end(), maximum);
  return beyond == records.begin() ? std::floor(maximum) : double(*(beyond - 1));
}
}  // namespace

StepCosts::StepCosts(const Lattice& lattice, Scale scale, double longest_m) {
  const double max_per_metre = kMax / longest_m;
  const Vec3& cell = lattice.spec().cell;
  const bool level = lattice.spec().counts[2] == 1;
  const bool square = cell.x() == cell.y();
  const bool cube = square && cell.y() == cell.z();
  const double edge = level ? cell.head<2>().minCoeff() : cell.minCoeff();
  if (cube || (level && square)) {
    const std::span<const std::uint32_t> records =
        level ? std::span<const std::uint32_t>(kSquares) : kCubes;
    per_metre_ = edge_cost(records, scale, max_per_metre * edge) / edge;
  } else {
    per_metre_ = scale == Scale::ratio ? std::min(max_per_metre, 41 / edge) : max_per_metre;
  }
  for (int d = kHere; d < kDirections; ++d) {  // steps to opposite sides are alike
    const double length = lattice.step_length(d);
    costs_[std::size_t(d)] = costs_[std::size_t(opposite(d))] = of(length);
    if ((lattice.steps() >> d & 1) != 0) {
      const double error = std::abs(costs_[std::size_t(d)] / (length * per_metre_) - 1);
      error_ = costs_[std::size_t(d)] > 0 ? std::max(error_, error) : kInfinity;
    }
  }
  // Rounding costs at most half a unit of a step's cost and one of the bound's fall along it.
  const double min_cost = edge * per_metre_;
  bound_per_metre_ = per_metre_ * std::max(0.0, 1 - 2 / min_cost);
  const bool faces = (lattice.steps() >> direction(1, 1, 0) & 1) == 0;
  for (int set = 0; set < 8; ++set) {
    const auto cost = [&](int axes) {
      return costs_[std::size_t(direction(axes & 1, axes >> 1 & 1, axes >> 2 & 1))];
    };
    along_[std::size_t(set)] = faces ? cost(set & 1) + cost(set & 2) + cost(set & 4) : cost(set);
  }
  alike_ = along_[1] == along_[2] && along_[2] == along_[4] && along_[3] == along_[5] &&
           along_[5] == along_[6];
  if (!alike_) {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {
      std::array<std::uint32_t, 3> n{};
      n[axes[0]] = 2;
      n[axes[1]] = 1;
      const std::size_t one = std::size_t{1} << axes[0];
      const std::size_t two = one | std::size_t{1} << axes[1];
      auto& marginal = marginal_[order_of(n)];
      marginal[axes[0]] = along_[one];
      marginal[axes[1]] = along_[two] - along_[one];
      marginal[axes[2]] = along_[7] - along_[two];
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
}

StepCosts::Scale StepCosts::between(Scale wanted, const Lattice& lattice, const Vec3& start,
                                    const Vec3& goal) {
  const bool linked = lattice.nearest(start).length > 0 || lattice.nearest(goal).length > 0;
  return wanted == Scale::fine && linked ? Scale::finest : wanted;
}
}  // namespace altiplan::kit
