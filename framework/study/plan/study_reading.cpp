// SPDX-License-Identifier: Apache-2.0
#include "study/plan/study_reading.hpp"

#include "altiplan/formats/input_file.hpp"
#include "host/base/input.hpp"
#include "host/base/words.hpp"
#include "host/config/config_check.hpp"
#include "host/config/overrides.hpp"
#include "host/config/yaml.hpp"
#include "host/plugins/registry.hpp"
#include "host/result/result_json.hpp"
#include "study/claims/claim_text.hpp"
#include "study/claims/claims.hpp"
#include "study/model/run_values.hpp"
#include "study/plan/study_grid.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

/// The budget as assignments to every plan step, so that `altiplan run --set` can repeat the run.
class Budget {
 public:
  Budget(const StudyBudget& budget, const Location& where, StudyProblems& problems,
         StudyVariants& variants)
      : budget_(budget), where_(where), problems_(problems), variants_(variants) {}

  void give(Variant& variant) const {
    if (!budget_.time_s && !budget_.iterations) {
      return;
    }
    Value tree = host::load_yaml(variant.file);
    try {
      host::apply_overrides(tree, variant.set, host::FileOfKey::pipeline);
    } catch (const ConfigError&) {
      return;  // reported when the pipeline is read
    }
    give_all(variant, tree.find("steps"), "steps");
  }

 private:
  void give_all(Variant& variant, const Value* steps, const std::string& path) const {
    for (std::size_t i = 0; steps != nullptr && i < steps->items.size(); ++i) {
      const std::string step = host::item(path, i);
      if (steps->items[i].find("plan") != nullptr && budget_.time_s) {
        set(variant, step + ".within_s", host::exact_json_text(*budget_.time_s), "budget.time_s");
      }
      if (steps->items[i].find("plan") != nullptr && budget_.iterations) {
        set(variant, step + ".within_iterations", std::to_string(*budget_.iterations),
            "budget.iterations");
      }
      give_all(variant, steps->items[i].find("else"), step + ".else");
    }
  }

  void set(Variant& variant, const std::string& key, const std::string& value,
           const std::string& from) const {
    for (const std::string& other : variant.set) {
      if (other.starts_with(key + "=")) {
        problems_.add(
            where_, from,
            "replaces '" + key + "', which '" + variant.name + "' sets: remove one of the two");
        return;
      }
    }
    variant.set.push_back(key + "=" + value);
    variants_.remember(variant.set.back(), where_, from);
  }

  const StudyBudget& budget_;
  const Location where_;
  StudyProblems& problems_;
  StudyVariants& variants_;
};

/// The error message for a key that is set both directly and within another; "" if there is none.
std::string set_twice(const Value& set) {
  for (const Value::Entry& inner : set.entries) {
    for (const Value::Entry& outer : set.entries) {
      if (inner.key.starts_with(outer.key + ".")) {
        return "sets '" + inner.key + "' twice: also within '" + outer.key + "'";
      }
    }
  }
  return "";
}

/// True if the file exists; reports a problem if not.
bool is_file(StudyProblems& problems, const Path& file, const Location& where,
             const std::string& key) {
  const std::string why = host::file_problem(file.text);
  if (!why.empty()) {
    problems.add(where, key, why);
  }
  return why.empty();
}

void read_scenarios(StudyPlan& plan, const Value& tree, StudyProblems& problems,
                    StudyVariants& variants) {
  for (std::size_t i = 0; i < plan.file.scenarios.size(); ++i) {
    const ScenarioChoice& entry = plan.file.scenarios[i];
    const Value& at = tree.find("scenarios")->items[i];
    const std::string path = host::item("scenarios", i);
    if (entry.id.find_first_of("[]\n\r\t") != std::string::npos) {
      problems.add(
          host::place_of(at, "id"), path + ".id",
          "expected a name without brackets, tabs and line ends, found " + excerpt(entry.id));
    }
    if (is_file(problems, entry.file, host::place_of(at, "file"), path + ".file")) {
      const std::string of =
          entry.id.empty() ? fs::path(entry.file.text).stem().string() : entry.id;
      variants.add(plan.scenarios, of, entry.file, entry.set, "scenario.", path, at.where);
    }
  }
}

void read_pipelines(StudyPlan& plan, const Value& tree, StudyProblems& problems,
                    StudyVariants& variants) {
  for (std::size_t i = 0; i < plan.file.pipelines.size(); ++i) {
    const PipelineChoice& entry = plan.file.pipelines[i];
    const Value& at = tree.find("pipelines")->items[i];
    const std::string path = host::item("pipelines", i);
    if (!host::is_snake_case(entry.id)) {
      problems.add(
          host::place_of(at, "id"), path + ".id",
          "expected lower-case letters, digits and '_', starting with a letter (claims name "
          "it), found " +
              excerpt(entry.id));
    }
    for (const Value::Entry& set : entry.set.entries) {
      if (set.key == "seed" || set.key == "scenario") {
        problems.add(set.where, path + ".set." + set.key,
                     "is set by the study: see its 'repetitions', 'seed' and 'scenarios'");
      }
    }
    if (is_file(problems, entry.file, host::place_of(at, "file"), path + ".file")) {
      variants.add(plan.pipelines, entry.id, entry.file, entry.set, "", path, at.where);
    }
  }
}

void check_metrics(const StudyPlan& plan, const Value& tree, StudyProblems& problems) {
  for (std::size_t i = 0; i < plan.file.metrics.size(); ++i) {
    const Value& at = tree.find("metrics")->items[i];
    if (const std::string why = why_no_value(plan.file.metrics[i].name); !why.empty()) {
      problems.add(host::place_of(at, "name"), host::item("metrics", i) + ".name", why);
    }
  }
}

void check_claims(const StudyPlan& plan, const Value& tree, StudyProblems& problems) {
  std::vector<std::string> names;
  for (const Variant& pipeline : plan.pipelines) {
    names.push_back(pipeline.name);
  }
  std::set<std::string> ids;
  for (std::size_t i = 0; i < plan.file.claims.size(); ++i) {
    const ClaimEntry& claim = plan.file.claims[i];
    const Value& at = tree.find("claims")->items[i];
    const std::string path = host::item("claims", i);
    if (!ids.insert(claim.id).second) {
      problems.add(host::place_of(at, "id"), path + ".id", "the id '" + claim.id + "' is taken");
    }
    const std::vector<Problem> found =
        check_claim(claim, names, host::place_of(at, "that"), host::place_of(at, "is"), path);
    for (const Problem& problem : found) {
      problems.add(problem);
    }
    if (!found.empty()) {
      continue;
    }
    for (const ClaimValue& value : read_quantity(claim.that, names).values) {
      if (const std::string why = why_no_value(value.name); !why.empty()) {
        problems.add(host::place_of(at, "that"), path + ".that", why);
      }
    }
  }
}
}  // namespace

void StudyVariants::add(std::vector<Variant>& all, const std::string& of, const Path& file,
                        const Value& set, const std::string& prefix, const std::string& path,
                        const Location& where) {
  if (!ids_.insert(prefix + of).second) {
    problems_.add(where, path, "the name '" + of + "' is taken: give this entry another id");
    return;
  }
  if (const std::string twice = set_twice(set); !twice.empty()) {
    problems_.add(set.where, path + ".set", twice);
  }
  try {
    for (const GridCell& cell : grid_of(set, path + ".set")) {
      Variant variant{of + cell.label, of, fs::absolute(file.text).lexically_normal(), {}};
      for (const Assignment& assignment : cell.assignments) {
        const std::string text = prefix + assignment.key + "=" + assignment.value;
        variant.set.push_back(text);
        remember(text, assignment.where, path + ".set");
      }
      if (!names_.insert(prefix + variant.name).second) {
        problems_.add(where, path,
                      "there are two variants called '" + variant.name +
                          "': a value is listed twice, or another entry has that name");
        return;
      }
      all.push_back(std::move(variant));
    }
  } catch (const ConfigError& error) {
    for (const Problem& problem : error.problems()) {
      problems_.add(problem);
    }
  }
}

Problem StudyVariants::placed(const Problem& problem) const {
  const auto found = assigned_at_.find(problem.where.override_text);
  if (problem.where.override_text.empty() || found == assigned_at_.end()) {
    return problem;
  }
  return {found->second.first, found->second.second, problem.key + ": " + problem.message};
}

StudyPlan read_study(const fs::path& study, StudyProblems& problems, StudyVariants& variants) {
  StudyPlan plan;
  plan.path = fs::absolute(study).lexically_normal();
  const Value tree = host::load_yaml(plan.path);
  if (tree.kind != Value::Kind::map || host::kind_of(tree) != host::FileKind::study) {
    throw ConfigError(tree.where, "", "expected a study: a file with 'scenarios' and 'pipelines'");
  }
  plan.text = flow_text(tree);
  plan.source = formats::read_file(plan.path.string());
  for (const Problem& problem : bind(plan.file, &tree).problems) {
    problems.add(problem);
  }
  problems.finish();
  read_scenarios(plan, tree, problems, variants);
  read_pipelines(plan, tree, problems, variants);
  problems.finish();
  check_metrics(plan, tree, problems);
  check_claims(plan, tree, problems);
  const Budget budget(plan.file.budget, host::place_of(tree, "budget"), problems, variants);
  for (Variant& pipeline : plan.pipelines) {
    budget.give(pipeline);
  }
  return plan;
}
}  // namespace altiplan::study
