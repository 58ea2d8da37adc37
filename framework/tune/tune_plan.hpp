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

/// The user's request; texts as on the command line.
struct TuneRequest {
  std::filesystem::path pipeline;
  std::vector<std::string> over;
  std::string metric;
  std::vector<std::string> scenarios;  ///< empty: the pipeline's scenario
  std::vector<std::string> hold_out;
  std::string tuner = "pso";
  std::vector<std::string> set_tuner;
  std::int64_t seed = 0;
  std::optional<std::int64_t> evaluations;  ///< maximum number
  std::optional<double> penalty;            ///< metric value of a failed run; none: infinity
  study::StudyBudget limits;                ///< wall_s, cpu_s and memory_mb of a run
  std::vector<std::filesystem::path> plugin_path;
};

/// A tuning, read and checked.
struct TunePlan {
  TuneRequest request;
  host::Config config;                    ///< the original pipeline, in the first scenario
  std::vector<study::Variant> scenarios;  ///< those tuned on, then those held out
  std::size_t tuned_on = 0;               ///< number of those tuned on
  std::vector<TunedParameter> parameters;
  study::ClaimQuantity objective;
  std::unique_ptr<Tuner> tuner;
  /// Everything that determines the result, with names for the user. A tuning can only be continued
  /// with the same settings.
  host::Json settings;

  std::vector<Dimension> space() const;
  /// "steps.0.with.weight_g=0.3" for each parameter.
  std::vector<std::string> assignments(const std::vector<double>& point) const;
  /// The arguments of `altiplan run` that repeat a run.
  host::Overrides overrides(std::size_t scenario,
                            const std::vector<std::string>& assignments) const;
};

/// Reads and checks the request, and the pipeline in every scenario; throws ConfigError and Error
/// naming the option.
TunePlan plan_tuning(const TuneRequest& request);
}  // namespace altiplan::tune
