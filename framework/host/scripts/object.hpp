// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/smoother.hpp"
#include "host/base/json.hpp"
#include "host/scripts/answers.hpp"
#include "host/scripts/worker.hpp"

namespace altiplan::host {

/// What an object of a plugin in a file of Python is made of.
struct ScriptSource {
  std::filesystem::path file;
  std::string kind;
  std::string name;
  Json parameters;  ///< a map
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

  /// What the object tells of itself.
  const Json& made() const { return made_; }
  /// Plans, or smooths the route if there is one.
  PlanResult answer(const Request& request, const Polyline* route) const;
  /// The answer to a call that has no budget, within `patience`; its questions are about `asked`.
  /// Throws PluginError if the call raises or does not end.
  ScriptMessage answer(const ScriptMessage& call, const ScriptAsked& asked,
                       std::chrono::seconds patience) const;

 private:
  std::unique_ptr<ScriptWorker> make_worker(Json* made) const;
  std::unique_ptr<ScriptWorker> take_worker() const;
  void give_back(std::unique_ptr<ScriptWorker> worker) const;
  void forget_those_of_a_parent() const;

  ScriptSource source_;
  Json made_;
  mutable std::mutex mutex_;
  mutable pid_t owner_;  ///< a forked copy of this process must leave the others of `idle_` alone
  mutable std::vector<std::unique_ptr<ScriptWorker>> idle_;
};

class ScriptPlanner final : public Planner {
 public:
  explicit ScriptPlanner(ScriptSource source);

 private:
  PlanResult do_plan(const Request& request) const override {
    return object_.answer(request, nullptr);
  }
  Traits do_traits() const override { return traits_; }

  ScriptObject object_;
  Traits traits_;
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

/// A constraint that asks its object in Python about one leg, or one route, at a time.
std::unique_ptr<Constraint> script_constraint(ScriptSource source);

/// A layer of what `build` in Python returns: solids, the cells of a grid, or ground. Its process
/// ends with the call; the layer is one of the kit.
std::unique_ptr<Environment> script_environment(ScriptSource source, const Site& site);

/// The integral of the field that `build` in Python returns. Its process ends with the call.
std::unique_ptr<Objective> script_objective(ScriptSource source, const Site& site);
}  // namespace altiplan::host
