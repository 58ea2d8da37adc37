// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/tuner.hpp"
#include "host/config/config.hpp"

namespace altiplan::tune {

/// What `--over` says of one parameter.
struct OverEntry {
  std::string option;  ///< as the user gave it
  std::string key;     ///< "steps.0.with.weight_g"
  double min = 0;
  double max = 1;
  bool is_logarithmic = false;
  int group = -1;  ///< of weights that sum to 1
};

/// Reads KEY=LO..HI, KEY=log:LO..HI and 'KEY,KEY=simplex', where a part of the keys may stand in
/// braces: steps.0.with.{weight_g,weight_h}. Groups are numbered as they come. Throws Error naming
/// the option for what cannot be read.
std::vector<OverEntry> read_over(const std::vector<std::string>& options);

/// A parameter of a step that is tuned, found in the pipeline.
struct TunedParameter {
  OverEntry over;
  bool is_whole = false;  ///< the number is rounded; each whole number has the same share
  std::string as_it_is;   ///< its value in the pipeline, JSON

  /// That value as tables have it: `auto` in place of `"auto"`.
  std::string shown() const;
  /// What the tuner sees of it.
  Dimension dimension() const;
  /// The parameter's value at a number of that dimension, as YAML has it.
  std::string value(double number) const;
};

/// Finds the parameters in the pipeline's steps. Throws ConfigError naming option and key for one
/// that is not there, is no number, or is to leave the bounds that it has.
std::vector<TunedParameter> find_parameters(const host::Config& config,
                                            const std::vector<OverEntry>& entries);
}  // namespace altiplan::tune
