// SPDX-License-Identifier: Apache-2.0
#include "rows.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numeric>

namespace altiplan::bench {
namespace {

double resident() {
  std::ifstream statm("/proc/self/statm");
  double size = 0;
  double pages = 0;
  statm >> size >> pages;
  return pages * double(sysconf(_SC_PAGESIZE));
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}
}  // namespace

Row::Row(host::Registry& registry, const std::string& text)
    : name_(text), planner_(planner(registry, text)) {}

Row::Plan Row::plan(const Cells& cells, const Way& way) {
  const Request request = cells.request(way);
  const double held = resident();
  const double began = thread_s();
  const PlanResult result = planner_->plan(request);
  const double ms = 1e3 * (thread_s() - began);
  resident_ += resident() - held;
  return {ms, judged_length(result, request, name_) / cells.spec().cell.x(),
          counter(result, "expanded")};
}

void Row::add(const std::vector<Plan>& passes) {
  std::vector<double> ms;
  for (const Plan& plan : passes) {
    ms.push_back(plan.ms);
  }
  first_ms_.push_back(ms.front());
  ms_.push_back(median(ms));
  lengths_.push_back(passes.front().length);
  expanded_ += passes.front().expanded;
}

Json Row::figures(const Row& first, std::size_t cells) const {
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
  return {{"planner", name_},
          {"solved", solved},
          {"of", lengths_.size()},
          {"first_ms", median(first_ms_)},
          {"median_ms", median(ms_)},
          {"p90_ms", quantile(ms_, 0.9)},
          {"max_ms", quantile(ms_, 1)},
          {"mean_ms", sum(ms_) / double(ms_.size())},
          {"length", total / double(std::max<std::size_t>(solved, 1))},
          {"over", median(over)},
          {"expanded", expanded_ / double(ms_.size())},
          {"ns_each", 1e6 * sum(ms_) / std::max(expanded_, 1.0)},
          {"bytes_per_cell", resident_ / double(cells)}};
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

void add(Json& figures, const std::vector<Row>& rows, std::size_t cells) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  figures["peak_mb"] = double(usage.ru_maxrss) / 1024;
  for (const Row& row : rows) {
    figures["planners"].push_back(row.figures(rows.front(), cells));
  }
}
}  // namespace altiplan::bench
