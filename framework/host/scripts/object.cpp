// SPDX-License-Identifier: Apache-2.0
#include "host/scripts/object.hpp"

#include <unistd.h>

#include <atomic>
#include <map>

#include "altiplan/error.hpp"
#include "host/scripts/plan.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace {

/// Processes without a planner, which have run the file; closed unless it is asked for.
class Waiting {
 public:
  void open() { is_open_ = true; }
  void give(const std::filesystem::path& file, std::unique_ptr<ScriptWorker> worker) {
    const std::lock_guard lock(mutex_);
    if (is_open_) {
      workers_[file].push_back(std::move(worker));
    }
  }
  std::unique_ptr<ScriptWorker> take(const std::filesystem::path& file) {
    const std::lock_guard lock(mutex_);
    std::vector<std::unique_ptr<ScriptWorker>>& waiting = workers_[file];
    if (waiting.empty()) {
      return nullptr;
    }
    std::unique_ptr<ScriptWorker> worker = std::move(waiting.back());
    waiting.pop_back();
    return worker;
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> is_open_ = false;
  std::map<std::filesystem::path, std::vector<std::unique_ptr<ScriptWorker>>> workers_;
};

Waiting& waiting() {
  static Waiting all;  // destroyed at the end of the program, with the processes
  return all;
}

Traits traits_of(const Json& reported) {
  Traits traits;
  for (const auto& [name, value] :
       {std::pair("complete", &traits.complete), std::pair("optimal", &traits.optimal),
        std::pair("any_angle", &traits.any_angle), std::pair("anytime", &traits.anytime),
        std::pair("planar", &traits.planar), std::pair("spatial", &traits.spatial),
        std::pair("avoids_obstacles", &traits.avoids_obstacles)}) {
    *value = reported.value(name, *value);
  }
  return traits;
}
}  // namespace

void keep_script_processes() { waiting().open(); }

ScriptObject::ScriptObject(ScriptSource source) : source_(std::move(source)), owner_(::getpid()) {
  idle_.push_back(make_worker(&made_));
}

ScriptObject::~ScriptObject() {
  forget_those_of_a_parent();
  for (std::unique_ptr<ScriptWorker>& worker : idle_) {
    waiting().give(source_.file, std::move(worker));
  }
}

void ScriptObject::forget_those_of_a_parent() const {
  if (::getpid() == owner_) {
    return;
  }
  for (std::unique_ptr<ScriptWorker>& worker : idle_) {
    (void)worker.release();
  }
  idle_.clear();
  owner_ = ::getpid();
}

std::unique_ptr<ScriptWorker> ScriptObject::make_worker(Json* made) const {
  std::unique_ptr<ScriptWorker> worker = waiting().take(source_.file);
  if (worker == nullptr) {
    worker = std::make_unique<ScriptWorker>(source_.file);
  }
  ScriptMessage answer = worker->answer_to(
      {{"make", source_.name}, {"kind", source_.kind}, {"with", source_.parameters}});
  if (made != nullptr) {
    *made = std::move(answer.head);
  }
  return worker;
}

std::unique_ptr<ScriptWorker> ScriptObject::take_worker() const {
  {
    const std::lock_guard lock(mutex_);
    forget_those_of_a_parent();
    if (!idle_.empty()) {
      std::unique_ptr<ScriptWorker> worker = std::move(idle_.back());
      idle_.pop_back();
      return worker;
    }
  }
  return make_worker(nullptr);
}

void ScriptObject::give_back(std::unique_ptr<ScriptWorker> worker) const {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

PlanResult ScriptObject::answer(const Request& request, const Polyline* route) const {
  std::unique_ptr<ScriptWorker> worker = take_worker();
  PlanResult result = ScriptPlan(request, route, *worker).result();
  give_back(std::move(worker));
  return result;
}

ScriptMessage ScriptObject::answer(const ScriptMessage& call, const ScriptAsked& asked,
                                   std::chrono::seconds patience) const {
  std::unique_ptr<ScriptWorker> worker = take_worker();
  const auto until = ScriptWorker::Clock::now() + patience;
  worker->send(call.head, call.numbers);
  while (true) {
    std::optional<ScriptMessage> message = worker->receive(until);
    if (!message || ScriptWorker::Clock::now() > until) {
      throw PluginError("did not answer within " + std::to_string(patience.count()) + " s",
                        Reason::never_stopped);
    }
    if (!message->head.contains("ask")) {
      give_back(std::move(worker));
      return *std::move(message);
    }
    const ScriptMessage reply = script_answer(*message, asked);
    worker->send(reply.head, reply.numbers);
  }
}

ScriptPlanner::ScriptPlanner(ScriptSource source)
    : object_(std::move(source)), traits_(traits_of(object_.made().at("traits"))) {}
}  // namespace altiplan::host
