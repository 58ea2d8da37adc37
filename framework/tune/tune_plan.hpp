// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/result/result_json.hpp"
#include "study/claims/claim_text.hpp"
#include "study/model/study_file.hpp"
#include "study/plan/study_plan.hpp"
#include "tune/tuned_parameter.hpp"

namespace altiplan::tune {

/// What the user asks for; texts as on the command line.
struct TuneRequest {
  std::filesystem::path pipeline;
  std::vector<std::string> over;
  std::string metric;
  std::vector<std::string> scenarios;  ///< none: the pipeline's own
  std::vector<std::string> hold_out;
  std::string tuner = "pso";
  std::vector<std::string> set_tuner;
  std::int64_t seed = 0;
  std::optional<std::int64_t> evaluations;  ///< at most
  std::optional<double> penalty;            ///< what a failed run counts; none: infinity
  study::StudyBudget limits;                ///< wall_s, cpu_s and memory_mb of a run
  std::vector<std::filesystem::path> plugin_path;
};

/// A tuning, read and checked.
struct TunePlan {
  TuneRequest request;
  host::Config config;                    ///< the pipeline as it is, in the first scenario
  std::vector<study::Variant> scenarios;  ///< those tuned on, then those held back
  std::size_t tuned_on = 0;               ///< how many of them
  std::vector<TunedParameter> parameters;
  study::ClaimQuantity objective;
  std::unique_ptr<Tuner> tuner;
  /// All that decides what comes of it, by words for the user. A tuning that goes on must have the
  /// same.
  host::Json settings;

  std::vector<Dimension> space() const;
  /// "steps.0.with.weight_g=0.3" for each parameter.
  std::vector<std::string> assignments(const std::vector<double>& point) const;
  /// What `altiplan run` would be given to do a run by itself.
  host::Overrides overrides(std::size_t scenario,
                            const std::vector<std::string>& assignments) const;
};

/// Reads and checks all that is asked for, the pipeline in every scenario; throws ConfigError and
/// Error naming the option.
TunePlan plan_tuning(const TuneRequest& request);
}  // namespace altiplan::tune
