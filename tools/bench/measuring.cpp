// SPDX-License-Identifier: Apache-2.0
#include "measuring.hpp"

#include <malloc.h>

#include <algorithm>
#include <ctime>

#include "altiplan/check.hpp"
#include "altiplan/route.hpp"
#include "host/config/config.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::bench {
namespace {

double now_s(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}
}  // namespace

double wall_s() { return now_s(CLOCK_MONOTONIC); }
double thread_s() { return now_s(CLOCK_THREAD_CPUTIME_ID); }
double process_s() { return now_s(CLOCK_PROCESS_CPUTIME_ID); }

std::size_t allocated() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0;
  }
  const std::size_t n = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n), values.end());
  return values[n];
}

Chosen chosen(host::Registry& registry, const std::string& kind, const std::string& text) {
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::string yaml = space == text.size() ? "{}" : text.substr(space);
  return {host::plugin(registry, kind, text.substr(0, space)), host::parse_yaml(yaml, text)};
}

std::shared_ptr<const Planner> planner(host::Registry& registry, const std::string& text) {
  const Chosen of = chosen(registry, "planner", text);
  return of.entry.planner(&of.parameters);
}

std::unique_ptr<Environment> environment(host::Registry& registry, const std::string& text,
                                         Site site) {
  const Chosen of = chosen(registry, "environment", text);
  const World nothing;
  site.before = &nothing;
  return of.entry.environment(&of.parameters, site);
}

double counter(const PlanResult& result, std::string_view name) {
  for (const Counter& counter : result.counters) {
    if (counter.name == name) {
      return double(counter.value);
    }
  }
  return 0;
}

double judged_length(const PlanResult& result, const Request& request, const std::string& who) {
  if (result.status != PlanStatus::solved) {
    return kInfinity;
  }
  if (!check(result.route, request).ok()) {
    throw WrongAnswer(who + ": the judge rejects a route");
  }
  return length(result.route);
}

double solved_length(const PlanResult& result, const Request& request, const std::string& who) {
  if (result.status != PlanStatus::solved) {
    throw WrongAnswer(who + ": no route for a query: " + result.message);
  }
  return judged_length(result, request, who);
}
}  // namespace altiplan::bench
