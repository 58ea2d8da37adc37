// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "altiplan/random.hpp"

namespace altiplan {

/// A number to be tuned. Those of one `group` are weights that sum to 1.
struct Dimension {
  std::string name;
  double min = 0;
  double max = 1;
  int group = -1;
};

/// One optimisation under way. Laws: 1. ask returns points inside the space, all groups summing to
/// 1; an empty batch ends the search. 2. tell follows ask, a score a point, lower is better,
/// infinity a failure. 3. Equal spaces, streams and scores give equal batches.
class ALTIPLAN_API Search {
 public:
  virtual ~Search();
  /// Throws PluginError where the batch breaks contract 1.
  std::vector<std::vector<double>> ask();
  /// Throws Error where there is not a score a point, or one that is not a number.
  void tell(std::span<const double> scores);

 private:
  friend class Tuner;
  virtual std::vector<std::vector<double>> do_ask() = 0;
  virtual void do_tell(std::span<const double> scores) = 0;

  std::vector<Dimension> space_;
  std::size_t asked_ = 0;  ///< points that have no score yet
};

class ALTIPLAN_API Tuner {
 public:
  virtual ~Tuner();
  /// Throws Error where a range is empty or not finite, or no weights of a group within their
  /// bounds sum to 1.
  std::unique_ptr<Search> begin(std::vector<Dimension> space, RandomStream random) const;

 private:
  virtual std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                           RandomStream random) const = 0;
};
}  // namespace altiplan
