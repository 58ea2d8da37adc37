// SPDX-License-Identifier: Apache-2.0
#include "study/report/page.hpp"

#include <algorithm>

#include "host/view/viewer_page.hpp"
#include "study/figures/text.hpp"
#include "study/report/packed.hpp"
#include "study/report/page_assets.hpp"

namespace altiplan::study::report {
namespace {

std::string paragraph(const std::string& text, const char* kind = "") {
  return std::string("<p") + (*kind != '\0' ? std::string(" class=\"") + kind + "\"" : "") + ">" +
         html(text) + "</p>\n";
}

std::string section(const char* id, const std::string& title, const std::string& body) {
  return std::string("<section id=\"") + id + "\"><h2>" + html(title) + "</h2>\n" + body +
         "</section>\n";
}

std::string folded(const std::string& title, const std::string& body) {
  return "<details><summary>" + html(title) + "</summary>\n" + body + "</details>\n";
}

std::string figure_html(const Figure& figure) {
  return "<figure id=\"" + figure.name + "\"><h4>" + html(figure.title) + "</h4>\n" +
         svg_text(figure, true) + "<figcaption>" + html(figure.caption) +
         " <span class=files><a href=\"figures/" + figure.name +
         ".svg\">SVG</a> <a href=\"figures/" + figure.name +
         ".csv\">CSV</a></span></figcaption></figure>\n";
}

std::string figures_html(const std::vector<Figure>& figures) {
  std::string out = "<div class=figures>\n";
  for (const Figure& figure : figures) {
    out += figure_html(figure);
  }
  return out + "</div>\n";
}

/// Long tables are folded, so that the page can be read through.
std::string table_html(const Table& table, std::size_t open_rows = 12) {
  return table.rows.size() <= open_rows
             ? html_text(table)
             : folded(table.caption + " (" + counted(table.rows.size(), "row") + ")",
                      html_text(table));
}

/// The warnings shown before any number.
std::string incomplete_html(const Content& content) {
  const std::string part = incomplete(content.data);
  std::string text = part.empty() ? "" : "<b>" + html(part) + "</b>";
  for (const std::string& sentence : lacking(content)) {
    text += (text.empty() ? "" : " ") + html(sentence);
  }
  if (!part.empty()) {
    text +=
        " <code>altiplan study</code> without a selection runs what is left, and "
        "<code>altiplan report</code> combines shards.";
  }
  return text.empty() ? "" : "<p class=notice>" + text + "</p>\n";
}

/// With the result of a comparison next to its pipelines, so that it stays visible on a narrow
/// screen.
Table verdict_first(Table table) {
  std::size_t to = 2;
  for (const char* title : {"better", "p (Holm)"}) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                    [&](const Column& column) { return column.title == title; });
    const std::ptrdiff_t from = found - table.columns.begin();
    if (found == table.columns.end() || from < std::ptrdiff_t(to)) {
      continue;
    }
    const auto move = [&](auto& cells) {
      std::rotate(cells.begin() + std::ptrdiff_t(to), cells.begin() + from,
                  cells.begin() + from + 1);
    };
    move(table.columns);
    std::for_each(table.rows.begin(), table.rows.end(), move);
    ++to;
  }
  return table;
}

std::string failures_html(const Content& content) {
  if (content.failures.empty()) {
    return paragraph("None: every run that did not solve has a reason.", "good");
  }
  std::size_t runs = 0;
  for (const FailureGroup& group : content.failures) {
    runs += group.rows.size();
  }
  return paragraph(counted(runs, "run") +
                       " ended by a fault of a plugin or its build, not because of the problem.",
                   "bad") +
         table_html(failure_table(content), 20);
}

std::string claims_html(const Content& content) {
  if (content.claims.empty() && content.claims_left_out.empty()) {
    return paragraph("The study has no claims.", "quiet");
  }
  std::string out;
  for (const std::string& sentence : common_reasons(content.claims)) {
    out += paragraph(sentence);
  }
  if (const std::string all = multiplicity(content.claims); !all.empty()) {
    out += paragraph(all);
  }
  std::string list;
  for (const JudgedClaim& judged : content.claims) {
    if (judged.lacks_runs) {
      continue;
    }
    static constexpr const char* kKinds[] = {"good", "bad", "open", "open"};
    list += std::string("<li class=\"") + kKinds[int(judged.verdict)] + "\"><div class=head><b>" +
            html(judged.claim.id) + "</b> <span class=verdict>" +
            html(std::string(name_of(judged.verdict))) + "</span></div><code>" +
            html(judged.claim.that) + " " + html(wanted(judged.claim)) + "</code>" +
            paragraph(judged.reasons) + "</li>\n";
  }
  out += list.empty() ? "" : "<ul class=claims>\n" + list + "</ul>\n";
  for (const std::string& line : content.claims_left_out) {
    out += paragraph(line, "quiet");
  }
  return out;
}

/// The meaning of the values in brackets.
std::string short_names_html(const Content& content) {
  std::string keys;
  for (const std::string& line : short_name_keys(content.data)) {
    keys += (keys.empty() ? "" : ", ") + line;
  }
  return keys.empty() ? ""
                      : paragraph("Variants are named by their values: " + keys + ".", "quiet");
}

std::string success_html(const Content& content) {
  std::string out = short_names_html(content) + figures_html(content.success_figures) +
                    table_html(success_table(content), 30);
  if (content.data.pipelines.size() > 1) {
    out += table_html(verdict_first(success_comparison_table(content)));
  }
  return out;
}

std::string metric_html(const Content& content, std::size_t at) {
  const MetricAnalysis& metric = content.analysis.metrics[at];
  std::string out = "<h3 id=\"metric-" + slug(metric.metric) + "\">" +
                    html(metric_title(metric.metric)) + " <small>" + html(metric.metric) + ", " +
                    (metric.better == Better::lower ? "lower" : "higher") +
                    " is better</small></h3>\n";
  out += figures_html(content.metric_figures[at]);
  if (!metric.comparisons.empty()) {
    out += table_html(verdict_first(comparison_table(content, metric)));
  }
  return out;
}

std::string convergence_html(const Content& content) {
  const std::size_t more = content.convergence.size() - content.convergence_figures.size();
  return figures_html(content.convergence_figures) +
         (more == 0 ? "" : paragraph(counted(more, "more figure") + " left out.", "quiet")) +
         table_html(convergence_table(content), 30);
}

std::string scenarios_html(const Table& table) {
  std::string out = html_text(table, kRowsShown);
  if (table.rows.size() > kRowsShown) {
    out += "<p><button type=button id=more hidden>Show all " + grouped(table.rows.size()) +
           "</button> " + std::to_string(kRowsShown) + " of " +
           counted(table.rows.size(), "scenario") +
           "; <a href=\"tables/scenarios.csv\">tables/scenarios.csv</a> has all.</p>\n";
  }
  return out +
         "<p class=quiet>Every run with all its values is in <a "
         "href=\"runs.csv\">runs.csv</a>.</p>\n";
}

std::string method_html(const Content& content) {
  std::string out;
  for (const std::string& text : method_text(content)) {
    out += paragraph(text);
  }
  for (const std::string& change : content.scenes.changed) {
    out += paragraph(change, "bad");
  }
  if (!content.scenes.notes.empty()) {
    std::string lines = "<ul>\n";
    for (const std::string& note : content.scenes.notes) {
      lines += "<li>" + html(note) + "</li>\n";
    }
    out += folded("Scenes that could not be built (" + grouped(content.scenes.notes.size()) + ")",
                  lines + "</ul>\n");
  }
  return out;
}

std::string origin_html(const Content& content) {
  std::string out = table_html(pipeline_table(content), 30);
  std::string versions;
  for (const std::string& version : content.builds.versions) {
    versions += (versions.empty() ? "" : ", ") + version;
  }
  out += paragraph("Random seed of the study: " + std::to_string(content.data.file.seed) +
                   (versions.empty() ? "" : "; altiplan " + versions) + ".");
  if (content.times && !content.data.sessions.empty()) {
    out += table_html(session_table(content), 6);
  }
  if (!content.builds.plugins.empty()) {
    out += table_html(build_table(content), 6);
  }
  out += "<p>This page was made by</p><pre class=command>" + html(content.command) + "</pre>\n";
  return out + folded("The study's file", "<pre>" + html_lines(content.study_text) + "</pre>\n");
}

std::string contents_html(const Content& content) {
  std::string out =
      "<nav aria-label=Contents><a href=\"#failures\">Failures</a><a "
      "href=\"#claims\">Claims</a><a href=\"#success\">Success</a>";
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    out += "<a href=\"#metric-" + slug(metric.metric) + "\">" + html(metric_title(metric.metric)) +
           "</a>";
  }
  out += content.trade_figures.empty() ? "" : "<a href=\"#pareto\">Pareto</a>";
  out += content.effort_figures.empty() ? "" : "<a href=\"#effort\">Effort</a>";
  out += content.anytime_figures.empty() ? "" : "<a href=\"#anytime\">Anytime</a>";
  out += content.convergence.empty() ? "" : "<a href=\"#convergence\">Convergence</a>";
  return out +
         "<a href=\"#scenarios\">Scenarios</a><a href=\"#method\">Method</a><a "
         "href=\"#origin\">Origin</a></nav>\n";
}

/// The head, with a content security policy that forbids all requests.
std::string head_html(const Content& content) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"generator\" content=\"altiplan report\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
      "'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
      "form-action "
      "'none'\">\n<link rel=\"icon\" href=\"data:,\">\n<title>";
  out += html(content.title) + "</title>\n<style>\n";
  out += page_style();
  out += figure_style();
  return out + "</style>\n</head>\n";
}

/// The data that the script unpacks when a run is opened: packed, so that it costs nothing before.
std::string stores_html(const Content& content, const Table& scenarios) {
  const auto store = [](const std::string& id, const std::string& data) {
    return "<script type=\"application/octet-stream\" id=\"" + id + "\">" + data + "</script>\n";
  };
  std::string out = store("data", packed(page_data(content, scenarios)));
  if (!content.scenes.scenes.empty()) {
    out += store("viewer", packed(host::viewer_template()));
  }
  for (std::size_t at = 0; at < content.scenes.scenes.size(); ++at) {
    out += store("scene-" + std::to_string(at), content.scenes.scenes[at].data);
  }
  return out;
}
}  // namespace

std::string page_text(const Content& content) {
  const Table scenarios = scenario_table(content);
  std::string body = "<header><p class=kind>altiplan study</p><h1>" + html(content.title) +
                     "</h1>\n" + incomplete_html(content) + "<p class=summary>" +
                     html(summary(content)) + "</p>\n" + contents_html(content) + "</header>\n";
  body += section("failures", "Unexplained failures", failures_html(content));
  body += section("claims", "Claims", claims_html(content));
  body += section("success", "Success", success_html(content));
  std::string metrics;
  for (std::size_t at = 0; at < content.analysis.metrics.size(); ++at) {
    metrics += metric_html(content, at);
  }
  if (content.analysis.metrics.empty()) {
    metrics = paragraph("No run has any of the metrics that the study compares.", "quiet");
  } else {
    metrics += folded("Values of solved runs, all metrics", html_text(metric_table(content)));
  }
  body += section("metrics", "Metrics", metrics);
  if (!content.trade_figures.empty()) {
    std::string trades = figures_html(content.trade_figures);
    for (const Trade& trade : content.analysis.trades) {
      trades += table_html(pareto_table(content, trade), 30);
    }
    body += section("pareto", "Pareto fronts", trades);
  }
  if (!content.effort_figures.empty()) {
    body += section("effort", "Solved by effort", figures_html(content.effort_figures));
  }
  if (!content.anytime_figures.empty()) {
    body += section("anytime", "Routes over time",
                    figures_html(content.anytime_figures) + table_html(anytime_table(content), 30));
  }
  if (!content.convergence.empty()) {
    body += section("convergence", "Convergence", convergence_html(content));
  }
  body += section("scenarios", "Scenarios", scenarios_html(scenarios));
  body += section("method", "Method", method_html(content));
  body += section("origin", "Origin", origin_html(content));
  return head_html(content) + "<body>\n<main>\n" + body +
         "</main>\n<aside id=panel aria-label=\"Run\" hidden></aside>\n" +
         stores_html(content, scenarios) + "<script>\n" + std::string(page_script()) +
         "</script>\n</body>\n</html>\n";
}
}  // namespace altiplan::study::report
