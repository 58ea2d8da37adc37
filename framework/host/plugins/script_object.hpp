// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "altiplan/planner.hpp"
#include "altiplan/smoother.hpp"
#include "host/plugins/script_worker.hpp"

namespace altiplan::host {

/// What a planner or smoother of a file of Python is made of.
struct ScriptSource {
  std::filesystem::path file;
  std::string kind;
  std::string name;
  nlohmann::ordered_json parameters;  ///< a map
};

/// An object in Python. Each call at a time has a process, which waits for the next one; one whose
/// call failed is ended. The process gets values, and asks this one about the world.
class ScriptObject {
 public:
  /// Throws PluginError if the constructor in Python raises.
  explicit ScriptObject(ScriptSource source);
  ~ScriptObject();
  ScriptObject(const ScriptObject&) = delete;
  ScriptObject& operator=(const ScriptObject&) = delete;

  const Traits& traits() const { return traits_; }
  /// Plans, or smooths the route if there is one.
  PlanResult answer(const Request& request, const Polyline* route) const;

 private:
  std::unique_ptr<ScriptWorker> make_worker(Traits* traits) const;
  std::unique_ptr<ScriptWorker> take_worker() const;

  ScriptSource source_;
  Traits traits_;
  pid_t owner_;  ///< a forked copy of this process must leave the processes of `idle_` alone
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<ScriptWorker>> idle_;
};

class ScriptPlanner final : public Planner {
 public:
  explicit ScriptPlanner(ScriptSource source) : object_(std::move(source)) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    return object_.answer(request, nullptr);
  }
  Traits do_traits() const override { return object_.traits(); }

  ScriptObject object_;
};

class ScriptSmoother final : public Smoother {
 public:
  explicit ScriptSmoother(ScriptSource source) : object_(std::move(source)) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    return object_.answer(request, &route);
  }

  ScriptObject object_;
};
}  // namespace altiplan::host
