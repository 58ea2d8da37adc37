// SPDX-License-Identifier: Apache-2.0
#include "study/run/study_worker.hpp"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <system_error>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/output_file.hpp"
#include "host/gate/route_returns.hpp"
#include "host/result/result_json.hpp"
#include "host/run/pipeline.hpp"
#include "study/workers/job_record.hpp"

namespace altiplan::study {
namespace {

// Exit codes of a worker that has left a partial result in Job::crash_report; a crashed one has
// also written the cause on the last line of its stderr.
constexpr int kCrashed = 81;
constexpr int kStuck = 82;

constexpr std::size_t kResultAtMost = std::size_t(256) << 20;

/// A payload is a line of JSON with the lengths of the following texts.
std::string payload_of(const RunOutcome& run) {
  const host::Json head = {{"outcome", name(run.outcome)},
                           {"message", run.message},
                           {"values", run.values},
                           {"result_bytes", run.result.size()},
                           {"trace_bytes", run.trace.size()}};
  return host::json_text(head) + "\n" + run.result + run.trace;
}

RunOutcome without_result(Outcome outcome, std::string why) {
  return {outcome, std::move(why), "", "", {}};
}

RunOutcome bad_output(std::string why) {
  return without_result(Outcome::bad_output, std::move(why));
}

struct PayloadHead {
  RunOutcome run;  ///< without result and trace
  std::size_t bytes = 0;
  std::size_t result_bytes = 0;
  std::size_t trace_bytes = 0;
};

/// nullopt if the payload is damaged.
std::optional<PayloadHead> head_of(const std::string& payload) {
  const std::size_t end = payload.find('\n');
  const host::Json json = host::json_or_discarded(payload.substr(0, end));
  PayloadHead head;
  try {
    const std::optional<Outcome> outcome =
        outcome_named(json.at("outcome").get_ref<const std::string&>());
    if (!outcome) {
      return std::nullopt;
    }
    head.run.outcome = *outcome;
    head.run.message = json.at("message");
    head.run.values = json.at("values");
    head.result_bytes = json.at("result_bytes");
    head.trace_bytes = json.at("trace_bytes");
  } catch (const host::Json::exception&) {
    return std::nullopt;
  }
  head.bytes = end + 1;
  return head;
}

RunOutcome outcome_of_payload(const std::string& payload) {
  const std::optional<PayloadHead> head = head_of(payload);
  if (!head) {
    return bad_output("the run's record is damaged");
  }
  if (head->result_bytes > kResultAtMost || head->trace_bytes > kResultAtMost) {
    return bad_output("its result or its trace is larger than 256 MB");
  }
  if (payload.size() - head->bytes != head->result_bytes + head->trace_bytes) {
    return bad_output("the run's record is damaged");
  }
  RunOutcome run = head->run;
  run.result = payload.substr(head->bytes, head->result_bytes);
  run.trace = payload.substr(head->bytes + head->result_bytes);
  if (!run.result.empty() && !host::Json::accept(run.result)) {
    return bad_output("its result is not JSON");
  }
  return run;
}

/// Completes a message with the end of the process, which the process cannot report itself.
std::string without_cause(std::string message) {
  if (const std::size_t at = message.find(host::ProcessGuard::CrashReport::kCause);
      at != message.npos) {
    message.resize(at);
  }
  while (message.ends_with(' ')) {
    message.pop_back();
  }
  return message;
}

host::ProcessGuard::CrashReport crash_report(const Job& job, const host::Config& config,
                                             const host::RunResult& result) {
  host::ProcessGuard::CrashReport words;
  words.for_user = std::string("\n") + host::ProcessGuard::CrashReport::kCause;
  words.result = host::file_text(host::result_json(config, result));
  words.file = job.crash_report;
  words.exit_code = kCrashed;
  return words;
}

/// A step that exceeded the study's time budget by more than the time to stop.
const host::StepResult* overtime(const host::RunResult& result, const StudyBudget& budget) {
  const auto late = std::find_if(result.steps.begin(), result.steps.end(), [&](const auto& step) {
    return budget.time_s && step.verb == host::Verb::plan &&
           step.status == host::RunStatus::solved && step.time_s > 1.1 * *budget.time_s + 0.1;
  });
  return late == result.steps.end() ? nullptr : &*late;
}

bool out_of_memory(const host::RunResult& result) {
  return result.status == host::RunStatus::failed && result.reason == Reason::out_of_memory;
}

RunOutcome outcome_of_result(const host::RunResult& result, const StudyBudget& budget) {
  RunOutcome run = without_result(outcome_of(result.status), result.message);
  if (out_of_memory(result)) {
    run.outcome = Outcome::out_of_memory;
  } else if (const host::StepResult* late = overtime(result, budget)) {
    run.outcome = Outcome::timed_out;
    run.message =
        late->id + ": '" + late->plugin + "' reports solved, but exceeded the study's time budget";
  }
  return run;
}

RunOutcome run_pipeline(const Job& job, const host::Config& config, const StudyBudget& budget,
                        bool trace) {
  host::RunOptions options;
  options.timeout_s = std::numeric_limits<double>::max();  // the pool's limits decide
  if (trace) {
    options.trace = job.scratch;
  }
  std::optional<host::ProcessGuard> process(std::in_place);
  options.process = &*process;
  options.judge_returns = host::judge_route_returns;
  options.on_call = [&](const host::RunResult& result) {
    job.note(without_cause(result.message));
    process->set_crash_report(crash_report(job, config, result));
  };
  options.on_stuck = [&](const host::RunResult& result) {
    try {
      host::write_file(job.crash_report, host::file_text(host::result_json(config, result)));
    } catch (const Error&) {  // the note names the step
    }
    ::_exit(kStuck);
  };
  host::RunResult result = run(config, options);
  process.reset();
  RunOutcome outcome = outcome_of_result(result, budget);
  if (trace) {
    result.trace.reset();  // it is not at the path in the result
    ReadText read = read_from(job.scratch, 0, kResultAtMost + 1);
    if (read.error != 0 && read.error != ENOENT) {
      throw host::MachineFault(host::unreadable(job.scratch, read.error));
    }
    outcome.trace = std::move(read.text);
    std::error_code error;
    std::filesystem::remove(job.scratch, error);
  }
  const host::Json json = host::result_json(config, result);
  outcome.values = values_of(json);
  outcome.result = host::file_text(json);
  return outcome;
}

/// Sets `files` to the files of the run.
RunOutcome run_guarded(const Job& job, const PlannedConfig& planned, const StudyBudget& budget,
                       bool trace, std::vector<std::filesystem::path>& files) {
  try {
    job.note("reading the files of the run");
    const host::Config config = planned.load();
    files = config.files;
    const RunOutcome changed =
        without_result(Outcome::changed, "its files have changed since the runs were planned");
    if (!planned.is_current(config)) {
      return changed;
    }
    RunOutcome run = run_pipeline(job, config, budget, trace);
    return planned.is_current(config) ? run : changed;  // files of plugins may have changed since
  } catch (const std::system_error& error) {
    const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
    return without_result(Outcome::not_done,
                          "the system refuses a run " +
                              std::string(no_thread ? "a thread: " : "a resource: ") +
                              error.what());
  } catch (const host::MachineFault& fault) {
    return without_result(Outcome::not_done, fault.what());
  } catch (const PluginError& error) {
    return without_result(Outcome::refused, error.what());
  } catch (const ConfigError& error) {
    std::string all;
    for (const Problem& problem : error.problems()) {
      all += (all.empty() ? "" : "; ") + problem.text();
    }
    if (planned.is_on_trial) {  // not final if a file of it cannot be read
      return without_result(Outcome::bad_parameters, all);
    }
    // All files were checked when the study began: now one cannot be read.
    return without_result(Outcome::not_done, all + " (unlike when the runs were planned)");
  } catch (const std::bad_alloc&) {
    return without_result(Outcome::out_of_memory, "out of memory");
  } catch (const std::exception& error) {
    return without_result(Outcome::failed, error.what());
  }
}

/// True for a failure that only the plugin explains, unless the machine failed.
bool is_unexplained(Outcome outcome) {
  return outcome == Outcome::failed || outcome == Outcome::crashed ||
         outcome == Outcome::out_of_memory || outcome == Outcome::bad_output ||
         outcome == Outcome::refused || outcome == Outcome::bad_parameters;
}

/// "SIGSEGV"
std::string signal_name(int number) {
  const char* name = ::sigabbrev_np(number);
  return name != nullptr ? "SIG" + std::string(name) : "signal " + std::to_string(number);
}

/// A plugin's text as UTF-8, with U+FFFD for invalid bytes.
std::string in_utf8(const std::string& text) {
  return host::parse_json(host::json_text(host::Json(text)));
}

/// The message with the end of the output on stdout and stderr, in one line.
std::string with_output(const std::string& message, const std::string& output) {
  constexpr std::size_t kAtMost = 300;
  std::string line;
  for (const char c : output.substr(output.size() - std::min(output.size(), kAtMost))) {
    const bool blank = c >= 0 && c <= ' ';
    if (!blank) {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  if (line.ends_with(' ')) {
    line.pop_back();
  }
  return line.empty() ? message : message + "; last output: " + line;
}

/// The end of a process that was not ended from outside.
std::string cause_of(const Ended& ended, std::string& output) {
  if (ended.how == Ending::killed) {
    return "was killed by " + signal_name(ended.signal);
  }
  if (const std::size_t line = output.rfind('\n');
      ended.exit_code == kCrashed && line != std::string::npos) {
    const std::string cause = output.substr(line + 1);
    output.resize(line);
    return cause;
  }
  return "ended the process with exit code " + std::to_string(ended.exit_code);
}

RunOutcome crashed(const Ended& ended) {
  std::string output = ended.output;
  RunOutcome run = without_result(Outcome::crashed, ended.note + " " + cause_of(ended, output));
  const host::Json result = host::json_or_discarded(ended.crash_report);
  if (ended.how == Ending::exited && result.is_object() && result.contains("message")) {
    run.outcome = ended.exit_code == kStuck ? Outcome::failed : Outcome::crashed;
    run.message = result["message"].get<std::string>();
    run.result = ended.crash_report;
    run.values = values_of(result);
  }
  run.message = with_output(run.message, output);
  return run;
}

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}
}  // namespace

JobLimits job_limits(const StudyBudget& budget) {
  JobLimits limits;
  limits.wall_s = budget.wall_s;
  limits.cpu_s = budget.cpu_s;
  limits.memory_mb = budget.memory_mb;
  return limits;
}

std::string study_run(const Job& job, const PlannedConfig& planned, const StudyBudget& budget,
                      bool trace) {
  std::vector<std::filesystem::path> files;
  RunOutcome run = run_guarded(job, planned, budget, trace, files);
  if (is_unexplained(run.outcome) || run.outcome == Outcome::not_done ||
      run.outcome == Outcome::changed) {
    job.retire();
    ::close_range(3, ~0U, 0);  // descriptors that a plugin has left open
    if (const std::string why = host::first_unreadable(files); !why.empty()) {
      run = without_result(Outcome::not_done, why);
    }
  }
  return payload_of(run);
}

namespace {

RunOutcome outcome_as_reported(const Ended& ended, const StudyBudget& budget) {
  const JobLimits limits = job_limits(budget);
  const auto stopped = [&](Outcome outcome, const std::string& why) {
    return without_result(outcome, ended.note + " " + why);
  };
  switch (ended.how) {
    case Ending::done: {
      RunOutcome run = outcome_of_payload(ended.payload);
      if (ended.left_behind > 0) {
        run.outcome = Outcome::failed;
        run.message = "a plugin left processes running, which were killed; " + run.message;
      }
      return run;
    }
    case Ending::threw:
      return without_result(Outcome::failed, ended.payload);
    case Ending::exited:
    case Ending::killed:
      return crashed(ended);
    case Ending::garbled:
      return bad_output("the run's record is damaged");
    case Ending::too_large:
      return bad_output(ended.note + " wrote a file, or gave a result, of more than " +
                        number(limits.file_mb) + " MB");
    case Ending::wall_limit:
      return stopped(Outcome::timed_out, "did not end within " + number(limits.wall_s) + " s");
    case Ending::cpu_limit:
      return stopped(Outcome::timed_out,
                     "used more than " + number(*limits.cpu_s) + " s of CPU time");
    case Ending::memory_limit:
      return stopped(Outcome::out_of_memory,
                     "used more than " + number(*limits.memory_mb) + " MB of memory");
    case Ending::out_of_memory:
      return stopped(Outcome::out_of_memory, "was killed by the kernel for lack of memory");
    case Ending::process_limit:
      return stopped(Outcome::failed,
                     "had more than " + std::to_string(limits.processes) + " processes");
  }
  return {};
}
}  // namespace

Appraisal appraisal_of(const Ended& ended, const StudyBudget& budget, const std::string& name) {
  switch (ended.how) {
    case Ending::too_large:
    case Ending::wall_limit:
    case Ending::cpu_limit:
    case Ending::memory_limit:
    case Ending::process_limit:
      return {};
    default:
      break;
  }
  const std::optional<PayloadHead> head =
      ended.how == Ending::done ? head_of(ended.payload) : std::nullopt;
  const RunOutcome run = head ? head->run : outcome_of(ended, budget);
  if (run.outcome == Outcome::not_done) {
    return {Appraisal::fault, in_utf8(run.message)};
  }
  if (run.outcome == Outcome::changed) {
    return {Appraisal::hopeless, name + ": " + run.message};
  }
  if (is_unexplained(run.outcome) && ended.left_behind == 0) {
    return {Appraisal::doubtful, study::name(run.outcome) + (": " + run.message)};
  }
  return {};
}

RunOutcome outcome_of(const Ended& ended, const StudyBudget& budget) {
  RunOutcome run = outcome_as_reported(ended, budget);
  run.message = in_utf8(run.message);
  return run;
}
}  // namespace altiplan::study
