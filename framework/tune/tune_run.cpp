// SPDX-License-Identifier: Apache-2.0
#include "tune/tune_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "host/base/machine_fault.hpp"
#include "study/claims/claim_pairs.hpp"
#include "study/claims/claims.hpp"
#include "study/model/run_values.hpp"
#include "study/run/study_worker.hpp"
#include "study/statistics/statistics.hpp"
#include "study/workers/worker_pool.hpp"
#include "tune/tune_guards.hpp"

namespace altiplan::tune {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

/// Calls the tuner; attributes its exceptions to it.
template <class Call>
auto of_tuner(const TunePlan& plan, const Call& call) {
  const std::string who = "the tuner '" + plan.request.tuner + "' ";
  try {
    return call();
  } catch (const PluginError& error) {
    throw PluginError(who + error.what(), error.reason());
  } catch (...) {
    attribute_to(who);
  }
}

/// Number of points that the tuner requests if all scores are equal.
std::size_t rehearsed(const TunePlan& plan, const RandomStream& random) {
  constexpr std::size_t kMax = 1'000'000;
  const auto limit = std::size_t(plan.request.evaluations.value_or(kMax));
  const auto search = plan.tuner->begin(plan.space(), random);
  std::size_t points = 0;
  while (points < limit) {
    const std::size_t asked = search->ask().size();
    if (asked == 0) {
      break;
    }
    points += asked;
    search->tell(std::vector<double>(asked, 1.0));
  }
  return std::min(points, limit);
}

struct Interrupted {};

class TuningRun {
 public:
  TuningRun(const TunePlan& plan, const TuneOptions& options)
      : plan_(plan),
        options_(options),
        folder_(options.out / "work"),
        log_(options.out, plan.settings, options.fresh),
        files_(plan.settings.at("files")),
        pool_(folder_, pool_options()) {
    folder_.clear();  // records of a killed call: run again
  }

  Tuning operator()() {
    try {
      search();
      hold_out();
      log_.finish();
    } catch (const Interrupted&) {
      tuning_.is_interrupted = true;
    }
    tuning_.runs_done = progress_.runs;
    tuning_.damaged_lines = log_.damaged();
    tuning_.elapsed_s = std::chrono::duration<double>(Clock::now() - began_).count();
    return std::move(tuning_);
  }

 private:
  /// A pending run.
  struct Wanted {
    std::size_t evaluation;
    std::size_t scenario;
  };

  study::PoolOptions pool_options() {
    study::PoolOptions pool;
    pool.jobs = options_.jobs;
    pool.reuse = 1000;
    pool.limits = study::job_limits(plan_.request.limits);
    pool.key = [this](std::size_t i) {
      return std::to_string(wanted_[i].evaluation) + " " + std::to_string(wanted_[i].scenario);
    };
    pool.appraise = [this](const study::Ended& ended) {
      const Wanted& wanted = wanted_[ended.job];
      return study::appraisal_of(
          ended, plan_.request.limits,
          plan_.scenarios[wanted.scenario].name + " with " + parameters_of(wanted.evaluation));
    };
    return pool;
  }

  void search() {
    const RandomStream random = RandomStream(std::uint64_t(plan_.request.seed)).sub("tuner");
    tuning_.evaluations.emplace_back();
    progress_.expected = of_tuner(plan_, [&] { return rehearsed(plan_, random); });
    evaluate(0, 0, plan_.tuned_on);
    expect_values();
    const auto search = of_tuner(plan_, [&] { return plan_.tuner->begin(plan_.space(), random); });
    const std::int64_t max_evaluations =
        plan_.request.evaluations.value_or(std::numeric_limits<std::int64_t>::max());
    for (std::size_t iteration = 1;; ++iteration) {
      const auto batch = of_tuner(plan_, [&] { return search->ask(); });
      const std::size_t first = tuning_.evaluations.size();
      for (const std::vector<double>& point : batch) {
        if (std::int64_t(tuning_.evaluations.size()) <= max_evaluations) {
          Evaluation evaluation;
          evaluation.iteration = iteration;
          evaluation.assignments = plan_.assignments(point);
          tuning_.evaluations.push_back(std::move(evaluation));
        }
      }
      evaluate(first, 0, plan_.tuned_on);
      if (batch.empty() || tuning_.evaluations.size() - first < batch.size()) {
        return;
      }
      std::vector<double> scores;
      for (std::size_t i = first; i < tuning_.evaluations.size(); ++i) {
        scores.push_back(tuning_.evaluations[i].score);
      }
      of_tuner(plan_, [&] { search->tell(scores); });
    }
  }

  void hold_out() {
    for (const std::size_t i : {std::size_t(0), tuning_.best}) {
      if (tuning_.evaluations[i].runs.size() == plan_.tuned_on) {
        run_missing(i, i + 1, plan_.tuned_on, plan_.scenarios.size());
      }
    }
  }

  /// Runs and scores the evaluations from `first` on.
  void evaluate(std::size_t first, std::size_t from, std::size_t to) {
    run_missing(first, tuning_.evaluations.size(), from, to);
    for (std::size_t i = first; i < tuning_.evaluations.size(); ++i) {
      score(tuning_.evaluations[i]);
      if (is_better(tuning_.evaluations[i], tuning_.tuned())) {
        tuning_.best = i;
      }
    }
    progress_.evaluations = tuning_.evaluations.size() - 1;
    progress_.best = tuning_.tuned().score;
    tell_progress();
  }

  /// Solving more scenarios ranks first, whatever the penalty of failures.
  static bool is_better(const Evaluation& a, const Evaluation& b) {
    return a.failed != b.failed ? a.failed < b.failed : a.score < b.score;
  }

  /// The mean over the scenarios, with the penalty or infinity for failed runs.
  void score(Evaluation& evaluation) const {
    double sum = 0;
    for (std::size_t s = 0; s < plan_.tuned_on; ++s) {
      const ScoredRun& run = evaluation.runs[s];
      evaluation.failed += !run.value;
      sum += run.value.value_or(plan_.request.penalty.value_or(kInfinity));
    }
    evaluation.score = study::in_12_digits(sum / double(plan_.tuned_on));
  }

  /// Assigns runs to the evaluations: logged ones, those of an earlier evaluation with the same
  /// parameters, otherwise new ones.
  void run_missing(std::size_t first, std::size_t last, std::size_t from, std::size_t to) {
    wanted_.clear();
    std::vector<std::size_t> jobs;
    for (std::size_t i = first; i < last; ++i) {
      const std::string parameters = parameters_of(i);
      const std::size_t same = first_with_.try_emplace(parameters, i).first->second;
      for (std::size_t s = from; s < to; ++s) {
        if (same == i && log_.find({i, s}, parameters) == nullptr) {
          jobs.push_back(wanted_.size());
          wanted_.push_back({i, s});
        }
      }
    }
    run(jobs);
    for (std::size_t i = first; i < last; ++i) {
      const std::string parameters = parameters_of(i);
      for (std::size_t s = from; s < to; ++s) {
        const ScoredRun* known = log_.find({first_with_.at(parameters), s}, parameters);
        tuning_.evaluations[i].runs.push_back(*known);
      }
    }
  }

  std::string parameters_of(std::size_t evaluation) const {
    std::string text;
    for (const std::string& assignment : tuning_.evaluations[evaluation].assignments) {
      text += (text.empty() ? "" : " ") + assignment;
    }
    return text.empty() ? "the original pipeline" : text;
  }

  void run(const std::vector<std::size_t>& jobs) {
    if (jobs.empty()) {
      return;
    }
    files_.expect_unchanged();
    const study::Work work = [this](const study::Job& job) {
      const Wanted& wanted = wanted_[job.index];
      study::PlannedConfig planned;
      planned.is_on_trial = true;
      planned.load = [&] {
        return host::load_config(
            plan_.request.pipeline,
            plan_.overrides(wanted.scenario, tuning_.evaluations[wanted.evaluation].assignments),
            plan_.config.registry);
      };
      return study::study_run(job, planned, plan_.request.limits);
    };
    const auto keep = [this](const std::vector<study::Ended>& all) {
      files_.expect_unchanged();
      for (const study::Ended& ended : all) {
        const Wanted& wanted = wanted_[ended.job];
        log_.add({wanted.evaluation, wanted.scenario}, parameters_of(wanted.evaluation),
                 scored(ended));
      }
      progress_.runs += all.size();
      tell_progress();
    };
    const study::WorkerPool::Finish finish = pool_.run(jobs, work, keep);
    if (finish == study::WorkerPool::Finish::interrupted) {
      throw Interrupted();
    }
  }

  ScoredRun scored(const study::Ended& ended) const {
    const study::RunOutcome outcome = study::outcome_of(ended, plan_.request.limits);
    if (outcome.outcome != study::Outcome::solved) {
      return {study::name(outcome.outcome), std::nullopt, outcome.message};
    }
    std::map<std::string, double> values(outcome.values.begin(), outcome.values.end());
    values.insert({{"solved", 1},
                   {"wall_time_s", ended.wall_s},
                   {"cpu_time_s", ended.cpu_s},
                   {"peak_memory_mb", ended.peak_memory_mb}});
    std::vector<double> named;
    for (const study::ClaimValue& wanted : plan_.objective.values) {
      const auto found = values.find(wanted.name);
      if (found == values.end()) {
        return {"no_value", std::nullopt, "the run has no value '" + wanted.name + "'"};
      }
      named.push_back(found->second);
    }
    const double value = study::in_12_digits(study::evaluate(plan_.objective.expression, named));
    if (!std::isfinite(value)) {
      return {"no_value", std::nullopt, "the metric is not finite"};
    }
    return {study::name(outcome.outcome), value, ""};
  }

  /// Throws Error for a metric that no run has, with which every evaluation would fail.
  void expect_values() const {
    for (std::size_t s = 0; s < plan_.tuned_on; ++s) {
      const ScoredRun& run = tuning_.as_it_is().runs[s];
      if (run.outcome == "no_value") {
        throw Error("--metric: in '" + plan_.scenarios[s].name +
                    "' the original pipeline solves the problem, but " + run.message);
      }
    }
  }

  void tell_progress() {
    progress_.elapsed_s = std::chrono::duration<double>(Clock::now() - began_).count();
    const std::size_t all =
        (progress_.expected + 1) * plan_.tuned_on + 2 * (plan_.scenarios.size() - plan_.tuned_on);
    progress_.runs_left = all - std::min(all, log_.size());
    if (options_.progress) {
      options_.progress(progress_);
    }
  }

  const TunePlan& plan_;
  const TuneOptions& options_;
  const Clock::time_point began_ = Clock::now();
  study::WorkFolder folder_;  ///< locked before the log is read
  TuneLog log_;
  const FileWatch files_;
  study::WorkerPool pool_;
  Tuning tuning_;
  TuneProgress progress_;
  std::vector<Wanted> wanted_;
  std::map<std::string, std::size_t> first_with_;  ///< evaluations by their parameters
};
}  // namespace

Tuning run_tuning(const TunePlan& plan, const TuneOptions& options) {
  if (const fs::file_status status = host::status_of(options.out);
      fs::exists(status) && !fs::is_directory(status)) {
    throw Error("--out: '" + options.out.string() + "' is not a folder");
  }
  return TuningRun(plan, options)();
}
}  // namespace altiplan::tune
