// SPDX-License-Identifier: Apache-2.0
#include "host/scripts/plan.hpp"

#include "altiplan/error.hpp"
#include "host/scripts/answers.hpp"
#include "host/scripts/values.hpp"

namespace altiplan::host {
namespace {

constexpr auto kGrace = std::chrono::milliseconds(500);  ///< to heed a stop
constexpr auto kLook = std::chrono::milliseconds(20);    ///< between two looks at the budget
}  // namespace

ScriptPlan::ScriptPlan(const Request& request, const Polyline* route, ScriptWorker& worker)
    : request_(request),
      route_(route),
      worker_(worker),
      memory_before_mb_(worker.memory_mb()),
      memory_seen_(Clock::now()) {}

PlanResult ScriptPlan::result() {
  std::vector<double> points;
  for (const Vec3& point : route_ != nullptr ? *route_ : Polyline()) {
    points.insert(points.end(), point.begin(), point.end());
  }
  worker_.send({{route_ != nullptr ? "smooth" : "plan", script_values(request_)}}, points);
  while (true) {
    watch_budget();
    const std::optional<ScriptMessage> message = worker_.receive(Clock::now() + kLook);
    if (!message) {
      continue;
    }
    if (!message->head.contains("ask")) {
      return result_of(*message);
    }
    watch_budget();  // a stop comes before the answer
    answer(*message);
  }
}

void ScriptPlan::watch_budget() {
  const Clock::time_point now = Clock::now();
  watch_memory(now);
  const Budget& budget = request_.budget;
  const bool is_spent =
      too_large_ || budget.stop.stop_requested() || (budget.deadline && now >= *budget.deadline);
  if (!stop_requested_ && is_spent) {
    stop_requested_ = now;
    worker_.send({{"stop", true}});
  } else if (stop_requested_ && now - *stop_requested_ > kGrace) {
    throw PluginError(
        too_large_ ? "used more memory than its within_mb and did not stop when told to"
                   : "did not stop within half a second of the end of its time, and was ended",
        Reason::never_stopped);
  }
}

void ScriptPlan::watch_memory(Clock::time_point now) {
  const double limit_mb = double(request_.budget.max_memory_bytes) / double(1 << 20);
  if (request_.budget.max_memory_bytes == Budget().max_memory_bytes || now - memory_seen_ < kLook) {
    return;
  }
  memory_seen_ = now;
  const double grown = worker_.memory_mb() - memory_before_mb_;
  too_large_ = too_large_ || grown > limit_mb;
  if (grown > 2 * limit_mb + 64) {  // spare the machine
    throw PluginError("used more memory than its within_mb and did not stop when told to",
                      Reason::never_stopped);
  }
}

void ScriptPlan::answer(const ScriptMessage& question) {
  const ScriptMessage answer = script_answer(question, {request_.world.get(), &request_});
  worker_.send(answer.head, answer.numbers);
}

PlanResult ScriptPlan::result_of(const ScriptMessage& answer) const {
  PlanResult result;
  const Json& head = answer.head;
  const Json counters = head.value("counters", Json::object());
  for (const auto& [name, value] : counters.items()) {
    result.counters.push_back({name, value.get<std::int64_t>()});
  }
  const bool is_spent = stop_requested_.has_value() || head.value("spent", false);
  if (head.contains("none") && route_ == nullptr) {
    take_failure(head, result);
    return result;
  }
  result.status = PlanStatus::solved;
  if (head.contains("none")) {
    result.route = *route_;
    result.message = "left unchanged: " + head.value("none", "");
  } else {
    Polyline points;
    for (std::size_t i = 0; i + 2 < answer.numbers.size(); i += 3) {
      points.emplace_back(answer.numbers[i], answer.numbers[i + 1], answer.numbers[i + 2]);
    }
    result.route = std::move(points);
  }
  result.budget_hit = route_ != nullptr && is_spent;
  return result;
}

void ScriptPlan::take_failure(const Json& head, PlanResult& result) const {
  const bool is_spent = stop_requested_.has_value() || head.value("spent", false);
  const bool is_cancelled = !too_large_ && request_.budget.stop.stop_requested();
  result.status = !is_spent      ? PlanStatus::no_route
                  : is_cancelled ? PlanStatus::cancelled
                                 : PlanStatus::timed_out;
  result.budget_hit = result.status == PlanStatus::timed_out;
  result.proved = !is_spent && head.value("proved", false);
  result.message = head.value("none", "");
  if (too_large_) {
    result.reason = Reason::memory;
    result.message = "stopped: it used more memory than its within_mb";
  } else if (result.message.empty()) {
    result.message = is_spent ? "the budget ended before a route was found" : "found no route";
  }
}
}  // namespace altiplan::host
