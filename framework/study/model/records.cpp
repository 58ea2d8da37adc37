// SPDX-License-Identifier: Apache-2.0
#include "study/model/records.hpp"

namespace altiplan::study {

std::string run_name(const std::string& pipeline, const std::string& scenario, int repetition) {
  return pipeline + " " + scenario + " #" + std::to_string(repetition);
}

std::string run_name(const StoredRun& run) {
  return run_name(run.pipeline, run.scenario, run.repetition);
}
}  // namespace altiplan::study
