// SPDX-License-Identifier: Apache-2.0
#include "host/config/config.hpp"

#include "files.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::host::config_test {
namespace {

/// Everything that is wrong with the files, as the user reads it.
class ConfigTest : public testing::Files {
 protected:
  std::string problems(const std::string& text) const {
    try {
      load_config(pipeline(text), overrides_);
    } catch (const Error& error) {
      return without_folder(error.what());
    }
    return "";
  }
  std::string scenario_problems(const std::string& more) const {
    scenario(more);
    return problems(kPlan);
  }
  static constexpr const char* kPlan = "steps: [{plan: told}]\n";
};

struct Case {
  const char* text;
  const char* expected;
};

TEST_F(ConfigTest, WhatIsWrongWithSteps) {
  const Case cases[] = {
      {"steps: []\n", "p.yaml:3:8: steps: expected at least 1 item, found 0"},
      {"name: x\n", "p.yaml:1:1: the key 'steps' is missing: steps, run in order"},
      {"steps: [told]\n", "p.yaml:3:9: steps.0: expected a map of keys, found 'told'"},
      {"steps: [{id: a}]\n",
       "p.yaml:3:9: steps.0: expected one verb: plan, smooth, returns or fly"},
      {"steps: [{plan: told, fly: route}]\n",
       "p.yaml:3:9: steps.0: expected one verb: plan, smooth, returns or fly"},
      {"steps: [{plan: tolled}]\n",
       "p.yaml:3:10: steps.0.plan: no library provides the planner 'tolled'; did you mean 'told'?"},
      {"steps: [{plan: told}, {smooth: told}]\n",
       "p.yaml:3:24: steps.1.smooth: no library provides the smoother 'told'"},
      {"steps: [{plan: told, with: {dose: straight}}]\n",
       "p.yaml:3:29: steps.0.with.dose: unknown key; did you mean 'does'?"},
      {"steps: [{plan: told, replan: a}]\n",
       "p.yaml:3:22: steps.0.replan: unknown key; did you mean 'plan'?"},
      {"steps: [{plan: told, with: {does: stright}}]\n",
       "p.yaml:3:35: steps.0.with.does: expected one of straight, past"},
      {"steps: [{plan: told, within_s: 0}]\n",
       "p.yaml:3:32: steps.0.within_s: expected more than 0 and at most 1e+08 s, found 0"},
      {"steps: [{plan: told, within_iterations: -1}]\n",
       "steps.0.within_iterations: expected at least 0, found -1"},
      {"steps: [{plan: told, from: a}]\n",
       "a plan step takes no route: from is for smooth and fly"},
      {"steps: [{smooth: told_smoother}]\n",
       "p.yaml:3:9: steps.0: there is no route to smooth yet: expected an earlier plan step"},
      {"steps: [{plan: told}, {smooth: told_smoother, from: tol}]\n",
       "p.yaml:3:47: steps.1.from: there is no earlier step 'tol'; did you mean 'told'?"},
      {"steps: [{plan: told, id: a}, {plan: told, id: a}]\n",
       "p.yaml:3:43: steps.1.id: the id 'a' is already used by another step"},
      {"steps: [{plan: told, id: a, else: [{plan: told, id: a}]}]\n",
       "p.yaml:3:49: steps.0.else.0.id: the id 'a' is already used by another step"},
      {"steps: [{returns: px4}]\n",
       "p.yaml:3:9: steps.0: there is no route to judge yet: expected an earlier plan step"},
      {"steps: [{plan: told}, {returns: dji}]\n",
       "p.yaml:3:33: steps.1.returns: expected one of ardupilot, px4; found 'dji'"},
      {"steps: [{plan: told}, {returns: px4, within_s: 3}]\n",
       "steps.1.within_s: unknown key; expected one of plan, fly, returns, smooth, id, params"},
      {"steps: [{plan: told}, {returns: px4, params: none.param}]\n",
       "steps.1.params: file not found: '"},
      {"steps: [{plan: told, params: none.param}]\n", "steps.0.params: unknown key"},
      {"steps: [{plan: told}, {returns: px4}, {smooth: told_smoother}]\n",
       "steps.2: a returns step judges the last route: expected it behind this one"},
      {"steps: [{plan: told, else: [{fly: route}]}]\n",
       "p.yaml:3:29: steps.0.else.0: expected the verb 'plan', as in its step"},
      {"steps: [{plan: told, else: [{plan: told, else: [{plan: told}]}]}]\n",
       "p.yaml:3:42: steps.0.else.0.else: an alternative cannot have alternatives"},
      {"steps: [{plan: told}, {fly: route, replan: tolt}]\n",
       "p.yaml:3:36: steps.1.replan: there is no earlier plan step 'tolt'; did you mean 'told'?"},
      {"steps: [{plan: told}, {fly: route, replan: {smooth: told_smoother}}]\n",
       "p.yaml:3:44: steps.1.replan: expected {plan: NAME, with: {…}}"},
      {"steps: [{plan: told}, {fly: route, replan: {plan: told, else: [{plan: told}]}}]\n",
       "steps.1.replan.else: a replan has no alternatives"},
      {"steps: [{plan: told}, {fly: route, replan: [a]}]\n",
       "steps.1.replan: expected a map of keys, found a list"},
      {"steps: [{plan: told}, {fly: route, replan: {plan: told, with: {x: 1}}}]\n",
       "steps.1.replan.with.x: unknown key"},
      {"steps: [{plan: told}, {fly: route, with: {a: 1}}]\n",
       "steps.1.with: fly: route takes no parameters"},
      {"steps: [{plan: told}, {fly: route}, {plan: told}]\n",
       "p.yaml:3:37: steps.2: a fly step must be the last"},
      {"steps: [{plan: told}, {fly: route, smooth: [{told_smother: {}}]}]\n",
       "steps.1.smooth.0: no library provides the smoother 'told_smother'; did you mean"},
      {"steps: [{plan: told}]\nconstraints: [{not_nort: {}}]\n",
       "p.yaml:4:16: constraints.0: no library provides the constraint 'not_nort'; did you mean "
       "'not_north'?"},
      {"steps: [{plan: told}]\nseed: -3\n", "p.yaml:4:7: seed: expected at least 0, found -3"},
      {"steps: [{plan: told}]\nsteps: [{plan: told}]\n", "p.yaml:4:1: steps: "},
  };
  for (const Case& one : cases) {
    EXPECT_HAS(problems(one.text), one.expected);
  }
}

TEST_F(ConfigTest, WhatIsWrongWithAScenario) {
  const Case cases[] = {
      {"winds: 3\n", "s.yaml:5:1: winds: unknown key"},
      {"environment: [{boxx: {}}]\n",
       "s.yaml:5:16: environment.0: no library provides the "
       "environment 'boxx'; did you mean 'box'?"},
      {"environment: [{box: {min_m: [0, 0, 0]}}]\n",
       "s.yaml:5:21: environment.0.box: the key 'max_m' is missing: upper corner"},
      {"environment:\n  - box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}\n    id: a\n"
       "  - box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}\n    id: a\n",
       "s.yaml:9:5: environment.1.id: the id 'a' is already used by another layer"},
      {"environment: [{terrain: {file: no.tif}}]\n",
       "s.yaml:5:32: environment.0.terrain.file: file not found: 'no.tif'"},
      {"environment: [{sphere: {at_m: [1, 2], radius_m: 3}}]\n",
       "a sphere's centre needs a height: a third coordinate, or above_ground_m"},
      {"start_time: yesterday\n",
       "s.yaml:5:1: start_time: expected a time such as 2026-05-01T10:00:00Z, found 'yesterday'"},
      {"via: [{at_m: [1, 2]}]\n", "s.yaml:5:7: via.0: the point has no height"},
      {"via: [{tolerance_m: 3}]\n",
       "s.yaml:5:7: via.0: a point (at_m, at_lonlat or at_cell) is missing"},
      {"moving: [{spere: {}}]\n",
       "s.yaml:5:11: moving.0: unknown shape 'spere': expected sphere, cylinder, box, prism or "
       "random; did you mean 'sphere'?"},
      {"moving: [{sphere: {at_m: [1, 2, 3], radius_m: 1}}]\n",
       "moving.0.sphere: the key 'velocity_mps' is missing"},
      {"moving: [{random: {count: 1, radius_m: 1, speed_mps: 1}, id: a}, {random: {count: 1, "
       "radius_m: 1, speed_mps: 1}, id: a}]\n",
       "moving.1.id: the id 'a' is already used by another moving obstacle"},
      {"events: [{remove: x}]\n", "s.yaml:5:10: events.0: expected either at_s or when_near"},
      {"events: [{at_s: 3}]\n", "expected one of add, remove, move, set_cells, move_goal, visit"},
      {"events: [{at_s: 3, remove: x}]\n",
       "s.yaml:5:20: events.0.remove: there is no layer or moving obstacle 'x'"},
      {"events: [{at_s: 3, move_goal: {at_m: [1, 2]}}]\n",
       "s.yaml:5:20: events.0.move_goal: the point has no height"},
      {"events: [{when_near: {at_m: [1, 2], within_m: 3}, move_goal: {at_m: [1, 2, 3]}}]\n",
       "s.yaml:5:11: events.0.when_near: the point has no height"},
      {"events: [{at_s: 3, id: x, move_goal: {at_m: [1, 2, 3]}}]\n",
       "id names an added layer: it is allowed only with add"},
      {"environment: [{cells: {}}]\n"
       "events: [{at_s: 3, set_cells: {layer: cell, cells: [[0, 0, 0]]}}]\n",
       "events.0.set_cells: there is no layer 'cell'; did you mean 'cells'?"},
      {"constraints: [{not_north: {max_y: 3}}]\n",
       "s.yaml:5:28: constraints.0.not_north.max_y: unknown key; expected one of does, holds_for, "
       "max_y_m"},
      {"frame: {crs: 'EPSG:1', origin_lonlat: [1, 2]}\n",
       "s.yaml:5:8: frame: expected crs or origin_lonlat, or crs: local with origin_lonlat"},
      {"vehicle: {radius_m: .inf}\n", "s.yaml:5:21: vehicle.radius_m: expected a"},
  };
  for (const Case& one : cases) {
    EXPECT_HAS(scenario_problems(one.text), one.expected);
  }
  EXPECT_EQ(scenario_problems("level_flight_at_m: 500\nvia: [{at_m: [1, 2]}]\n"), "");
}

TEST_F(ConfigTest, BothFilesAtOnceFromTheTop) {
  write("a.yaml", "altiplan: 2\nstart: {at_m: [1, 2]}\nenvironment: [{boks: {}}]\n");
  const std::string text = problems(
      "steps:\n  - plan: tolled\n  - {fly: route, stepp_s: 1}\nbad: 1\n"
      "scenario: a.yaml\n");
  EXPECT_HAS(text, "scenario");  // twice the key: the file says nothing else
  write("q.yaml",
        "altiplan: 1\nscenario: a.yaml\nsteps:\n  - plan: tolled\n  - {fly: route, stepp_s: 1}\n");
  try {
    load_config(folder_ / "q.yaml", overrides_);
    FAIL();
  } catch (const ConfigError& error) {
    std::vector<std::string> places;
    for (const Problem& problem : error.problems()) {
      places.push_back(without_folder(problem.where.text()) + " " + problem.key);
    }
    const std::vector<std::string> expected{"q.yaml:4:5 steps.0.plan",
                                            "q.yaml:5:18 steps.1.stepp_s",
                                            "a.yaml:1:1 ",
                                            "a.yaml:1:11 altiplan",
                                            "a.yaml:2:1 start",
                                            "a.yaml:3:16 environment.0"};
    EXPECT_EQ(places, expected);
  }
}

TEST_F(ConfigTest, AScenarioThatCannotBeReadDoesNotHideThePipelinesProblems) {
  write("s.yaml", "altiplan: 1\nstart: [1\n");
  const std::string broken = problems("steps: [{plan: tolled}]\n");
  EXPECT_HAS(broken, "p.yaml:3:10: steps.0.plan: no library provides");
  EXPECT_HAS(broken, "s.yaml:");
  std::filesystem::remove(folder_ / "s.yaml");
  const std::string absent = problems("steps: [{plan: tolled}]\n");
  EXPECT_HAS(absent, "p.yaml:2:1: scenario: file not found: 's.yaml'");
  EXPECT_HAS(absent, "steps.0.plan: no library provides");
  write("none.yaml", "altiplan: 1\nsteps: [{plan: told}]\n");
  try {
    load_config(folder_ / "none.yaml", overrides_);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(without_folder(error.what()),
              "none.yaml:1:1: the key 'scenario' is missing: a scenario file, or --scenario");
  }
}

TEST_F(ConfigTest, OverridesReachAnyKey) {
  scenario("environment: [{box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}}]\n");
  overrides_.set = {"steps.0.with.does=no_route",
                    "steps.0.within_s=2.5",
                    "seed=9",
                    "scenario.environment.0.box.max_m=[2, 3, 4]",
                    "scenario.vehicle.radius_m=3",
                    "steps.1.with={does: cuts}",
                    "name='a=b'"};
  const Config config =
      load_config(pipeline("steps: [{plan: told}, {smooth: told_smoother}]\n"), overrides_);
  EXPECT_EQ(config.seed, 9);
  EXPECT_EQ(config.pipeline.name, "a=b");
  EXPECT_EQ(config.steps[0].within_s, 2.5);
  EXPECT_EQ(config.steps[0].with.find("does")->text, "no_route");
  EXPECT_EQ(config.steps[1].with.find("does")->text, "cuts");
  EXPECT_EQ(config.scenario.vehicle.radius_m, 3);
  EXPECT_EQ(config.scenario.environment[0].parameters.find("max_m")->items[1].text, "3");
}

TEST_F(ConfigTest, BadOverridesAreToldByTheirText) {
  const Case cases[] = {
      {"seed", "--set seed: expected KEY=VALUE, or ~KEY to remove"},
      {"=3", "--set =3: expected KEY=VALUE, or ~KEY to remove"},
      {"steps.0.with.dose=3", "--set steps.0.with.dose=3: steps.0.with.dose: unknown key"},
      {"steps.2.id=b",
       "--set steps.2.id=b: steps.2.id: '2' is not an index of this list, which has 1 item, "
       "counted from 0; 1 adds one"},
      {"steps.1.id=b",
       "--set steps.1.id=b: steps.1: expected one verb: plan, smooth, returns or fly"},
      {"~steps.1", "--set ~steps.1: steps.1: '1' is not an index of this list"},
      {"~steps.0.dose", "--set ~steps.0.dose: steps.0.dose: there is no 'dose' to remove"},
      {"steps.x.id=b", "'x' is not an index of this list"},
      {"steps.-1.id=b", "'-1' is not an index of this list"},
      {"steps..id=b", "expected keys separated by single dots"},
      {"scenario.=b", "--set scenario.=b: expected keys separated by single dots"},
      {"steps.0.within_s=-1",
       "steps.0.within_s: expected more than 0 and at most 1e+08 s, found -1"},
      {"steps.0.plan=tolled", "--set steps.0.plan=tolled: steps.0.plan: no library provides"},
      {"scenario.goal.tolerance_m=far",
       "--set scenario.goal.tolerance_m=far: goal.tolerance_m: expected a number"},
      {"scenario.moving.0.sphere=1", "moving: expected a list, found a map"},
      {"seed=[1", "--set seed=[1"},
      {"scenario=gone.yaml", "--set scenario=gone.yaml: scenario: file not found: 'gone.yaml'"},
  };
  for (const Case& one : cases) {
    overrides_.set = {one.text};
    EXPECT_HAS(problems(kPlan), one.expected);
  }
}

TEST_F(ConfigTest, GivesIdsToWhatHasNone) {
  const std::string box = "{box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}}";
  scenario("environment: [" + box + ", " + box + ", {cells: {}}]\n" +
           "moving: [{sphere: {at_m: [1, 2, 3], radius_m: 1, velocity_mps: [0, 0, 0]}}]\n" +
           "events: [{at_s: 1, add: " + box + "}, {at_s: 2, remove: box_3}, " +
           "{at_s: 3, move: {layer: sphere_1, by_m: [1, 0, 0]}}]\n");
  const Config config = load_config(
      pipeline("steps: [{plan: told, else: [{plan: told}, {plan: keeping}]}, {plan: told}]\n"),
      overrides_);
  EXPECT_EQ(config.scenario.environment[0].id, "box");
  EXPECT_EQ(config.scenario.environment[1].id, "box_2");
  EXPECT_EQ(config.scenario.environment[2].id, "cells");
  EXPECT_EQ(config.scenario.events[0].id, "box_3");
  EXPECT_EQ(config.scenario.moving[0].id, "sphere_1");
  EXPECT_EQ(config.steps[0].id, "told");
  EXPECT_EQ(config.steps[0].otherwise[0].id, "told_2");
  EXPECT_EQ(config.steps[0].otherwise[1].id, "keeping");
  EXPECT_EQ(config.steps[1].id, "told_3");
  EXPECT_EQ(config.files.size(), 2U);
}

TEST_F(ConfigTest, TellsWhatAFileIs) {
  EXPECT_EQ(kind_of(parse_yaml("{altiplan: 1, steps: []}", "")), FileKind::pipeline);
  EXPECT_EQ(kind_of(parse_yaml("{altiplan: 1, goal: {}}", "")), FileKind::scenario);
  EXPECT_EQ(kind_of(parse_yaml("{altiplan: 1, scenarios: []}", "")), FileKind::study);
  EXPECT_EQ(kind_of(parse_yaml("{altiplan: 1, tables: []}", "")), FileKind::paper);
  EXPECT_EQ(load_scenario(folder_ / "s.yaml", overrides_).scenario.goal.point.at[0], 900);
}

TEST_F(ConfigTest, ExplainsWhereAValueCameFrom) {
  overrides_.set = {"steps.0.with.does=no_route"};
  const Config config =
      load_config(pipeline("steps: [{plan: told, within_s: 2}, {fly: route}]\n"), overrides_);
  std::string text;
  for (const Explained& one : explain(config)) {
    text += one.key + "=" + one.value_json + " " + without_folder(one.from) + "\n";
  }
  EXPECT_HAS(text, "steps.0.with.does=\"no_route\" --set steps.0.with.does=no_route\n");
  EXPECT_HAS(text, "steps.0.within_s=2 p.yaml:3:32\n");
  EXPECT_HAS(text, "steps.0.with.past_m=[0, 0, 0] default\n");
}
}  // namespace
}  // namespace altiplan::host::config_test
