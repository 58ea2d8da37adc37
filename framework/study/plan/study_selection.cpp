// SPDX-License-Identifier: Apache-2.0
#include "study/plan/study_selection.hpp"

#include <regex.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "host/base/sha256.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::study {
namespace {

constexpr std::size_t kMaxRuns = 10000000;

/// 53 bits of a hash: exact in JSON too.
std::int64_t number_of(const std::string& text) {
  return std::int64_t(std::stoull(host::sha256_of(text).substr(0, 16), nullptr, 16) >> 11);
}

/// A POSIX extended regular expression: std::regex overflows the stack on long names and needs
/// exponential time on some short ones.
class Filter {
 public:
  explicit Filter(const std::string& text) {
    if (text.find('\0') != text.npos ||
        regcomp(&compiled_, text.c_str(), REG_EXTENDED | REG_NOSUB) != 0) {
      throw Error(
          "--filter: expected a regular expression on 'PIPELINE SCENARIO #REPETITION', found " +
          excerpt(text));
    }
  }
  ~Filter() { regfree(&compiled_); }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;
  bool finds(const std::string& name) const {
    return regexec(&compiled_, name.c_str(), 0, nullptr, 0) == 0;
  }

 private:
  regex_t compiled_{};
};
}  // namespace

std::vector<PlannedRun> all_runs(const StudyPlan& plan) {
  const std::size_t repetitions = std::size_t(plan.file.repetitions);
  const std::size_t pairs = plan.scenarios.size() * repetitions;
  if (pairs > kMaxRuns || pairs * plan.pipelines.size() > kMaxRuns) {
    throw ConfigError(Location{plan.path.string(), 0, 0, ""}, "",
                      std::to_string(plan.scenarios.size()) + " scenarios, " +
                          std::to_string(plan.pipelines.size()) + " pipelines and " +
                          std::to_string(repetitions) + " repetitions are more than 10000000 runs");
  }
  std::vector<PlannedRun> runs;
  for (std::size_t s = 0; s < plan.scenarios.size(); ++s) {
    for (int r = 0; r < plan.file.repetitions; ++r) {
      const std::int64_t seed = number_of("seed\n" + std::to_string(plan.file.seed) + "\n" +
                                          plan.scenarios[s].name + "\n" + std::to_string(r));
      for (std::size_t p = 0; p < plan.pipelines.size(); ++p) {
        runs.push_back({s, p, r, seed, ""});
      }
    }
  }
  return runs;
}

std::vector<PlannedRun> selected_runs(const StudyPlan& plan, const StudySelection& selection) {
  std::vector<PlannedRun> all = all_runs(plan);
  std::erase_if(all, [&](const PlannedRun& run) {
    return (!selection.scenarios.empty() &&
            plan.scenarios[run.scenario].of != selection.scenarios) ||
           (!selection.pipelines.empty() &&
            !selection.pipelines.contains(plan.pipelines[run.pipeline].name));
  });
  const std::string study = std::to_string(plan.file.seed) + "\n";
  std::vector<std::pair<std::int64_t, std::size_t>> order;
  const Filter filter(selection.filter);
  // Whole pairs are sampled, lowest hashes first, so that a larger sample contains a smaller one.
  std::map<std::int64_t, bool> pairs;
  const auto pair_hash = [&](const PlannedRun& run) {
    return number_of("pair\n" + study + std::to_string(run.seed));
  };
  if (selection.sample) {
    for (const PlannedRun& run : all) {
      pairs[pair_hash(run)] = false;
    }
    const double wanted = *selection.sample * double(pairs.size());
    std::size_t left = std::max<std::size_t>(1, std::size_t(std::lround(wanted)));
    for (auto& [hash, is_in] : pairs) {
      if (left > 0) {
        is_in = true;
        --left;
      }
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string name = name_of_run(plan, all[i]);
    const bool is_sampled = !selection.sample || pairs[pair_hash(all[i])];
    if (is_sampled && (selection.filter.empty() || filter.finds(name))) {
      order.emplace_back(number_of("order\n" + study + name), i);
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<PlannedRun> chosen;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (int(i % std::size_t(selection.shards)) == selection.shard - 1) {
      chosen.push_back(all[order[i].second]);
    }
  }
  return chosen;
}
}  // namespace altiplan::study
