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

/// The file of a variant as the study sets it; empty if it cannot be read, which is reported when
/// it is run.
Value tree_of(const Variant& variant, host::FileOfKey file) {
  try {
    Value tree = host::load_yaml(variant.file);
    host::apply_overrides(tree, variant.set, file);
    return tree;
  } catch (const ConfigError&) {
    return {};
  }
}

/// The budget as assignments to every plan step, so that `altiplan run --set` can repeat the run.
class Budget {
 public:
  Budget(const StudyBudget& budget, const Location& where, StudyProblems& problems,
         StudyVariants& variants)
      : budget_(budget), where_(where), problems_(problems), variants_(variants) {}

  void give(Variant& variant) const {
    if (budget_.time_s || budget_.iterations) {
      const Value tree = tree_of(variant, host::FileOfKey::pipeline);
      give_all(variant, tree.find("steps"), "steps");
    }
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

/// Each cell of `set` with each scenario of a published set, if there is one.
std::vector<GridCell> cells_of(const Value& set, const std::vector<host::SetScenario>& published,
                               const std::string& path) {
  const std::vector<GridCell> cells = grid_of(set, path + ".set");
  if (published.empty()) {
    return cells;
  }
  for (const Value::Entry& entry : set.entries) {
    for (const auto& [key, value] : published.front().set) {
      if ((key + ".").starts_with(entry.key + ".") || entry.key.starts_with(key + ".")) {
        throw ConfigError(entry.where, path + ".set." + entry.key,
                          "sets '" + key + "', which each scenario of 'from' does");
      }
    }
  }
  std::vector<GridCell> all;
  for (const host::SetScenario& scenario : published) {
    for (const GridCell& cell : cells) {
      all.push_back(
          {"[" + scenario.label + (cell.label.empty() ? "]" : "," + cell.label.substr(1)), {}});
      for (const auto& [key, value] : scenario.set) {
        all.back().assignments.push_back({key, value, "", set.where});
      }
      all.back().assignments.insert(all.back().assignments.end(), cell.assignments.begin(),
                                    cell.assignments.end());
    }
  }
  return all;
}

/// The chosen scenarios of the entry's published set; reports a problem if it cannot be read.
std::vector<host::SetScenario> published_by(const ScenarioChoice& entry, const Location& where,
                                            const std::string& path, StudyProblems& problems) {
  std::vector<host::SetScenario> chosen;
  try {
    std::vector<host::SetScenario> all = host::read_scenario_set(entry.from->text);
    for (std::size_t n = 0; n < all.size(); n += std::size_t(entry.every)) {
      chosen.push_back(std::move(all[n]));
    }
  } catch (const ConfigError&) {
    throw;
  } catch (const Error& error) {
    problems.add(where, path + ".from", error.what());
  }
  return chosen;
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
      const std::vector<host::SetScenario> published =
          entry.from ? published_by(entry, host::place_of(at, "from"), path, problems)
                     : std::vector<host::SetScenario>();
      variants.add(plan.scenarios, of, entry.file, entry.set, "scenario.", path, at.where,
                   published);
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

/// Gives every pipeline the metrics of the study, as assignments, so that `altiplan run --set` can
/// repeat the run.
class StudyMetrics {
 public:
  StudyMetrics(const StudyPlan& plan, const Value& tree, StudyVariants& variants,
               const std::vector<fs::path>& plugin_path)
      : file_(plan.file), tree_(tree), variants_(variants), plugin_path_(plugin_path) {}

  void give(Variant& variant) const {
    const Value tree = tree_of(variant, host::FileOfKey::pipeline);
    const Value* list = tree.find("metrics");
    std::size_t next = list != nullptr ? list->items.size() : 0;
    for (std::size_t i = 0; i < file_.metrics.size(); ++i) {
      const MetricChoice& metric = file_.metrics[i];
      if (metric.plugin.empty()) {
        continue;
      }
      const Value::Entry entry{metric.plugin, metric.parameters.where,
                               settled(tree, metric.plugin, metric.parameters)};
      const std::string key = host::item("metrics", next++);
      const std::string text = key + "={id: " + metric.name + ", " +
                               host::exact_json_text(entry.key) + ": " + flow_text(entry.value) +
                               "}";
      // An assignment adds an item to a list, not the list.
      if (list == nullptr && next == 1) {
        variant.set.push_back("metrics=[]");
      }
      variant.set.push_back(text);
      variants_.remember(text, tree_.find("metrics")->items[i].where, host::item("metrics", i));
    }
  }

 private:
  /// The parameters with absolute paths: those of a pipeline are relative to its own folder.
  Value settled(const Value& pipeline, const std::string& name, Value parameters) const {
    if (name == "weighted") {
      if (Value* of = parameters.find("of")) {
        for (Value& term : of->items) {
          for (Value::Entry& entry : term.entries) {
            if (entry.key != "weight") {
              entry.value = settled(pipeline, entry.key, entry.value);
            }
          }
        }
      }
      return parameters;
    }
    for (const BoundField& field : describe(pipeline, name, parameters).fields) {
      Value* path = parameters.find(field.spec.name);
      if (field.spec.type == FieldType::path && path != nullptr) {
        path->text = host::parse_yaml(field.value_json, "").text;
        path->quoted = true;
      }
    }
    return parameters;
  }

  ParamReport describe(const Value& pipeline, const std::string& name,
                       const Value& parameters) const {
    std::vector<fs::path> folders = plugin_path_;
    if (const Value* own = pipeline.find("plugins")) {
      for (const Value& folder : own->items) {
        folders.push_back(fs::path(pipeline.where.file).parent_path() / folder.text);
      }
    }
    try {
      host::Registry registry(host::Registry::search_path(folders));
      return host::plugin(registry, "objective", name).describe(&parameters, "");
    } catch (const Error&) {
      return {};  // reported when the pipeline is read
    }
  }

  const StudyFile& file_;
  const Value& tree_;
  StudyVariants& variants_;
  const std::vector<fs::path>& plugin_path_;
};

void check_metrics(const StudyPlan& plan, const std::vector<PipelineParts>& parts,
                   const Value& tree, StudyProblems& problems) {
  const std::vector<std::string> own = own_metrics(plan);
  for (std::size_t i = 0; i < plan.file.metrics.size(); ++i) {
    const Value& at = tree.find("metrics")->items[i];
    const std::string& name = plan.file.metrics[i].name;
    std::string why = why_no_value(name, own);
    why = why.empty() ? why_no_part(name, parts) : why;
    if (!why.empty()) {
      problems.add(host::place_of(at, "name"), host::item("metrics", i) + ".name", why);
    }
  }
}

void check_claims(const StudyPlan& plan, const std::vector<PipelineParts>& parts, const Value& tree,
                  StudyProblems& problems) {
  std::vector<std::string> names;
  for (const Variant& pipeline : plan.pipelines) {
    names.push_back(pipeline.name);
  }
  const std::vector<std::string> own = own_metrics(plan);
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
      std::string why = why_no_value(value.name, own);
      why = why.empty() ? why_no_part(value.name, {parts[value.pipeline]}) : why;
      if (!why.empty()) {
        problems.add(host::place_of(at, "that"), path + ".that", why);
      }
    }
  }
}
}  // namespace

void StudyVariants::add(std::vector<Variant>& all, const std::string& of, const Path& file,
                        const Value& set, const std::string& prefix, const std::string& path,
                        const Location& where, const std::vector<host::SetScenario>& published) {
  if (!ids_.insert(prefix + of).second) {
    problems_.add(where, path, "the name '" + of + "' is taken: give this entry another id");
    return;
  }
  if (const std::string twice = set_twice(set); !twice.empty()) {
    problems_.add(set.where, path + ".set", twice);
  }
  try {
    for (const GridCell& cell : cells_of(set, published, path)) {
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

std::vector<std::string> own_metrics(const StudyPlan& plan) {
  std::set<std::string> names;
  const auto add = [&](const std::vector<Variant>& variants, host::FileOfKey file) {
    std::set<std::string> seen;
    for (const Variant& variant : variants) {
      if (!seen.insert(variant.of).second) {
        continue;  // variants of one file differ in other keys
      }
      const Value tree = tree_of(variant, file);
      const Value* list = tree.find("metrics");
      for (std::size_t i = 0; list != nullptr && i < list->items.size(); ++i) {
        host::MetricEntry entry;
        bind(entry, &list->items[i]);
        names.insert(entry.id.empty() ? entry.plugin : entry.id);
      }
    }
  };
  add(plan.scenarios, host::FileOfKey::scenario);
  add(plan.pipelines, host::FileOfKey::pipeline);
  return {names.begin(), names.end()};
}

std::vector<PipelineParts> parts_of(const StudyPlan& plan) {
  std::vector<PipelineParts> all;
  for (const Variant& variant : plan.pipelines) {
    PipelineParts& parts = all.emplace_back();
    parts.name = variant.name;
    const Value tree = tree_of(variant, host::FileOfKey::pipeline);
    const Value* steps = tree.find("steps");
    parts.is_known = steps != nullptr && steps->kind == Value::Kind::list;
    host::Ids ids;
    const auto add = [&](const Value& at) {
      host::StepEntry step;
      parts.is_known = parts.is_known && bind(step, &at).problems.empty();
      parts.flies = parts.flies || step.verb == host::Verb::fly;
      const bool is_given = at.find("id") != nullptr;
      parts.steps.push_back(is_given ? step.id : ids.free_id(step.id));
      ids.insert(parts.steps.back());
    };
    for (std::size_t i = 0; parts.is_known && i < steps->items.size(); ++i) {
      add(steps->items[i]);
      const Value* others = steps->items[i].find("else");
      for (std::size_t k = 0; others != nullptr && k < others->items.size(); ++k) {
        add(others->items[k]);
      }
    }
  }
  return all;
}

StudyPlan read_study(const fs::path& study, StudyProblems& problems, StudyVariants& variants,
                     const std::vector<fs::path>& plugin_path) {
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
  const StudyMetrics metrics(plan, tree, variants, plugin_path);
  for (Variant& pipeline : plan.pipelines) {
    metrics.give(pipeline);
  }
  const std::vector<PipelineParts> parts = parts_of(plan);
  check_metrics(plan, parts, tree, problems);
  check_claims(plan, parts, tree, problems);
  const Budget budget(plan.file.budget, host::place_of(tree, "budget"), problems, variants);
  for (Variant& pipeline : plan.pipelines) {
    budget.give(pipeline);
  }
  return plan;
}
}  // namespace altiplan::study
