// SPDX-License-Identifier: Apache-2.0
#include "study/report/report.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/output_file.hpp"
#include "host/base/program.hpp"
#include "study/figures/text.hpp"
#include "study/report/page.hpp"
#include "study/store/load_study.hpp"

namespace altiplan::study::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "<meta name=\"generator\" content=\"altiplan report\">";

std::vector<FailureGroup> failures_of(const StudyData& data) {
  std::map<std::tuple<std::size_t, std::string, std::string>, FailureGroup> groups;
  for (std::size_t at = 0; at < data.rows.size(); ++at) {
    const RunRow& row = data.rows[at];
    if (unexplained(row.outcome)) {
      FailureGroup& group = groups[{row.pipeline, row.outcome, row.message}];
      group.pipeline = row.pipeline;
      group.outcome = row.outcome;
      group.message = row.message;
      group.rows.push_back(at);
    }
  }
  std::vector<FailureGroup> all;
  for (auto& [key, group] : groups) {
    all.push_back(std::move(group));
  }
  std::stable_sort(all.begin(), all.end(), [](const FailureGroup& a, const FailureGroup& b) {
    return a.rows.size() > b.rows.size();
  });
  return all;
}

/// From one result for each pipeline and each scenario file.
Builds builds_of(const StudyData& data, const ResultSource& results) {
  std::set<std::pair<std::size_t, std::string>> seen;
  std::set<std::string> versions;
  std::set<std::vector<std::string>> plugins;
  for (const RunRow& row : data.rows) {
    const auto kind = std::pair(row.pipeline, data.scenarios[row.scenario].of);
    if (seen.count(kind) > 0) {
      continue;
    }
    const host::Json json = host::json_or_discarded(results(row));
    if (!json.is_object() || !json.contains("version") || !json.contains("plugins")) {
      continue;
    }
    seen.insert(kind);
    versions.insert(json.value("version", ""));
    for (const host::Json& plugin : json.at("plugins")) {
      if (plugin.is_object()) {
        plugins.insert(
            {plugin.value("kind", ""), plugin.value("name", ""), plugin.value("build", "")});
      }
    }
  }
  return {{versions.begin(), versions.end()}, {plugins.begin(), plugins.end()}};
}

void take_claims(Content& content) {
  for (JudgedClaim& judged : judge_claims(content.data)) {
    if (judged.measured && !content.times) {
      content.claims_left_out.push_back("The claim '" + judged.claim.id +
                                        "' is about measured times or memory, and is omitted.");
    } else {
      content.claims.push_back(std::move(judged));
    }
  }
  adjust(content.claims);  // the others vary between equal runs
}

void draw(Content& content) {
  const StudyData& data = content.data;
  content.success_figures = {success_figure(data, content.analysis),
                             outcome_figure(data, content.analysis)};
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    std::vector<Figure> figures{box_figure(data, metric)};
    if (!metric.comparisons.empty()) {
      figures.push_back(comparison_figure(data, metric));
    }
    if (auto ranks = rank_figure(data, metric)) {
      figures.push_back(std::move(*ranks));
    }
    if (auto profile = profile_figure(data, metric)) {
      figures.push_back(std::move(*profile));
    }
    content.metric_figures.push_back(std::move(figures));
  }
  for (const Trade& trade : content.analysis.trades) {
    content.trade_figures.push_back(pareto_figure(data, trade));
  }
  for (const char* effort : {"plan_time_s", "expanded"}) {
    if (auto figure = effort_figure(data, effort)) {
      content.effort_figures.push_back(std::move(*figure));
    }
  }
  for (const bool by_evaluations : {false, true}) {
    if (auto figure = anytime_figure(data, content.anytime, by_evaluations)) {
      content.anytime_figures.push_back(std::move(*figure));
    }
  }
  std::set<std::string> names;
  for (const Convergence& convergence : content.convergence) {
    if (names.size() < kMaxConvergence) {
      content.convergence_figures.push_back(convergence_figure(data, convergence));
      std::string& name = content.convergence_figures.back().name;
      while (!names.insert(name).second) {
        name += "-2";
      }
    }
  }
}

Content content_of(const Source& source, const Options& options) {
  Content content;
  content.times = options.times;
  content.data = in_order(source.data, options.times);
  options.begins("judging the claims");
  take_claims(content);
  content.absent = take_absent(content.data);
  content.short_names = short_names(content.data);
  content.title = printable(options.title.empty() ? content.data.file.name : options.title);
  content.title = content.title.empty() ? "Study" : content.title;
  content.command = options.command;
  content.study_text = source.study_text;
  options.begins("comparing the pipelines");
  content.analysis = analyse(content.data, options.times);
  content.failures = failures_of(content.data);
  content.convergence = convergence_of(content.data, source.traces);
  if (content.times) {
    content.anytime = anytime_of(content.data, source.traces);
  }
  draw(content);
  content.builds = builds_of(content.data, source.results);
  SceneOptions scenes = options.scenes;
  scenes.times = options.times;
  scenes.begins = options.begins;
  content.scenes = build_scenes(content.data, content.analysis, source.results, scenes);
  return content;
}

std::vector<Figure> all_figures(const Content& content) {
  std::vector<Figure> all = content.success_figures;
  for (const auto& figures : content.metric_figures) {
    all.insert(all.end(), figures.begin(), figures.end());
  }
  all.insert(all.end(), content.trade_figures.begin(), content.trade_figures.end());
  all.insert(all.end(), content.effort_figures.begin(), content.effort_figures.end());
  all.insert(all.end(), content.anytime_figures.begin(), content.anytime_figures.end());
  all.insert(all.end(), content.convergence_figures.begin(), content.convergence_figures.end());
  return all;
}

void write_tables(const Content& content, const fs::path& folder) {
  std::vector<Table> tables{success_table(content), metric_table(content), claim_table(content)};
  if (content.data.pipelines.size() > 1) {
    tables.push_back(success_comparison_table(content));
    tables.push_back(common_table(content));
    for (const MetricAnalysis& metric : content.analysis.metrics) {
      tables.push_back(comparison_table(content, metric));
    }
  }
  for (const Trade& trade : content.analysis.trades) {
    tables.push_back(pareto_table(content, trade));
  }
  if (content.times && content.data.file.budget.time_s) {
    tables.push_back(par_table(content));
  }
  if (!content.anytime.empty()) {
    tables.push_back(anytime_table(content));
  }
  if (!content.convergence.empty()) {
    tables.push_back(convergence_table(content));
  }
  for (Table& table : tables) {
    table.note = incomplete(content.data);
    host::write_file(folder / (table.name + ".md"), markdown_text(table));
    host::write_file(folder / (table.name + ".tex"), latex_text(table));
    host::write_file(folder / (table.name + ".csv"), csv_text(number_grid(table)));
  }
  host::write_file(folder / "scenarios.csv", csv_text(number_grid(scenario_table(content))));
}

/// Unlike fs::create_directories it does not check for existence, which fails for inaccessible
/// folders.
void make_folder(const fs::path& folder) {
  int error = ::mkdir(folder.c_str(), 0777) == 0 ? 0 : errno;
  if (error == ENOENT && folder.has_relative_path()) {
    make_folder(folder.parent_path());
    error = ::mkdir(folder.c_str(), 0777) == 0 ? 0 : errno;
  }
  if (error != 0 && error != EEXIST) {
    throw fs::filesystem_error("mkdir", folder, std::error_code(error, std::generic_category()));
  }
}

/// Embeds the fonts of this machine, and has no date.
void write_pdf(const fs::path& to_pdf, const fs::path& svg) {
  const host::TemporaryFolder temporary;
  const fs::path errors = temporary.path() / "errors";
  const host::Program converter(
      {"/usr/bin/env", "SOURCE_DATE_EPOCH=0", to_pdf.string(), "-f", "pdf", "-o",
       fs::path(svg).replace_extension(".pdf").string(), svg.string()},
      {{}, errors});
  if (converter.ended(host::Program::Clock::now() + std::chrono::minutes(1)) != 0) {
    std::string why;
    std::getline(std::ifstream(errors), why);
    throw Error("--pdf: '" + to_pdf.string() + "' failed for " + svg.filename().string() +
                (why.empty() ? "" : ": " + printable(why)));
  }
}

void write_parts(const Content& content, const Options& options, const std::string& page,
                 const fs::path& folder) {
  make_folder(folder / "figures");
  make_folder(folder / "tables");
  for (const Figure& figure : all_figures(content)) {
    const fs::path svg = folder / "figures" / (figure.name + ".svg");
    host::write_file(svg, svg_text(figure, false));
    if (!options.to_pdf.empty()) {
      write_pdf(options.to_pdf, svg);
    }
    host::write_file(folder / "figures" / (figure.name + ".csv"), csv_text(figure.numbers));
  }
  write_tables(content, folder / "tables");
  host::write_file(folder / "runs.csv", csv_text(run_grid(content)));
  host::write_file(folder / "index.html", page);
}

/// Exchanges the two, also if one does not exist; a second call restores the original state.
void exchange(const fs::path& a, const fs::path& b) {
  if (!fs::exists(b)) {
    fs::rename(a, b);
  } else if (!fs::exists(a)) {
    fs::rename(b, a);
  } else if (::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) != 0) {
    if (errno != EINVAL && errno != ENOSYS) {
      throw fs::filesystem_error("rename", b, std::error_code(errno, std::generic_category()));
    }
    const fs::path aside = a.string() + ".earlier";  // a file system without exchange
    fs::rename(b, aside);
    fs::rename(a, b);
    fs::rename(aside, a);
  }
}

/// Removes an earlier report once the new one is complete.
void put_in_place(const fs::path& beside, const fs::path& folder) {
  const auto lock = host::uninterrupted();
  std::vector<const char*> done;
  try {
    for (const char* part : {"figures", "tables", "runs.csv", "index.html"}) {
      exchange(beside / part, folder / part);
      done.push_back(part);
    }
  } catch (const fs::filesystem_error&) {
    for (const char* part : done) {
      exchange(beside / part, folder / part);
    }
    throw;
  }
}

bool is_report(const fs::path& folder) {
  const std::string file = (folder / "index.html").string();
  if (!fs::is_regular_file(host::status_of(file))) {
    return false;
  }
  formats::InputFile page(file);
  std::string start(1000, '\0');
  page.read(start.data(), std::streamsize(start.size()));
  return start.find(kMark) != std::string::npos;
}
}  // namespace

void expect_report_folder(const fs::path& folder) {
  const fs::file_status status = host::status_of(folder);
  if (!fs::exists(status)) {
    return;
  }
  if (!fs::is_directory(status)) {
    throw Error("-o: '" + folder.string() + "' is a file, expected a folder");
  }
  if (!fs::is_empty(folder) && !is_report(folder)) {
    throw Error("-o: '" + folder.string() +
                "' contains other files, expected a new folder or that of an earlier report");
  }
}

Source load_source(const std::vector<std::string>& stores) {
  Source source;
  source.data = load_study_data(stores);
  auto open = std::make_shared<std::vector<std::unique_ptr<Store>>>();
  for (const std::string& store : stores) {
    open->push_back(std::make_unique<Store>(store, StoreMode::read));
  }
  source.study_text = open->front()->study()["text"];
  source.results = [open](const RunRow& row) {
    const auto run = open->at(row.store)->run(row.id);
    return run ? run->result : std::string();
  };
  source.traces = [open](const RunRow& row) { return open->at(row.store)->trace(row.id); };
  return source;
}

Written write_report(const Source& source, const Options& options, const fs::path& folder) {
  expect_report_folder(folder);
  const Content content = content_of(source, options);
  options.begins("writing the report");
  const std::string page = page_text(content);
  const fs::path beside = host::name_beside(fs::absolute(folder) / "report");
  // Replaced files are no longer in it, and the folder is removed if nothing was replaced.
  const host::Unfinished unfinished([beside] {
    std::error_code error;
    constexpr int kTries = 8;  // an inaccessible folder cannot be emptied
    for (int tries = 0; tries == 0 || (error && tries < kTries); ++tries) {
      fs::remove_all(beside, error);
    }
    fs::remove(beside.parent_path(), error);
  });
  try {
    write_parts(content, options, page, beside);
    put_in_place(beside, folder);
  } catch (const fs::filesystem_error& error) {
    throw Error("-o: cannot write into '" + folder.string() + "': " + error.code().message());
  }
  Written written;
  written.page_bytes = page.size();
  written.figures = all_figures(content).size();
  written.scenes = content.scenes.scenes.size();
  written.notes = content.scenes.notes;
  written.changed = content.scenes.changed;
  written.lacking = lacking(content);
  const std::string part = incomplete(content.data);
  written.summary = (part.empty() ? "" : part + " ") + summary(content);
  return written;
}
}  // namespace altiplan::study::report
