// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "study/claims/claims.hpp"

namespace altiplan::study {

/// Two pipelines, `a` and `b`, over scenarios and repetitions; a's lengths are 100, 101, …
class Study {
 public:
  Study(int scenarios, int repetitions, double ratio) {
    data_.columns = {"expanded", "flight.collisions", "length_m", "peak_memory_mb", "plan_time_s"};
    data_.pipelines = {{"a", "a", "", {}}, {"b", "b", "", {}}};
    data_.file.repetitions = repetitions;
    for (std::size_t s = 0; s < std::size_t(scenarios); ++s) {
      data_.scenarios.push_back({"s" + std::to_string(s), "s", "", {}});
      for (const std::size_t pipeline : {0U, 1U}) {
        for (int r = 0; r < repetitions; ++r) {
          const double length = 100 + double(s) + 0.01 * r;
          // b's ratio to a varies a little from pair to pair.
          const double varied = ratio * (1 + 0.01 * std::sin(double(7 * s) + r));
          RunRow row;
          row.scenario = s;
          row.pipeline = pipeline;
          row.repetition = r;
          row.outcome = "solved";
          row.values = {10, 0, pipeline == 0 ? length : length * varied, 50, 0.1};
          data_.rows.push_back(row);
        }
      }
    }
  }

  StudyData& data() { return data_; }
  RunRow& row(std::size_t scenario, std::size_t pipeline, int repetition = 0) {
    for (RunRow& row : data_.rows) {
      if (row.scenario == scenario && row.pipeline == pipeline && row.repetition == repetition) {
        return row;
      }
    }
    throw std::out_of_range("no such row");
  }
  /// The run did not solve, and has no values of its route.
  void fail(std::size_t scenario, std::size_t pipeline, const std::string& outcome = "timed_out") {
    RunRow& run = row(scenario, pipeline);
    run.outcome = outcome;
    run.values = {10, kNone, kNone, 80, 1};
  }
  JudgedClaim judge(const std::string& that, const std::string& is) const {
    return judge_claim(data_, {"claim", that, is, 0.95});
  }

 private:
  StudyData data_;
};
}  // namespace altiplan::study
