// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/tuner.hpp"
#include "host/config/config.hpp"

namespace altiplan::tune {

/// One parameter of `--over`.
struct OverEntry {
  std::string option;  ///< text on the command line
  std::string key;     ///< "steps.0.with.weight_g"
  double min = 0;
  double max = 1;
  bool is_logarithmic = false;
  int group = -1;  ///< of weights that sum to 1
};

/// Reads KEY=LO..HI, KEY=log:LO..HI and 'KEY,KEY=simplex', where a part of the keys may be in
/// braces: steps.0.with.{weight_g,weight_h}. Groups are numbered in order. Throws Error naming the
/// option on a syntax error.
std::vector<OverEntry> read_over(const std::vector<std::string>& options);

/// A tuned parameter of a step, found in the pipeline.
struct TunedParameter {
  OverEntry over;
  bool is_whole = false;  ///< the number is rounded; each whole number is equally likely
  std::string as_it_is;   ///< its value in the pipeline, JSON

  /// That value as printed in tables: `auto` instead of `"auto"`.
  std::string shown() const;
  /// The dimension that the tuner searches.
  Dimension dimension() const;
  /// The parameter's value, as YAML, for a number of that dimension.
  std::string value(double number) const;
};

/// Finds the parameters in the pipeline's steps. Throws ConfigError naming option and key for one
/// that does not exist, is not a number, or has a range beyond its bounds.
std::vector<TunedParameter> find_parameters(const host::Config& config,
                                            const std::vector<OverEntry>& entries);
}  // namespace altiplan::tune
