// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/words.hpp"
#include "progress.hpp"
#include "study/claims/claims.hpp"
#include "study/model/study_data.hpp"
#include "study/plan/undecidable.hpp"
#include "study/report/analysis.hpp"
#include "study/run/study_run.hpp"
#include "study/store/load_study.hpp"
#include "study/store/place.hpp"
#include "table.hpp"

namespace altiplan::cli {
namespace {

constexpr std::size_t kDryPairs = 1000;  // checked by a dry run, which should not take long

struct StudyArguments {
  std::string study;
  std::string store;
  study::StudySelection selection;
  study::StudyOptions options;

  host::Overrides overrides;  ///< only the plugin path is used
  bool dry_run = false;
  bool gate = false;
  bool resume = false;  ///< no effect: the default
};

std::string line_of(const study::StudyProgress& progress) {
  const std::size_t ended = progress.before + progress.done;
  std::string line = std::to_string(ended) + " of " + std::to_string(progress.runs) + " runs";
  if (progress.done > 0 && ended < progress.runs) {
    line += ", " +
            duration(progress.elapsed_s / double(progress.done) * double(progress.runs - ended)) +
            " left";
  }
  for (const auto& [outcome, number] : progress.outcomes) {
    line += outcome == "solved" ? "" : ", " + std::to_string(number) + " " + outcome;
  }
  return line;
}

/// "2 no_route, 1 timed_out"
std::string numbers_of(const std::map<std::string, std::size_t>& outcomes) {
  std::string text;
  for (const auto& [outcome, number] : outcomes) {
    text += (text.empty() ? "" : ", ") + std::to_string(number) + " " + outcome;
  }
  return text;
}

void print_outcomes(const study::StudyData& data) {
  Table table({{"pipeline", false, 8},
               {"runs", true, 8},
               {"solved", true, 8},
               {"plan_ms", true, 12},
               {"not solved"}});
  const std::size_t time = data.column("plan_time_s");
  std::string absent;
  for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
    std::size_t runs = 0;
    std::size_t solved = 0;
    std::map<std::string, std::size_t> others;
    std::vector<double> times;
    for (const study::RunRow& row : data.rows) {
      if (row.pipeline == p) {
        ++runs;
        if (!row.solved()) {
          ++others[row.outcome];
          continue;
        }
        ++solved;
        if (time < data.columns.size() && !std::isnan(row.values[time])) {
          times.push_back(1000 * row.values[time]);
        }
      }
    }
    if (runs == 0) {
      absent += (absent.empty() ? "" : ", ") + data.pipelines[p].name;
      continue;
    }
    const std::optional<double> median =
        times.empty() ? std::nullopt : std::optional(study::median(times));
    const Color color = solved == runs ? Color::good : solved == 0 ? Color::bad : Color::open;
    table.add({data.pipelines[p].name, std::to_string(runs),
               Table::Cell(std::to_string(solved), color), fixed(median, 1), numbers_of(others)});
  }
  table.print(stdout);
  if (!absent.empty()) {
    std::printf("  no runs: %s\n", absent.c_str());
  }
}

/// True if every claim holds.
bool print_claims(const study::StudyData& data) {
  bool all_hold = true;
  const std::vector<study::JudgedClaim> all = study::judge_claims(data);
  for (const study::JudgedClaim& judged : all) {
    all_hold = all_hold && judged.verdict == study::Verdict::holds;
    if (judged.lacks_runs) {
      continue;
    }
    const std::size_t verdict = judged.words.find(':');  // "Holds: …"
    const Color color = color_of(std::string(name_of(judged.verdict)));
    std::printf("  claim %s: %s%s\n", judged.claim.id.c_str(),
                painted(stdout, color, judged.words.substr(0, verdict)).c_str(),
                judged.words.substr(verdict).c_str());
  }
  for (const std::string& sentence : study::common_reasons(all)) {
    std::printf("  %s\n", sentence.c_str());
  }
  if (const std::string sentence = study::multiplicity(all); !sentence.empty()) {
    std::printf("  %s\n", sentence.c_str());
  }
  return all_hold;
}

int dry_run(const StudyArguments& arguments, const study::StudyPlan& plan) {
  const study::StudyEstimate estimate =
      busy("trying runs", [&] { return study::estimate_study(plan, arguments.options); });
  std::printf("%zu pipeline%s x %zu scenario%s x %d repetition%s = %zu runs\n",
              plan.pipelines.size(), plan.pipelines.size() == 1 ? "" : "s", plan.scenarios.size(),
              plan.scenarios.size() == 1 ? "" : "s", plan.file.repetitions,
              plan.file.repetitions == 1 ? "" : "s", plan.planned);
  std::printf("  selected %zu, stored %zu, to do %zu\n", plan.runs.size(), estimate.stored,
              estimate.left);
  if (plan.unchecked > 0) {
    std::printf("  not checked: the files of %zu runs\n", plan.unchecked);
  }
  if (estimate.left > 0) {
    const std::string from =
        host::counted(estimate.measured, estimate.is_probed ? "trial run" : "stored run");
    std::printf("  about %s with --jobs %d (%s per run, from %s)\n",
                duration(estimate.total_s).c_str(), arguments.options.jobs,
                duration(estimate.run_s).c_str(), from.c_str());
  }
  for (const std::string& sentence : study::undecidable_claims(plan, arguments.selection)) {
    std::printf("  %s\n", sentence.c_str());
  }
  return kDone;
}

int study(StudyArguments arguments) {
  if (arguments.store.empty()) {  // a dry run still needs a temporary store
    const std::string name = "altiplan-study-" + std::to_string(getpid());
    arguments.options.store = std::filesystem::temp_directory_path() / name;
  } else {
    arguments.options.store = arguments.store;
    expect_store_writable(arguments.store, "--out");
  }
  if (arguments.dry_run && (arguments.options.fresh || !host::is_there(arguments.options.store))) {
    arguments.selection.max_checked = kDryPairs;  // keys of runs matter to a store alone
  }
  const study::StudyPlan plan = busy("reading the study", [&] {
    return study::load_study(arguments.study, arguments.selection, arguments.options.plugin_path);
  });
  if (plan.runs.empty()) {
    throw Error("no run is left: --filter, --sample and --shard select none of the " +
                std::to_string(plan.planned) + " runs");
  }
  if (arguments.dry_run) {
    return dry_run(arguments, plan);
  }
  ProgressLine line;
  arguments.options.progress = [&](const study::StudyProgress& progress) {
    line.show(line_of(progress));
  };
  arguments.options.say = [&](const std::string& text) {
    line.clear();
    warn(text);
  };
  const study::StudyEnd end = study::run_study(plan, arguments.options);
  line.clear();
  const study::StudyProgress& progress = end.progress;
  std::printf("%s: %zu runs stored, %zu of them new, in %s\n", arguments.store.c_str(),
              progress.before + progress.done, progress.done, duration(progress.elapsed_s).c_str());
  if (end.is_interrupted) {
    std::printf("  interrupted with %zu runs left: repeat the command to continue\n",
                progress.runs - progress.before - progress.done);
    return kInterrupted;
  }
  const study::StudyData data = study::load_study_data({arguments.store});
  print_outcomes(data);
  const bool all_hold = print_claims(study::report::in_order(data, true));
  return arguments.gate && !all_hold ? kNoRoute : kDone;
}

/// "0.05" or "5%"
std::string read_share(const std::string& text, std::optional<double>& share) {
  try {
    std::size_t end = 0;
    double value = std::stod(text, &end);
    if (text.substr(end) == "%") {
      value /= 100;
    } else if (end != text.size()) {
      value = -1;
    }
    if (value > 0 && value <= 1) {
      share = value;
      return "";
    }
  } catch (const std::exception&) {
    // reported below
  }
  return "expected a fraction above 0 and at most 1, or a percentage, found '" + text + "'";
}

/// "2/5"
std::string read_shard(const std::string& text, study::StudySelection& selection) {
  int shard = 0;
  int shards = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard);
  const auto second = first.ec == std::errc() && first.ptr != end && *first.ptr == '/'
                          ? std::from_chars(first.ptr + 1, end, shards)
                          : std::from_chars_result{first.ptr, std::errc::invalid_argument};
  if (second.ec != std::errc() || second.ptr != end || shard < 1 || shard > shards ||
      shards > 100000) {
    return "expected I/N with 1 <= I <= N <= 100000, found '" + text + "'";
  }
  selection.shard = shard;
  selection.shards = shards;
  return "";
}

/// Options that select runs of the study.
void add_selection(App& command, study::StudySelection& selection) {
  command.add_option_function(
      "--shard I/N", [&](const std::string& text) { return read_shard(text, selection); },
      "run only part I of N, to split a study across machines");
  command.add_option_function(
      "--sample P", [&](const std::string& text) { return read_share(text, selection.sample); },
      "run only this fraction of the scenarios and repetitions, with every pipeline: 0.05 or 5%");
  command.add_option("--filter E", selection.filter,
                     "run only runs whose name 'PIPELINE SCENARIO #REPETITION' matches this "
                     "regular expression");
}
}  // namespace

void add_study(App& app, Action& action, const std::string& command_line) {
  const auto prepare = [](StudyArguments& arguments) {
    if (arguments.store.empty() && !arguments.dry_run) {
      throw UsageError{"--out is required"};
    }
    arguments.options.plugin_path = arguments.overrides.plugin_path;
  };
  auto [command, arguments] = add_command<StudyArguments>(
      app, action, "study",
      "run pipelines x scenarios x repetitions, each run in its own process; resumable", study,
      prepare);
  arguments.options.command = command_line;
  command.add_option("study", arguments.study, "study file (YAML)")->required();
  command.add_option("-o,--out DB", arguments.store,
                     "results database (SQLite); optional only with --dry-run");
  command.add_option("--jobs", arguments.options.jobs, "number of parallel runs (default 1)")
      ->check(Check::between(1, 1024));
  command
      .add_option("--reuse", arguments.options.reuse,
                  "runs per worker process, recorded in the results (default 1)")
      ->check(Check::between(1, 1000000));
  add_selection(command, arguments.selection);
  command.add_flag("--traces", arguments.options.traces, "store search traces");
  auto* fresh =
      command.add_flag("--fresh", arguments.options.fresh, "delete the stored runs first");
  command.add_flag("--resume", arguments.resume, "run only runs not stored yet (default)")
      ->excludes(fresh);
  command.add_flag("--dry-run", arguments.dry_run,
                   "only print the number of runs and the estimated time");
  command.add_flag("--gate", arguments.gate, "exit with code 1 unless every claim holds");
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan study configs/studies/quick.yaml --out quick.db --jobs 2");
}
}  // namespace altiplan::cli
