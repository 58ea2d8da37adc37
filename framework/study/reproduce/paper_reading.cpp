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
    for (const auto& [key, text] : {std::pair("title", &file_.title), {"page", &file_.page}}) {
      if (*text && (*text)->empty()) {
        problems_.add(host::place_of(tree, key), key,
                      "is empty: give the " + std::string(key) + ", or leave the key out");
      }
    }
    paper_.path = file;
    paper_.name = name_of(file);
    paper_.title = file_.title.value_or("");
    paper_.page = file_.page.value_or("");
  }

  Paper read() {
    for (std::size_t i = 0; i < file_.runs.size(); ++i) {
      add_runs(file_.runs[i], tree_.find("runs")->items[i], host::item("runs", i));
    }
    for (std::size_t i = 0; i < file_.tables.size(); ++i) {
      add_table(file_.tables[i], tree_.find("tables")->items[i], host::item("tables", i));
    }
    are_rows_known_ = problems_.empty();
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
      try {
        StudyProblems problems;
        StudyVariants variants(problems);
        StudyPlan plan = read_study(runs.study, problems, variants, {});
        problems.finish();
        parts_[runs.study] = parts_of(plan);
        studies_[runs.study] = std::move(plan);
      } catch (const ConfigError& error) {
        for (const Problem& problem : error.problems()) {
          problems_.add(problem);
        }
        return;
      }
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
    if (!studies_.contains(runs->study)) {
      return;  // reported
    }
    check_columns(table, studies_.at(runs->study), at, path);
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
    check_lists(entry, table.columns.size(), at, path);
    const std::string text = entry.row.empty() ? entry.id : entry.row;
    const std::string key = entry.row.empty() ? "id" : "row";
    const std::string unknown = why_no_pipeline(table, text, row.runs);
    if (!unknown.empty()) {
      problems_.add(host::place_of(at, key), path + "." + key, unknown);
    }
    const std::size_t shown = entry.documentation
                                  ? std::min(table.columns.size(), entry.documentation->size())
                                  : table.columns.size();
    for (std::size_t c = 0; c < shown; ++c) {
      PaperFigure figure;
      figure.name = table.columns[c].name;
      figure.claim = {entry.id + " " + figure.name, with_row(table.columns[c].of, text), "== 0",
                      kSampleConfidence};
      figure.paper = c < entry.paper.size() ? entry.paper[c] : "";
      figure.documentation = entry.documentation ? (*entry.documentation)[c] : "";
      if (entry.documentation && figure.documentation.empty()) {
        continue;
      }
      if (entry.documentation) {
        check_printed(figure.documentation, at.find("documentation")->items[c].where,
                      host::item(path + ".documentation", c));
      }
      if (unknown.empty() && !wrong_columns_.contains(&table.columns[c])) {
        add_figure(row, figure, host::place_of(columns.items[c], "of"),
                   host::item(table_path + ".columns", c) + ".of");
      }
    }
    paper_.rows.push_back(std::move(row));
  }

  /// Reports columns that have another word where ROW was meant, once for all rows.
  void check_columns(const PaperTable& table, const StudyPlan& study, const Value& at,
                     const std::string& path) {
    std::vector<std::string> names = names_of(study.pipelines);
    names.emplace_back("ROW");
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const PaperColumn& column = table.columns[c];
      try {
        read_quantity(column.of, names);
      } catch (const Error& error) {
        const std::string why = error.what();
        if (why.ends_with("did you mean 'ROW'?")) {
          problems_.add(host::place_of(at.find("columns")->items[c], "of"),
                        host::item(path + ".columns", c) + ".of", column.of + ": " + why);
          wrong_columns_.insert(&column);
        }
      }
    }
  }

  /// The error message for a row that stands for a pipeline and is none of the study; "" otherwise.
  std::string why_no_pipeline(const PaperTable& table, const std::string& row, std::size_t runs) {
    if (std::none_of(table.columns.begin(), table.columns.end(), [](const PaperColumn& column) {
          return with_row(column.of, "ROW").find("ROW.") != std::string::npos;
        })) {
      return "";
    }
    try {
      read_quantity("share(" + row + ".solved)",
                    names_of(studies_.at(paper_.runs[runs].study).pipelines));
    } catch (const Error& error) {
      const std::string why = error.what();  // "at character 7: …"
      return why.substr(why.find(": ") + 2);
    }
    return "";
  }

  void check_lists(const PaperRow& entry, std::size_t columns, const Value& at,
                   const std::string& path) {
    const std::size_t documented = entry.documentation ? entry.documentation->size() : columns;
    if (entry.documentation && std::all_of(entry.documentation->begin(), entry.documentation->end(),
                                           [](const std::string& text) { return text.empty(); })) {
      problems_.add(host::place_of(at, "documentation"), path + ".documentation",
                    "has no figure: give at least one, or leave the key out to compare none");
    } else if (documented > columns) {
      problems_.add(host::place_of(at, "documentation"), path + ".documentation",
                    "expected at most " + std::to_string(columns) +
                        " figures, one for each column, found " + std::to_string(documented));
    }
    const std::size_t needed = std::min(documented, columns);
    if (!entry.paper.empty() && (entry.paper.size() < needed || entry.paper.size() > columns)) {
      problems_.add(host::place_of(at, "paper"), path + ".paper",
                    "expected " + std::to_string(needed) +
                        " figures, one for each column, \"\" where the paper prints nothing; "
                        "found " +
                        std::to_string(entry.paper.size()));
    }
    for (std::size_t c = 0; c < entry.paper.size(); ++c) {
      const Value& cell = at.find("paper")->items[c];
      const bool is_words = cell.quoted && entry.paper[c].find_first_of("0123456789") != 0;
      if (!is_words) {
        check_printed(entry.paper[c], cell.where, host::item(path + ".paper", c));
      }
    }
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
    }
    if (!entry.measured.empty() || entry.verdict.empty()) {
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
        std::string why = why_no_value(value.name, own);
        why = why.empty() ? why_no_part(value.name, {parts_.at(study.path)[value.pipeline]}) : why;
        if (!why.empty()) {
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
      if (are_rows_known_ && needed.erase(entry.key) == 0) {
        const std::string near = nearest_name(entry.key, {needed.begin(), needed.end()});
        problems_.add(entry.where, path + "." + entry.key,
                      "no row names the pipeline " + excerpt(entry.key) +
                          (near.empty() ? ", so it is not run" : "; did you mean '" + near + "'?"));
        needed.erase(near);
      }
      runs.cpu_ms[entry.key] = ms;
    }
    if (times.entries.empty() || !are_rows_known_) {
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
  std::map<fs::path, std::vector<PipelineParts>> parts_;  ///< by study
  std::set<std::string> ids_;
  std::set<const PaperColumn*> wrong_columns_;  ///< reported
  bool are_rows_known_ = false;                 ///< no problem in runs and tables
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
