// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>

#include "host/base/input.hpp"
#include "host/base/words.hpp"
#include "host/config/config.hpp"
#include "host/config/config_check.hpp"
#include "host/config/yaml.hpp"
#include "host/plugins/registry.hpp"
#include "study/claims/claim_text.hpp"
#include "study/claims/claims.hpp"
#include "study/model/run_values.hpp"
#include "study/plan/study_reading.hpp"
#include "study/reproduce/figure_text.hpp"
#include "study/reproduce/paper.hpp"
#include "study/reproduce/paper_file.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> names_of(const std::vector<Variant>& variants) {
  std::vector<std::string> names;
  for (const Variant& variant : variants) {
    names.push_back(variant.name);
  }
  return names;
}

/// The text with the whole word ROW replaced.
std::string with_row(const std::string& text, const std::string& row) {
  constexpr std::string_view kRow = "ROW";
  const auto is_letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  std::string filled;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins = at == 0 || !is_letter(text[at - 1]);
    const std::size_t end = at + kRow.size();
    if (begins && text.compare(at, kRow.size(), kRow) == 0 &&
        (end == text.size() || !is_letter(text[end]))) {
      filled += row;
      at = end;
    } else {
      filled += text[at++];
    }
  }
  return filled;
}

/// Resolves a paper file, and collects its problems.
class Reading {
 public:
  Reading(const fs::path& file, const Value& tree) : tree_(tree) {
    for (const Problem& problem : bind(file_, &tree).problems) {
      problems_.add(problem);
    }
    problems_.finish();
    paper_.path = file;
    paper_.name = name_of(file);
    paper_.title = file_.title;
    paper_.page = file_.page;
  }

  Paper read() {
    for (std::size_t i = 0; i < file_.runs.size(); ++i) {
      add_runs(file_.runs[i], tree_.find("runs")->items[i], host::item("runs", i));
    }
    problems_.finish();
    for (std::size_t i = 0; i < file_.tables.size(); ++i) {
      add_table(file_.tables[i], tree_.find("tables")->items[i], host::item("tables", i));
    }
    problems_.finish();
    for (std::size_t i = 0; i < file_.runs.size(); ++i) {
      add_times(i, tree_.find("runs")->items[i], host::item("runs", i) + ".cpu_ms");
    }
    problems_.finish();
    return std::move(paper_);
  }

 private:
  void add_runs(const RunsChoice& entry, const Value& at, const std::string& path) {
    if (std::any_of(paper_.runs.begin(), paper_.runs.end(),
                    [&](const PaperRuns& other) { return other.id == entry.id; })) {
      problems_.add(host::place_of(at, "id"), path + ".id", "the id '" + entry.id + "' is taken");
    }
    paper_.runs.push_back({entry.id,
                           fs::absolute(entry.study.text).lexically_normal(),
                           entry.scenarios,
                           entry.quick,
                           0,
                           {}});
    const Location where = host::place_of(at, "study");
    if (const std::string why = host::file_problem(entry.study.text); !why.empty()) {
      problems_.add(where, path + ".study", why);
      return;
    }
    PaperRuns& runs = paper_.runs.back();
    if (!studies_.contains(runs.study)) {
      StudyProblems problems;
      StudyVariants variants(problems);
      studies_[runs.study] = read_study(runs.study, problems, variants, {});
      problems.finish();
    }
    const StudyPlan& study = studies_.at(runs.study);
    std::vector<std::string> known;
    std::size_t scenarios = 0;
    for (const Variant& scenario : study.scenarios) {
      known.push_back(scenario.of);
      scenarios += entry.scenarios.empty() || scenario.of == entry.scenarios;
    }
    if (scenarios == 0) {
      problems_.add(host::place_of(at, "scenarios"), path + ".scenarios",
                    "the study has no scenarios " + excerpt(entry.scenarios) +
                        host::did_you_mean(entry.scenarios, known));
    }
    runs.pairs = scenarios * std::size_t(study.file.repetitions);
  }

  void add_table(const PaperTable& table, const Value& at, const std::string& path) {
    const auto runs = std::find_if(paper_.runs.begin(), paper_.runs.end(),
                                   [&](const PaperRuns& one) { return one.id == table.runs; });
    if (runs == paper_.runs.end()) {
      std::vector<std::string> known;
      for (const PaperRuns& one : paper_.runs) {
        known.push_back(one.id);
      }
      problems_.add(
          host::place_of(at, "runs"), path + ".runs",
          "there are no runs " + excerpt(table.runs) + host::did_you_mean(table.runs, known));
      return;
    }
    ReproducibleRow row;
    row.heading = table.heading;
    row.source = table.source;
    row.runs = std::size_t(runs - paper_.runs.begin());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      row.id = table.rows[i].id;
      row.what = table.rows[i].what;
      add_row(row, table, i, at, path);
    }
    for (std::size_t i = 0; i < table.claims.size(); ++i) {
      row.id = table.claims[i].id;
      row.what = table.claims[i].what;
      add_claim(row, table.claims[i], at.find("claims")->items[i], host::item(path + ".claims", i));
    }
  }

  void add_row(ReproducibleRow row, const PaperTable& table, std::size_t index,
               const Value& table_at, const std::string& table_path) {
    const PaperRow& entry = table.rows[index];
    const Value& at = table_at.find("rows")->items[index];
    const Value& columns = *table_at.find("columns");
    const std::string path = host::item(table_path + ".rows", index);
    check_id(entry.id, at, path);
    if (std::all_of(entry.documentation.begin(), entry.documentation.end(),
                    [](const std::string& text) { return text.empty(); })) {
      problems_.add(host::place_of(at, "documentation"), path + ".documentation",
                    "expected at least one figure, found none");
    }
    for (const auto& [list, key] :
         {std::pair(&entry.paper, "paper"), std::pair(&entry.documentation, "documentation")}) {
      if (list->size() > table.columns.size()) {
        problems_.add(host::place_of(at, key), path + "." + key,
                      "expected at most " + std::to_string(table.columns.size()) +
                          " figures, one for each column, found " + std::to_string(list->size()));
      }
    }
    for (std::size_t c = 0; c < std::min(table.columns.size(), entry.documentation.size()); ++c) {
      PaperFigure figure;
      figure.name = table.columns[c].name;
      figure.claim = {entry.id + " " + figure.name,
                      with_row(table.columns[c].of, entry.row.empty() ? entry.id : entry.row),
                      "== 0", kSampleConfidence};
      figure.paper = c < entry.paper.size() ? entry.paper[c] : "";
      figure.documentation = entry.documentation[c];
      if (figure.documentation.empty()) {
        continue;
      }
      check_printed(figure.documentation, at.find("documentation")->items[c].where,
                    host::item(path + ".documentation", c));
      add_figure(row, figure, host::place_of(columns.items[c], "of"),
                 host::item(table_path + ".columns", c) + ".of");
    }
    paper_.rows.push_back(std::move(row));
  }

  void add_claim(ReproducibleRow row, const PaperClaim& entry, const Value& at,
                 const std::string& path) {
    check_id(entry.id, at, path);
    const std::string id = entry.claim.empty() ? entry.id : entry.claim;
    const std::string key = entry.claim.empty() ? "id" : "claim";
    const StudyPlan& study = studies_.at(paper_.runs[row.runs].study);
    const auto claim = std::find_if(study.file.claims.begin(), study.file.claims.end(),
                                    [&](const ClaimEntry& one) { return one.id == id; });
    if (claim == study.file.claims.end()) {
      std::vector<std::string> known;
      for (const ClaimEntry& one : study.file.claims) {
        known.push_back(one.id);
      }
      problems_.add(host::place_of(at, key), path + "." + key,
                    "the study has no claim " + excerpt(id) + host::did_you_mean(id, known));
      return;
    }
    PaperFigure figure{"verdict", *claim, true, true, entry.paper, entry.verdict};
    add_figure(row, figure, at.where, path);
    if (!entry.measured.empty()) {
      check_printed(entry.measured, host::place_of(at, "measured"), path + ".measured");
      figure = {"measured", *claim, true, false, "", entry.measured};
      add_figure(row, figure, at.where, path);
    }
    paper_.rows.push_back(std::move(row));
  }

  void check_id(const std::string& id, const Value& at, const std::string& path) {
    if (!host::is_snake_case(id)) {
      problems_.add(host::place_of(at, "id"), path + ".id",
                    "expected lower-case letters, digits and '_', starting with a letter, found " +
                        excerpt(id));
    } else if (!ids_.insert(id).second) {
      problems_.add(host::place_of(at, "id"), path + ".id", "the id '" + id + "' is taken");
    }
  }

  void check_printed(const std::string& text, const Location& where, const std::string& key) {
    if (!read_figure(text)) {
      problems_.add(where, key,
                    "expected a figure as 303, 1,231, 0.45, 92.6 %, 54/100, or with an interval as "
                    "0.674 [0.631, 0.722], found " +
                        excerpt(text));
    }
  }

  /// Checks the quantity, and notes the pipelines that it names.
  void add_figure(ReproducibleRow& row, const PaperFigure& figure, const Location& where,
                  const std::string& key) {
    const StudyPlan& study = studies_.at(paper_.runs[row.runs].study);
    const std::vector<std::string> pipelines = names_of(study.pipelines);
    const std::vector<std::string> own = own_metrics(study);
    const std::string of = "of row '" + row.id + "': " + figure.claim.that + ": ";
    try {
      for (const ClaimValue& value : read_quantity(figure.claim.that, pipelines).values) {
        row.pipelines.insert(pipelines[value.pipeline]);
        if (const std::string why = why_no_value(value.name, own); !why.empty()) {
          problems_.add(where, key, of + why);
        }
      }
      row.figures.push_back(figure);
    } catch (const Error& error) {
      problems_.add(where, key, of + error.what());
    }
  }

  void add_times(std::size_t index, const Value& at, const std::string& path) {
    PaperRuns& runs = paper_.runs[index];
    const Value& times = file_.runs[index].cpu_ms;
    std::set<std::string> needed;
    for (const ReproducibleRow& row : paper_.rows) {
      if (row.runs == index) {
        needed.insert(row.pipelines.begin(), row.pipelines.end());
      }
    }
    for (const Value::Entry& entry : times.entries) {
      double ms = 0;
      const std::string& text = entry.value.text;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ms);
      if (error != std::errc() || end != text.data() + text.size() || !(ms > 0) || ms > 1e9) {
        problems_.add(entry.value.where, path + "." + entry.key,
                      "expected a time above 0 (ms), found " + entry.value.what());
      }
      if (needed.erase(entry.key) == 0) {
        problems_.add(entry.where, path + "." + entry.key,
                      "no row names this pipeline of the study, so it is not run");
      }
      runs.cpu_ms[entry.key] = ms;
    }
    if (times.entries.empty()) {
      return;  // what they take is not told
    }
    for (const std::string& pipeline : needed) {
      problems_.add(host::place_of(at, "cpu_ms"), path,
                    "the time of the pipeline '" + pipeline + "' is missing");
    }
  }

  const Value& tree_;
  PaperFile file_;
  Paper paper_;
  StudyProblems problems_;
  std::map<fs::path, StudyPlan> studies_;
  std::set<std::string> ids_;
};
}  // namespace

Paper read_paper(const fs::path& file) {
  const fs::path path = fs::absolute(file).lexically_normal();
  const Value tree = host::load_yaml(path);
  if (tree.kind != Value::Kind::map || host::kind_of(tree) != host::FileKind::paper) {
    throw ConfigError(tree.where, "", "expected a paper: a file with 'runs' and 'tables'");
  }
  return Reading(path, tree).read();
}
}  // namespace altiplan::study
