// SPDX-License-Identifier: Apache-2.0
#include "verdicts.hpp"

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "altiplan_build.hpp"
#include "commands.hpp"
#include "host/base/utf8.hpp"

namespace altiplan::cli {
namespace {

struct Count {
  std::size_t passed = 0;
  std::size_t failed = 0;
  std::size_t skipped = 0;
};

Count count(const std::vector<Verdict>& verdicts) {
  Count count;
  for (const Verdict& verdict : verdicts) {
    ++(verdict.failed() ? count.failed : !verdict.skipped.empty() ? count.skipped : count.passed);
  }
  return count;
}

/// The text with each line indented by that many blanks.
std::string indented(const std::string& text, std::size_t by) {
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    all += std::string(by, ' ') + line + "\n";
  }
  return all;
}

/// A plugin's output made printable: it may contain any bytes.
std::string text_of(const std::string& output) { return host::printable(output, true); }

std::string findings_text(const CheckedLibrary& library, const Verdict& verdict) {
  std::string all;
  for (const conformance::Finding& finding : verdict.findings) {
    all += "  " + text_of(finding.contract) + "\n" + indented(text_of(finding.message), 4);
  }
  if (!verdict.output.empty()) {
    all += "  output:\n" + indented(text_of(verdict.output), 4);
  }
  return all + "  to reproduce: " + reproduce(library, verdict) + "\n";
}

/// "planner/astar/2" of "planner/astar/2/limits_are_honoured".
std::string suite_of(const std::string& test) { return test.substr(0, test.rfind('/')); }
}  // namespace

std::string reproduce(const CheckedLibrary& library, const Verdict& verdict) {
  return library.command + " --only '^" + verdict.test + "$'" +
         (verdict.seen_from_outside ? "" : " --here");
}

std::string verdict_text(const CheckedLibrary& library, const Verdict& verdict) {
  const std::string time = " (" + fixed(verdict.time_s, 1) + " s)\n";
  if (verdict.failed()) {
    return "FAILED  " + verdict.test + time + findings_text(library, verdict);
  }
  if (!verdict.skipped.empty()) {
    return "skipped " + verdict.test + ": " + text_of(verdict.skipped) + "\n";
  }
  return "passed  " + verdict.test + time;
}

std::string summary_text(const CheckedLibrary& library, const std::vector<Verdict>& verdicts) {
  const Count all = count(verdicts);
  double peak = 0;
  for (const Verdict& verdict : verdicts) {
    peak = std::max(peak, verdict.peak_memory_mb);
  }
  return text_of(library.file) + ": " + std::to_string(all.passed) + " passed, " +
         std::to_string(all.failed) + " failed" +
         (all.skipped > 0 ? ", " + std::to_string(all.skipped) + " skipped" : "") + " in " +
         fixed(library.time_s, 1) + " s; peak memory " + fixed(peak, 0) + " MB\n";
}

nlohmann::ordered_json verdicts_json(const CheckedLibrary& library,
                                     const std::vector<Verdict>& verdicts) {
  const Count all = count(verdicts);
  nlohmann::ordered_json tests = nlohmann::ordered_json::array();
  for (const Verdict& verdict : verdicts) {
    nlohmann::ordered_json findings = nlohmann::ordered_json::array();
    for (const conformance::Finding& finding : verdict.findings) {
      findings.push_back({{"contract", finding.contract}, {"message", finding.message}});
    }
    tests.push_back({{"name", verdict.test},
                     {"status", verdict.failed()           ? "failed"
                                : !verdict.skipped.empty() ? "skipped"
                                                           : "passed"},
                     {"findings", findings},
                     {"skipped", verdict.skipped.empty() ? nlohmann::ordered_json()
                                                         : nlohmann::ordered_json(verdict.skipped)},
                     {"said", verdict.output},
                     {"again", reproduce(library, verdict)},
                     {"time_s", verdict.time_s},
                     {"peak_memory_mb", verdict.peak_memory_mb}});
  }
  return {{"altiplan", 1},          {"version", ALTIPLAN_VERSION}, {"library", library.file},
          {"build", library.build}, {"seed", library.seed},        {"passed", all.passed},
          {"failed", all.failed},   {"skipped", all.skipped},      {"time_s", library.time_s},
          {"tests", tests}};
}

std::string verdicts_junit(const CheckedLibrary& library, const std::vector<Verdict>& verdicts) {
  std::map<std::string, std::vector<Verdict>> suites;
  for (const Verdict& verdict : verdicts) {
    suites[suite_of(verdict.test)].push_back(verdict);
  }
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("testsuites");
  root.append_attribute("name") = text_of(library.file).c_str();
  for (const auto& [name, tests] : suites) {
    const Count all = count(tests);
    pugi::xml_node suite = root.append_child("testsuite");
    suite.append_attribute("name") = name.c_str();
    suite.append_attribute("tests") = tests.size();
    suite.append_attribute("failures") = all.failed;
    suite.append_attribute("errors") = 0;
    suite.append_attribute("skipped") = all.skipped;
    for (const Verdict& verdict : tests) {
      pugi::xml_node test = suite.append_child("testcase");
      test.append_attribute("classname") = name.c_str();
      test.append_attribute("name") = verdict.test.substr(name.size() + 1).c_str();
      test.append_attribute("time") = fixed(verdict.time_s, 3).c_str();
      if (verdict.failed()) {
        pugi::xml_node failure = test.append_child("failure");
        failure.append_attribute("message") = text_of(verdict.findings.front().contract).c_str();
        failure.text() = text_of(findings_text(library, verdict)).c_str();
      } else if (!verdict.skipped.empty()) {
        test.append_child("skipped").append_attribute("message") = text_of(verdict.skipped).c_str();
      }
    }
  }
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}
}  // namespace altiplan::cli
