// SPDX-License-Identifier: Apache-2.0
#include "host/config/pipeline_file.hpp"

namespace altiplan::host {

const char* name(Verb verb) {
  constexpr const char* kNames[] = {"plan", "smooth", "returns", "fly"};
  return kNames[int(verb)];
}

void SmootherEntry::describe(Fields& f) {
  f.plugin("smoother", plugin, parameters).doc("a smoother with its parameters").required();
}

void FlyKeys::describe(Fields& f) {
  f("replan", replan).doc("id of the plan step whose session continues, or {plan: …, with: …}");
  f("when", when).one_of({"unsafe", "any_change"}).doc("when to replan");
  f("smooth", smooth).doc("smoothers for replanned routes");
  f("command", command)
      .one_of({"near", "always"})
      .doc("near: the pilot flies near obstacles unknown to the route; always: on the whole route");
  f("step_s", step_s).unit("s").greater_than(0).at_most(3600).doc("simulation time step");
  f("replan_latency_s", replan_latency_s)
      .unit("s")
      .at_least(0)
      .doc("simulated delay of a replanned route");
  f("max_time_s", max_time_s)
      .unit("s")
      .greater_than(0)
      .doc("maximum flight time; default: ten times the route's duration");
}

void StepEntry::describe(Fields& f) {
  // A fly step's `smooth` is a list of smoothers; elsewhere it is the verb.
  std::optional<std::string> plan;
  std::optional<std::string> pilot;
  std::optional<Value> smooth;
  std::optional<std::string> autopilot;
  f("plan", plan).doc("a planner, or a local planner that the host rolls out");
  f("fly", pilot).doc("a local planner, or route: follow the route without one");
  f("returns", autopilot)
      .one_of({"ardupilot", "px4"})
      .doc("an autopilot: judges the returns of the route as it flies the mission");
  const bool flies = pilot.has_value();
  const bool judges = autopilot.has_value();
  if (!flies) {
    f("smooth", smooth).doc("a smoother");
  }
  f("id", id).doc("name of the step; default: the plugin's name, or returns");
  if (judges || !f.reading()) {
    f("params", params).doc("the autopilot's parameters (.param, .params); default: its own");
  }
  if (!judges) {
    f("with", with).doc("the plugin's parameters");
    f("from", from).doc("id of the step whose route is the input; default: the last accepted");
    f("within_s", within_s).unit("s").greater_than(0).at_most(1e8).doc("time budget");
    f("within_iterations", within_iterations).at_least(0).doc("budget in units of `expanded`");
    f("within_mb", within_mb).unit("MiB").greater_than(0).at_most(1e9).doc("memory budget");
    f("else", alternatives).doc("steps tried in order if this one is not accepted");
  }
  if (flies || !f.reading()) {
    fly.describe(f);
  }
  const bool smooths = smooth && smooth->kind == Value::Kind::scalar;
  f.check(int(plan.has_value()) + int(flies) + int(smooth.has_value()) + int(judges) == 1,
          "expected one verb: plan, smooth, returns or fly");
  f.check(!smooth || (smooths && !smooth->text.empty()),
          "expected the name of a smoother after smooth");
  f.check(!plan || !plan->empty(), "expected the name of a planner after plan, found none");
  f.check(!pilot || !pilot->empty(),
          "expected the name of a local planner, or route, after fly, found none");
  f.check(!plan || !from, "a plan step takes no route: from is for smooth and fly");
  verb = plan ? Verb::plan : flies ? Verb::fly : judges ? Verb::returns : Verb::smooth;
  plugin = plan ? *plan : flies ? *pilot : judges ? *autopilot : smooths ? smooth->text : "";
  path = f.path();
  if (id.empty()) {
    id = judges ? name(verb) : plugin;
  }
}

void PipelineFile::describe(Fields& f) {
  f("altiplan", altiplan).range(kFileFormat, kFileFormat).required().doc("file format");
  f("name", name).doc("title in results");
  f("scenario", scenario).doc("the scenario file; --scenario overrides it");
  f("seed", seed).at_least(0).doc("seed of all random numbers; --seed overrides it");
  f("plugins", plugins).doc("additional folders of plugin libraries");
  f("constraints", constraints).doc("constraints on routes and tracks");
  f("objective", objective)
      .doc("what routes minimise, instead of the scenario's objective; default: that");
  f("metrics", metrics).doc("objectives that routes are measured by, besides the scenario's");
  f("steps", steps).min_items(1).required().doc("steps, run in order");
}
}  // namespace altiplan::host
