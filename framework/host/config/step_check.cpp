// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "host/config/config_check.hpp"

namespace altiplan::host {
namespace {

/// Binds a step map and its alternatives.
StepEntry bind_step(Checker& checker, const Value& tree, const std::string& path,
                    bool alternative) {
  StepEntry step;
  checker.add(bind(step, &tree, path).problems);
  step.where = tree.where;
  step.path = path;
  if (alternative && !step.alternatives.empty()) {
    checker.problem(place_of(tree, "else"), path + ".else",
                    "an alternative cannot have alternatives: list them all under the step");
    step.alternatives.clear();
  }
  for (std::size_t i = 0; i < step.alternatives.size(); ++i) {
    const std::string key = item(path + ".else", i);
    const StepEntry& other =
        step.otherwise.emplace_back(bind_step(checker, step.alternatives[i], key, true));
    if (!step.plugin.empty() && !other.plugin.empty() && other.verb != step.verb) {
      checker.problem(step.alternatives[i].where, key,
                      std::string("expected the verb '") + name(step.verb) + "', as in its step");
    }
  }
  return step;
}

void check_plugins(Checker& checker, const Config& config, const StepEntry& step,
                   const Value& tree);

void check_replan(Checker& checker, const Config& config, const StepEntry& step,
                  const std::set<std::string>& plans, const Value& tree) {
  const Value& replan = step.fly.replan;
  const std::string key = step.path + ".replan";
  if (replan.kind == Value::Kind::scalar) {
    if (!replan.text.empty() && !plans.contains(replan.text)) {
      checker.problem(place_of(tree, "replan"), key,
                      "there is no earlier plan step '" + replan.text + "'" +
                          did_you_mean(replan.text, {plans.begin(), plans.end()}));
    }
    return;
  }
  StepEntry planner;
  const std::vector<Problem> problems = bind(planner, &replan, key).problems;
  checker.add(problems);
  planner.path = key;
  if (!problems.empty()) {
    return;
  }
  if (planner.verb != Verb::plan) {
    checker.problem(replan.where, key, "expected {plan: NAME, with: {…}}");
    return;
  }
  if (!planner.alternatives.empty()) {
    checker.problem(place_of(replan, "else"), key + ".else", "a replan has no alternatives");
  }
  check_plugins(checker, config, planner, replan);
}

/// Checks the step's plugin and smoothers, with their parameters.
void check_plugins(Checker& checker, const Config& config, const StepEntry& step,
                   const Value& tree) {
  Registry& registry = *config.registry;
  if (step.plugin.empty()) {
    return;  // already reported
  }
  if (step.verb == Verb::returns) {
    if (step.params) {
      checker.check_file(step.params->text, place_of(tree, "params"), step.path + ".params");
    }
  } else if (step.verb == Verb::fly && step.plugin == kFollowRoute) {
    if (!step.with.entries.empty()) {
      checker.problem(place_of(tree, "with"), step.path + ".with",
                      "fly: route takes no parameters");
    }
  } else {
    checker.check_plugin(kind_of_step(registry, step), step.plugin, step.with,
                         place_of(tree, name(step.verb)), step.path + ".with",
                         step.path + "." + name(step.verb));
  }
  for (std::size_t i = 0; i < step.fly.smooth.size(); ++i) {
    const SmootherEntry& smoother = step.fly.smooth[i];
    const std::string path = item(step.path + ".smooth", i);
    checker.check_plugin("smoother", smoother.plugin, smoother.parameters, place_of(tree, "smooth"),
                         path + "." + smoother.plugin, path);
  }
}

bool is_text(const Value& map, std::string_view key) {
  const Value* value = map.find(key);
  return value != nullptr && value->kind == Value::Kind::scalar;
}

/// Checks the steps in order, keeping track of the ids so far.
class StepCheck {
 public:
  StepCheck(Checker& checker, Config& config) : checker_(checker), config_(config) {}

  void check(std::size_t index) {
    const Value& tree = config_.pipeline.steps[index];
    StepEntry step = bind_step(checker_, tree, item("steps", index), false);
    if (flown_) {
      checker_.problem(tree.where, step.path, "a fly step must be the last");
    }
    unknown_ = unknown_ || step.plugin.empty();
    const bool judges = step.verb == Verb::returns;
    if (step.verb != Verb::plan && plans_.empty() && !unknown_) {
      checker_.problem(tree.where, step.path,
                       std::string("there is no route to ") + (judges ? "judge" : name(step.verb)) +
                           " yet: expected an earlier plan step");
    }
    if (judged_ && (step.verb == Verb::plan || step.verb == Verb::smooth)) {
      checker_.problem(tree.where, step.path,
                       "a returns step judges the last route: expected it behind this one");
    }
    judged_ = judged_ || judges;
    flown_ = flown_ || step.verb == Verb::fly;
    check_one(step, tree);
    for (std::size_t k = 0; k < step.otherwise.size(); ++k) {
      check_one(step.otherwise[k], step.alternatives[k]);
    }
    earlier_ = ids_;  // the step that an alternative replaces is not an earlier step
    if (step.verb == Verb::plan) {
      plans_.insert(step.id);
      for (const StepEntry& other : step.otherwise) {
        plans_.insert(other.id);
      }
    }
    config_.steps.push_back(std::move(step));
  }

 private:
  void check_one(StepEntry& step, const Value& tree) {
    if (step.from && is_text(tree, "from") && !earlier_.contains(*step.from)) {
      checker_.problem(place_of(tree, "from"), step.path + ".from",
                       "there is no earlier step '" + *step.from + "'" +
                           did_you_mean(*step.from, {earlier_.begin(), earlier_.end()}));
    }
    check_plugins(checker_, config_, step, tree);
    check_replan(checker_, config_, step, plans_, tree);
    const bool given = tree.find("id") != nullptr;
    std::string id = given ? step.id : ids_.free_id(step.id);
    if (!ids_.insert(id).second) {
      checker_.problem(place_of(tree, "id"), step.path + ".id",
                       "the id '" + id + "' is already used by another step");
    }
    step.id = std::move(id);
  }

  Checker& checker_;
  Config& config_;
  Ids ids_;
  std::set<std::string> earlier_;
  std::set<std::string> plans_;
  bool judged_ = false;
  bool flown_ = false;
  bool unknown_ = false;  ///< a step without a verb may have been meant as a plan step
};
}  // namespace

std::vector<Problem> planner_problems(const Config& config, const Objective& objective) {
  std::vector<Problem> problems;
  const auto check = [&](const StepEntry& step, const Value& tree) {
    if (step.verb != Verb::plan || step.plugin.empty()) {
      return;
    }
    const std::string kind = kind_of_step(*config.registry, step);
    Traits traits;
    if (kind == "planner") {
      try {
        traits = config.registry->get(kind, step.plugin).planner(&step.with)->traits();
      } catch (const Error&) {
        return;  // its parameters are refused
      }
    }
    if (const std::string why = objective_problem(objective, traits); !why.empty()) {
      problems.push_back({place_of(tree, "plan"), step.path + ".plan",
                          "the " + kind + " '" + step.plugin + "' " + why +
                              "; objective: {length: {}} asks for the shortest route"});
    }
  };
  for (std::size_t i = 0; i < config.steps.size(); ++i) {
    const StepEntry& step = config.steps[i];
    check(step, config.pipeline.steps[i]);
    for (std::size_t k = 0; k < step.otherwise.size(); ++k) {
      check(step.otherwise[k], step.alternatives[k]);
    }
    if (step.fly.replan.kind == Value::Kind::map) {
      StepEntry planner;
      bind(planner, &step.fly.replan, step.path + ".replan");  // its problems are reported
      planner.path = step.path + ".replan";
      check(planner, step.fly.replan);
    }
  }
  return problems;
}

const char* kind_of_step(Registry& registry, const StepEntry& step) {
  switch (step.verb) {
    case Verb::smooth:
      return "smoother";
    case Verb::fly:
      return "local_planner";
    case Verb::plan:
    case Verb::returns:  // it names none
      break;
  }
  return registry.offering("planner", step.plugin) == nullptr &&
                 registry.offering("local_planner", step.plugin) != nullptr
             ? "local_planner"
             : "planner";
}

void check_steps(Checker& checker, Config& config) {
  StepCheck check(checker, config);
  for (std::size_t i = 0; i < config.pipeline.steps.size(); ++i) {
    check.check(i);
  }
  if (config.objective() != nullptr) {  // what it depends on is known once it is made
    const auto length = plugin(*config.registry, "objective", "length").objective(nullptr, Site());
    checker.add(planner_problems(config, *length));
  }
}
}  // namespace altiplan::host
