// SPDX-License-Identifier: Apache-2.0
#include "report.hpp"

#include <algorithm>
#include <charconv>
#include <future>

namespace altiplan::conformance {

void Report::add(const std::string& contract, std::string message) {
  constexpr std::ptrdiff_t kMax = 3;
  const auto same = [&](const Finding& finding) { return finding.contract == contract; };
  if (std::count_if(findings_.begin(), findings_.end(), same) < kMax) {
    findings_.push_back({contract, std::move(message)});
  }
}

Case make_case(std::string name, std::string thrown, std::function<void(Report&)> body) {
  auto run = [thrown = std::move(thrown), body = std::move(body)] {
    Report report;
    try {
      body(report);
    } catch (const std::exception& error) {
      report.add(thrown, std::string("the plugin let an exception escape: ") + error.what());
    } catch (...) {
      report.add(thrown, "the plugin threw something that is not a std::exception");
    }
    return report.take();
  };
  return {std::move(name), std::move(run)};
}

std::string text(double value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string text(const Vec3& p) {
  return "(" + text(p.x()) + ", " + text(p.y()) + ", " + text(p.z()) + ")";
}

std::string text(const Route& route) {
  std::string all = "[";
  for (const Vec3& p : route) {
    all += (all.size() > 1 ? ", " : "") + text(p);
  }
  return all + "]";
}

bool equal(const PlanResult& a, const PlanResult& b) {
  const auto same = [](const Counter& x, const Counter& y) {
    return x.name == y.name && x.value == y.value;
  };
  return a.status == b.status && a.message == b.message && a.route == b.route &&
         a.budget_hit == b.budget_hit && a.proved == b.proved &&
         std::equal(a.counters.begin(), a.counters.end(), b.counters.begin(), b.counters.end(),
                    same);
}

std::string text(const PlanResult& result) {
  std::string all = std::string(name(result.status)) + " (" + result.message + ")";
  for (const Counter& one : result.counters) {
    all += ", " + one.name + " " + std::to_string(one.value);
  }
  return all + ", " + std::to_string(result.route.size()) + " points, " +
         text(length(result.route)) + " m";
}

std::int64_t counter(const Counters& counters, std::string_view name) {
  const auto found = std::find_if(counters.begin(), counters.end(),
                                  [&](const Counter& one) { return one.name == name; });
  return found == counters.end() ? -1 : found->value;
}

void in_two_threads(const std::function<void()>& one, const std::function<void()>& other) {
  std::future<void> beside = std::async(std::launch::async, one);
  other();
  beside.get();
}
}  // namespace altiplan::conformance
