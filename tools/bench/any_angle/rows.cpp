// SPDX-License-Identifier: Apache-2.0
#include "rows.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/route.hpp"
#include "clock.hpp"
#include "host/config/config.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::bench {
namespace {

double resident() {
  std::ifstream statm("/proc/self/statm");
  double size = 0;
  double pages = 0;
  statm >> size >> pages;
  return pages * double(sysconf(_SC_PAGESIZE));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0;
  }
  const std::size_t n = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n), values.end());
  return values[n];
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}
}  // namespace

Row::Row(host::Registry& registry, const std::string& text) : name_(text) {
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::string yaml = text.substr(space);
  const Value parameters = host::parse_yaml(yaml.empty() ? "{}" : yaml, text);
  planner_ = host::plugin(registry, "planner", text.substr(0, space)).planner(&parameters);
}

Row::Plan Row::plan(const Cells& cells, const Way& way) {
  const Request request = cells.request(way);
  const double held = resident();
  const double began = thread_ms();
  const PlanResult result = planner_->plan(request);
  Plan plan{thread_ms() - began, kInfinity, 0};
  resident_ += resident() - held;
  for (const Counter& counter : result.counters) {
    plan.expanded += counter.name == "expanded" ? double(counter.value) : 0;
  }
  if (result.status == Status::solved) {
    if (!check(result.route, request).ok()) {
      throw Error(name_ + ": a route that the judge refuses");
    }
    plan.length = length(result.route) / cells.spec().cell.x();
  }
  return plan;
}

void Row::add(const std::vector<Plan>& passes) {
  std::vector<double> ms;
  for (const Plan& plan : passes) {
    ms.push_back(plan.ms);
  }
  first_ms_.push_back(ms.front());
  ms_.push_back(quantile(ms, 0.5));
  lengths_.push_back(passes.front().length);
  expanded_ += passes.front().expanded;
}

void Row::print(const Row& first, std::size_t cells) const {
  std::vector<double> over;
  double total = 0;
  std::size_t solved = 0;
  for (std::size_t n = 0; n < lengths_.size(); ++n) {
    if (lengths_[n] < kInfinity) {
      ++solved;
      total += lengths_[n];
      over.push_back(lengths_[n] / first.lengths_[n]);
    }
  }
  std::printf("%-28s %4zu/%-4zu %9.3f %9.3f %9.3f %9.3f %9.3f %9.3f %8.5f %10.0f %7.0f %8.2f\n",
              name_.c_str(), solved, lengths_.size(), quantile(first_ms_, 0.5), quantile(ms_, 0.5),
              quantile(ms_, 0.9), quantile(ms_, 1), sum(ms_) / double(ms_.size()),
              total / double(std::max<std::size_t>(solved, 1)), quantile(over, 0.5),
              expanded_ / double(ms_.size()), 1e6 * sum(ms_) / std::max(expanded_, 1.0),
              resident_ / double(cells));
}

void plan_all(std::vector<Row>& rows, const Cells& cells, const std::vector<Way>& ways,
              int passes) {
  for (const Way& way : ways) {
    std::vector<std::vector<Row::Plan>> plans(rows.size());
    for (int pass = 0; pass < passes; ++pass) {
      for (std::size_t n = 0; n < rows.size(); ++n) {
        plans[n].push_back(rows[n].plan(cells, way));
      }
    }
    for (std::size_t n = 0; n < rows.size(); ++n) {
      rows[n].add(plans[n]);
    }
  }
}

void print(const std::vector<Row>& rows, std::size_t cells) {
  std::printf("%-28s %9s %9s %9s %9s %9s %9s %9s %8s %10s %7s %8s\n", "planner", "solved",
              "first ms", "median", "p90", "most", "mean", "length", "over", "expanded", "ns each",
              "B/cell");
  for (const Row& row : rows) {
    row.print(rows.front(), cells);
  }
  std::printf("peak of the program: %.0f MB\n", peak_mb());
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}
}  // namespace altiplan::bench
