// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/conformance.hpp"

namespace altiplan::conformance {

/// Collects the findings of one case.
class Report {
 public:
  /// Only the first few findings of each contract are kept: one violation usually occurs
  /// everywhere.
  void add(const std::string& contract, std::string message);
  /// Adds the finding unless the contract is kept; `message` is called only then.
  template <class Message>
  bool expect(bool kept, const std::string& contract, const Message& message) {
    if (!kept) {
      add(contract, message());
    }
    return kept;
  }
  std::vector<Finding> take() { return std::move(findings_); }

 private:
  std::vector<Finding> findings_;
};

/// A case whose body reports; an exception that escapes it becomes a finding of `thrown`, the
/// contract that forbids it.
Case make_case(std::string name, std::string thrown, std::function<void(Report&)> body);

/// Names and bodies of cases on a bench.
template <class Bench>
using Bodies = std::initializer_list<std::pair<const char*, void (*)(const Bench&, Report&)>>;

/// Such cases, of one contract that forbids exceptions.
template <class Bench>
Cases cases_on(const Bench& bench, const char* thrown, Bodies<Bench> bodies) {
  Cases cases;
  for (const auto& [name, body] : bodies) {
    cases.push_back(
        make_case(name, thrown, [bench, body = body](Report& report) { body(bench, report); }));
  }
  return cases;
}

/// With enough digits to reproduce the number.
std::string text(double value);
std::string text(const Vec3& p);
std::string text(const Route& route);

bool equal(const PlanResult& a, const PlanResult& b);
/// A result in one line: status, counters, message.
std::string text(const PlanResult& result);
/// The value of a counter; -1 where there is none.
std::int64_t counter(const Counters& counters, std::string_view name);

/// Runs both at the same time; rethrows an exception from either.
void in_two_threads(const std::function<void()>& one, const std::function<void()>& other);
}  // namespace altiplan::conformance
