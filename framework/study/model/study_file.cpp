// SPDX-License-Identifier: Apache-2.0
#include "study/model/study_file.hpp"

#include "host/config/scenario_file.hpp"

namespace altiplan::study {

void ScenarioChoice::describe(Fields& f) {
  f("id", id).doc("name in reports; left out: the file's, without .yaml");
  f("file", file).required().doc("a scenario");
  f("set", set).doc("keys of the scenario over their values: one, a list of them, or FROM..TO");
}

void PipelineChoice::describe(Fields& f) {
  f("id", id).required().doc("name in claims and reports");
  f("file", file).required().doc("a pipeline");
  f("set", set).doc("keys of the pipeline over their values: one, a list of them, or FROM..TO");
}

void StudyBudget::describe(Fields& f) {
  f("time_s", time_s).unit("s").greater_than(0).doc("of each plan step, in place of its within_s");
  f("iterations", iterations)
      .at_least(0)
      .doc("of each plan step in units of `expanded`, in place of its within_iterations");
  f("wall_s", wall_s).unit("s").greater_than(0).doc("of a run, by the clock; then it is ended");
  f("cpu_s", cpu_s).unit("s").greater_than(0).doc("of a run, computing time of all its threads");
  f("memory_mb", memory_mb).unit("MB").greater_than(0).doc("of a run; beyond, it is ended");
}

void MetricChoice::describe(Fields& f) {
  f("name", name).required().doc("a value of the runs: length_m, flight.length_m …");
  f("better", better).one_of({"lower", "higher"}).doc("left out: by the name, mostly lower");
}

void ClaimEntry::describe(Fields& f) {
  f("id", id).required().doc("name in reports");
  f("that", that).required().doc("a statistic: median(fusion.flight.length_m / astar.length_m)");
  f("is", is).required().doc("a comparison: <= 0.95");
  f("confidence", confidence).range(0.5, 0.9999).doc("of the interval that must satisfy it");
}

void StudyFile::describe(Fields& f) {
  f("altiplan", altiplan).range(host::kFileFormat, host::kFileFormat).required().doc("file format");
  f("name", name).doc("title in reports");
  f("scenarios", scenarios).min_items(1).required().doc("what is flown through");
  f("pipelines", pipelines).min_items(1).required().doc("what is compared");
  f("repetitions", repetitions)
      .range(1, 1e6)
      .doc("runs of each pipeline in each scenario, each with a seed of its own");
  f("seed", seed).at_least(0).doc("of the study: those of the runs derive from it");
  f("budget", budget).doc("what a run may take");
  f("metrics", metrics).doc("what the report compares; left out: length_m, plan_time_s, expanded");
  f("claims", claims).doc("what is to be shown");
}
}  // namespace altiplan::study
