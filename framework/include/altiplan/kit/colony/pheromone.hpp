// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "altiplan/api.hpp"

/// \file The pheromone of ant colonies (kit/colony.hpp), eqs. (2) to (4) of paper 004.
namespace altiplan::kit {

/// x^exponent, by repeated multiplication where the exponent is a small integer.
class Power {
 public:
  explicit Power(double exponent)
      : exponent_(exponent),
        whole_(exponent == std::floor(exponent) && exponent >= 0 && exponent <= 64 ? int(exponent)
                                                                                   : -1) {}
  double operator()(double x) const {
    if (whole_ < 0) {
      return std::pow(x, exponent_);
    }
    double power = 1;
    for (int n = whole_; n > 0; n >>= 1) {
      power *= (n & 1) != 0 ? x : 1;
      x *= x;
    }
    return power;
  }

 private:
  double exponent_;
  int whole_;
};

/// Pheromone per place; all of it evaporates at the same rate, eq. (4): the unit of the stored
/// values evaporates instead of them, and values are relative to the initial amount. Only ratios
/// matter to an ant; a value so small beside the largest that its power alpha would underflow is
/// raised to the smallest that does not.
class ALTIPLAN_API Pheromone {
 public:
  /// Resets every place to the initial amount, 1.
  void reset(std::size_t places, double evaporation, double alpha);
  void evaporate();
  void lay(std::size_t place, double amount) {
    double& there = amounts_[place];
    there += amount * per_unit_;
    largest_ = largest_ < there ? there : largest_;
  }
  /// Call after all deposits. True if every amount has changed, in the stored unit.
  bool settle();
  double operator[](std::size_t place) const { return amounts_[place]; }

 private:
  std::vector<double> amounts_;
  double remains_ = 1;
  double per_unit_ = 1;
  double largest_ = 1;
  double min_amount_ = 0;
  bool all_changed_ = false;  ///< since the last settle
};

/// Deposits of one iteration: sums per place, and the places with any. Many ants use few places,
/// each of which is then processed once.
template <class Real>
class Deposits {
 public:
  void reset(std::size_t places) {
    sums_.assign(places, 0);
    places_.clear();
  }
  void lay(std::uint32_t place, double amount) {
    if (sums_[place] == 0) {
      places_.push_back(place);
    }
    sums_[place] += Real(amount);
  }
  const std::vector<std::uint32_t>& places() const { return places_; }
  double operator[](std::uint32_t place) const { return double(sums_[place]); }
  void clear() {
    for (const std::uint32_t place : places_) {
      sums_[place] = 0;
    }
    places_.clear();
  }

 private:
  std::vector<Real> sums_;
  std::vector<std::uint32_t> places_;
};
}  // namespace altiplan::kit
