// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/objective.hpp"

namespace altiplan::kit {

/// What a metre of each step costs by an objective that is a MeanCost: asked once for all levels of
/// a column of cells.
class StepMeans {
 public:
  /// None where levels are too few to be worth the memory, or the objective is none.
  static std::optional<StepMeans> of(const Request& request, const Lattice& lattice) {
    constexpr int kWorthIt = 3;  // levels
    const auto* mean = dynamic_cast<const MeanCost*>(request.objective.get());
    return mean != nullptr && mean->is_mean() && lattice.spec().counts[2] >= kWorthIt
               ? std::optional(StepMeans(*mean, request.objective->name(), lattice.spec().counts))
               : std::nullopt;
  }

  /// Of the step in direction d from a, the position of cell c, to b.
  double at(const Cell& c, int d, const Vec3& a, const Vec3& b) {
    const std::size_t index =
        kLevel * (std::size_t(c[1]) * columns_east_ + std::size_t(c[0])) + std::size_t(d) % kLevel;
    const std::uint64_t known = means_[index];
    return known != 0 ? std::bit_cast<double>(~known) : learn(index, a, b);
  }
  std::size_t bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kLevel = 9;  // directions that differ on the level

  StepMeans(const MeanCost& mean, std::string name, const Cell& counts)
      : mean_(mean), name_(std::move(name)), columns_east_(std::size_t(counts[0])) {
    const std::size_t count = kLevel * columns_east_ * std::size_t(counts[1]);
    means_.reset(count);
    bytes_ = count * sizeof(std::uint64_t);
  }
  double learn(std::size_t index, const Vec3& a, const Vec3& b) {
    const double mean = mean_.per_metre(a, b);
    if (!(mean >= 0)) {
      throw PluginError("the objective " + name_ +
                            " violated the contract of its interface: the cost of a metre is " +
                            std::to_string(mean) + ", expected a number of at least 0",
                        Reason::contract);
    }
    means_.at(index) = ~std::bit_cast<std::uint64_t>(mean);
    return mean;
  }

  const MeanCost& mean_;
  std::string name_;
  std::size_t columns_east_;
  std::size_t bytes_;
  ScratchArray<std::uint64_t> means_;  ///< the inverted bits; 0: not asked yet
};
}  // namespace altiplan::kit
