// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "altiplan/api.hpp"

/// \file The pheromone of ant colonies (kit/colony.hpp), eqs. (2) to (4) of paper 004.
namespace altiplan::kit {

/// x^exponent, by products where the exponent is a small whole number.
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

/// Amounts of pheromone by place, all of which evaporate alike, eq. (4): they are kept in a unit
/// that evaporates in their stead, and count from the initial amount. Only their ratios matter to
/// an ant; what is so little beside the largest that its power alpha would underflow counts as the
/// least that does not.
class ALTIPLAN_API Pheromone {
 public:
  /// Starts anew with the initial amount, 1, at each place.
  void reset(std::size_t places, double evaporation, double alpha);
  void evaporate();
  void lay(std::size_t place, double amount) {
    double& there = amounts_[place];
    there += amount * per_unit_;
    largest_ = largest_ < there ? there : largest_;
  }
  /// To be called when all is laid. Whether every amount is another than before, in the unit.
  bool settle();
  double operator[](std::size_t place) const { return amounts_[place]; }

 private:
  std::vector<double> amounts_;
  double remains_ = 1;
  double per_unit_ = 1;
  double largest_ = 1;
  double least_ = 0;
  bool all_changed_ = false;  ///< since the last time that all was settled
};

/// What is laid in an iteration: sums by place, and the places that have any. Many ants lay on few
/// places, which are then looked at once.
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
