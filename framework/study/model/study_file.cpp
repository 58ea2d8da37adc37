// SPDX-License-Identifier: Apache-2.0
#include "study/model/study_file.hpp"

#include "host/config/scenario_file.hpp"

namespace altiplan::study {

void ScenarioChoice::describe(Fields& f) {
  f("id", id).doc("name in reports (default: the file's name without .yaml)");
  f("file", file).required().doc("a scenario");
  f("from", from)
      .doc(
          "a published set that gives the scenario its ends, map and reference: a .scen, .3dscen "
          "or .mat file, or the folder of BARN's worlds or of MAT-files");
  f("every", every).range(1, 1e6).doc("of the set the first scenario, and each so many after it");
  f.check(from || every == 1, "every is of a set: expected from, or no every");
  f("set", set).doc("keys of the scenario over their values: one, a list of them, or FROM..TO");
}

void PipelineChoice::describe(Fields& f) {
  f("id", id).required().doc("name in claims and reports");
  f("file", file).required().doc("a pipeline");
  f("set", set).doc("keys of the pipeline over their values: one, a list of them, or FROM..TO");
}

void StudyBudget::describe(Fields& f) {
  f("time_s", time_s)
      .unit("s")
      .greater_than(0)
      .doc("time budget of each plan step, replaces its within_s");
  f("iterations", iterations)
      .at_least(0)
      .doc("budget of each plan step in units of `expanded`, replaces its within_iterations");
  f("wall_s", wall_s)
      .unit("s")
      .greater_than(0)
      .doc("wall-clock limit of a run, which is ended after it");
  f("cpu_s", cpu_s).unit("s").greater_than(0).doc("CPU time limit of a run, all its threads");
  f("memory_mb", memory_mb)
      .unit("MB")
      .greater_than(0)
      .doc("memory limit of a run, which is ended beyond it");
}

void MetricChoice::describe(Fields& f) {
  std::string id;
  f("name", name).doc("value of a run: length_m, flight.length_m …; or an objective");
  f("better", better)
      .one_of({"lower", "higher"})
      .doc("which values are better (default: by the metric's name, usually lower)");
  if (name.empty() || !f.reading()) {
    f("id", id).doc("name of the objective's value; default: the objective's");
    f.plugin("objective", plugin, parameters)
        .doc("an objective that the routes of all pipelines are measured by");
    name = id.empty() ? plugin : id;
  }
}

void ClaimEntry::describe(Fields& f) {
  f("id", id).required().doc("name in reports");
  f("that", that).required().doc("statistic: median(fusion.flight.length_m / astar.length_m)");
  f("is", is).required().doc("comparison: <= 0.95");
  f("confidence", confidence)
      .range(0.5, 0.9999)
      .doc("confidence level of the interval that must satisfy the comparison");
}

void StudyFile::describe(Fields& f) {
  f("altiplan", altiplan).range(host::kFileFormat, host::kFileFormat).required().doc("file format");
  f("name", name).doc("title in reports");
  f("scenarios", scenarios).min_items(1).required().doc("scenarios of the study");
  f("pipelines", pipelines).min_items(1).required().doc("pipelines to compare");
  f("repetitions", repetitions)
      .range(1, 1e6)
      .doc("runs of each pipeline in each scenario, each with its own seed");
  f("seed", seed).at_least(0).doc("random seed of the study; the seeds of the runs derive from it");
  f("budget", budget).doc("limits of a run");
  f("metrics", metrics)
      .doc("metrics that the report compares (default: length_m, plan_time_s, expanded)");
  f("claims", claims).doc("claims that the study tests");
}
}  // namespace altiplan::study
