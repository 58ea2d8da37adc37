// SPDX-License-Identifier: Apache-2.0
#include "runner.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "altiplan/error.hpp"
#include "host/base/json.hpp"
#include "test_process.hpp"

namespace altiplan::cli {
namespace {

constexpr const char* kSame = "Process: equal requests give equal answers in two processes";

/// The first difference between the answers of two processes; "" if they are equal.
std::string difference(const std::string& one, const std::string& other) {
  std::istringstream a(one);
  std::istringstream b(other);
  std::string in_one;
  std::string in_other;
  for (int line = 1; a || b; ++line) {
    std::getline(a, in_one);
    std::getline(b, in_other);
    if (bool(a) != bool(b) || in_one != in_other) {
      return "answer " + std::to_string(line) + ": '" + in_one.substr(0, 300) + "' in one, '" +
             in_other.substr(0, 300) + "' in the other";
    }
  }
  return "";
}

/// Starts the tests of one run and collects their verdicts.
class Runner {
 public:
  Runner(const std::vector<PluginTest>& tests, const RunnerOptions& options,
         const std::function<void(const Verdict&)>& done)
      : tests_(tests),
        options_(options),
        done_(done),
        verdicts_(tests.size()),
        first_answers_(tests.size()) {}

  std::vector<Verdict> run() {
    run_those(false, options_.jobs);
    run_those(true, 1);
    std::vector<Verdict> all;
    for (std::optional<Verdict>& verdict : verdicts_) {
      if (verdict) {
        all.push_back(std::move(*verdict));
      }
    }
    return all;
  }

 private:
  void run_those(bool alone, std::size_t jobs) {
    std::vector<std::size_t> waiting;
    for (std::size_t i = tests_.size(); i-- > 0;) {
      if (tests_[i].alone == alone) {
        waiting.push_back(i);
      }
    }
    std::vector<std::unique_ptr<TestProcess>> children;
    while ((!waiting.empty() || !children.empty()) && !options_.stop.stop_requested()) {
      for (; !hung_.empty() && !waiting.empty(); waiting.pop_back()) {
        Verdict skipped;
        skipped.test = tests_[waiting.back()].name;
        skipped.skipped = "not run after " + hung_ + ", which did not end";
        done_(skipped);
        verdicts_[waiting.back()] = std::move(skipped);
      }
      while (!waiting.empty() && children.size() < jobs) {
        try {
          start(children, waiting.back(), false);
        } catch (const Error&) {
          if (children.empty()) {
            throw;
          }
          break;  // retried when a running test has ended
        }
        waiting.pop_back();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (std::optional<Verdict> verdict = children[i]->look(options_)) {
          const std::unique_ptr<TestProcess> ended = std::move(children[i]);
          children.erase(children.begin() + std::ptrdiff_t(i--));
          take(children, *ended, std::move(*verdict));
        }
      }
    }
  }

  void start(std::vector<std::unique_ptr<TestProcess>>& children, std::size_t index, bool again) {
    const std::uint64_t mark = std::uint64_t(::getpid()) << 24 | ++started_;
    children.push_back(std::make_unique<TestProcess>(tests_[index], index, mark, again, options_));
  }

  void take(std::vector<std::unique_ptr<TestProcess>>& children, const TestProcess& ended,
            Verdict verdict) {
    const std::size_t index = ended.index();
    verdict.test = tests_[index].name;
    if (tests_[index].in_two_processes && !verdict.failed()) {
      if (!ended.again()) {
        first_answers_[index] = ended.answers();
        start(children, index, true);
        return;
      }
      const std::string parted = difference(first_answers_[index], ended.answers());
      if (!parted.empty()) {
        verdict.findings.push_back({kSame, parted});
        verdict.seen_from_outside = true;
      }
    }
    hung_ = verdict.hung && hung_.empty() ? verdict.test : hung_;
    done_(verdict);
    verdicts_[index] = std::move(verdict);
  }

  const std::vector<PluginTest>& tests_;
  const RunnerOptions& options_;
  const std::function<void(const Verdict&)>& done_;
  std::vector<std::optional<Verdict>> verdicts_;
  std::vector<std::string> first_answers_;
  std::uint64_t started_ = 0;
  std::string hung_;  ///< the first test that did not end
};
}  // namespace

std::string outcome_text(const Outcome& outcome) {
  nlohmann::json findings = nlohmann::json::array();
  for (const conformance::Finding& finding : outcome.findings) {
    findings.push_back({finding.contract, finding.message});
  }
  return nlohmann::json{{"findings", findings},
                        {"skipped", outcome.skipped},
                        {"misfit", outcome.misfit},
                        {"answers", outcome.answers}}
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Outcome outcome_of(const std::string& text) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    Outcome outcome;
    for (const nlohmann::json& finding : json.at("findings")) {
      outcome.findings.push_back({finding.at(0), finding.at(1)});
    }
    outcome.skipped = json.at("skipped");
    outcome.misfit = json.at("misfit");
    outcome.answers = json.at("answers");
    return outcome;
  } catch (const nlohmann::json::exception&) {
    throw Error("overwrote its result");
  }
}

std::vector<Verdict> run_apart(const std::vector<PluginTest>& tests, const RunnerOptions& options,
                               const std::function<void(const Verdict&)>& done) {
  // A parent may have left it ignored, in which case wait() does not report children.
  ::signal(SIGCHLD, SIG_DFL);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  return Runner(tests, options, done).run();
}
}  // namespace altiplan::cli
