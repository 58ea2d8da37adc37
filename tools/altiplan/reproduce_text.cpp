// SPDX-License-Identifier: Apache-2.0
#include "reproduce_text.hpp"

#include <algorithm>

#include "commands.hpp"
#include "study/figures/text.hpp"

namespace altiplan::cli {
namespace {
using study::Mark;

/// A column of the printed table; digits below digits.
std::string right(const std::string& text, std::size_t width) {
  const std::size_t length = study::report::characters(text);
  return std::string(length < width ? width - length : 0, ' ') + text;
}

std::string left(const std::string& text, std::size_t width) {
  const std::size_t length = study::report::characters(text);
  return text + std::string(length < width ? width - length : 0, ' ');
}

/// "within: 0.61 to 0.72"
std::string mark_text(const study::ReproducedFigure& figure) {
  const std::string mark = figure.mark == Mark::none ? "" : study::name(figure.mark);
  if (figure.why.empty()) {
    return mark;
  }
  return figure.mark == Mark::too_few   ? figure.why
         : figure.mark == Mark::differs ? mark + ": this sample allows " + figure.why
                                        : mark + ": " + figure.why;
}

/// "20 of 100 pairs (scenario, repetition) of rrt_open"
std::string runs_text(const study::ReproducedRuns& done) {
  using study::report::grouped;
  const std::string all = grouped(done.runs->pairs);
  const std::string of = done.pairs < done.runs->pairs ? grouped(done.pairs) + " of " + all
                         : done.pairs == 1             ? "the one"
                                                       : "all " + all;
  return of + (done.pairs == 1 && done.runs->pairs == 1 ? " pair" : " pairs") +
         " (scenario, repetition) of the study " + done.runs->study.stem().string();
}

struct Widths {
  std::size_t name = 0;
  std::size_t paper = 0;
  std::size_t documentation = 0;
  std::size_t here = 0;

  std::string line(const std::string& of_name, const std::string& of_paper,
                   const std::string& of_documentation, const std::string& of_here,
                   const std::string& mark) const {
    std::string text = "    " + left(of_name, name) + "  " + right(of_paper, paper) + "  " +
                       (documentation > 0 ? right(of_documentation, documentation) + "  " : "") +
                       right(of_here, here) + "  " + mark;
    text.resize(text.find_last_not_of(' ') + 1);
    return text + "\n";
  }
};

Widths widths_of(const study::ReproducedRuns& done) {
  const auto widen = [](std::size_t& width, const std::string& text) {
    width = std::max(width, study::report::characters(text));
  };
  Widths widths{0, 5, 0, 12};  // nobody who writes a paper of his own has a documentation yet
  for (const study::ReproducedRow& row : done.rows) {
    for (const study::ReproducedFigure& figure : row.figures) {
      widen(widths.name, figure.figure->name);
      widen(widths.paper, figure.figure->paper);
      if (!figure.figure->documentation.empty()) {
        widen(widths.documentation, "documentation");
        widen(widths.documentation, figure.figure->documentation);
      }
      widen(widths.here, figure.here);
    }
  }
  return widths;
}

host::Json declared_json(const study::PaperFigure& figure) {
  host::Json json{{"name", figure.name}};
  if (figure.of_claim) {
    json["claim"] = figure.claim.id;
  }
  json["of"] = figure.claim.that;
  json["paper"] = figure.paper;
  json["documentation"] = figure.documentation;
  return json;
}

host::Json figure_json(const study::ReproducedFigure& figure) {
  host::Json json = declared_json(*figure.figure);
  json["here"] = figure.here;
  json["mark"] = figure.mark == Mark::differs ? "differs" : study::name(figure.mark);
  if (!figure.why.empty()) {
    json["sample"] = figure.why;
  }
  return json;
}
}  // namespace

void MarkCounts::add(const study::ReproducedRuns& done) {
  for (const study::ReproducedRow& row : done.rows) {
    for (const study::ReproducedFigure& figure : row.figures) {
      ++counts_[std::size_t(figure.mark)];
    }
  }
}

std::string MarkCounts::text() const {
  std::size_t all = 0;
  for (const std::size_t count : counts_) {
    all += count;
  }
  std::string text;
  for (const auto& [mark, words] :
       {std::pair(Mark::equal, "equal"),
        std::pair(Mark::within, "within the sample's 99.9 % interval"),
        std::pair(Mark::time, of(Mark::time) == 1 ? "time" : "times"),
        std::pair(Mark::too_few, "of too few runs"), std::pair(Mark::none, "not compared")}) {
    if (of(mark) > 0) {
      text += (text.empty() ? "" : ", ") + study::report::grouped(of(mark)) + " " + words;
    }
  }
  const std::size_t differ = of(Mark::differs);
  if (all == of(Mark::none)) {
    return study::report::counted(all, "figure") + ": none is compared";
  }
  return study::report::counted(all, "figure") + ": " + text + (text.empty() ? "" : "; ") +
         (differ == 0   ? "none differs"
          : differ == 1 ? "1 DIFFERS"
                        : std::to_string(differ) + " DIFFER");
}

std::string title_text(const study::Paper& paper) {
  return paper.name.text() + (paper.title.empty() ? "" : ": " + paper.title) +
         (paper.page.empty() ? "" : " (" + paper.page + ")") + "\n";
}

std::string reproduced_text(const study::ReproducedRuns& done) {
  const Widths widths = widths_of(done);
  std::string text;
  std::string heading;
  for (const study::ReproducedRow& row : done.rows) {
    const std::string source = row.row->source.empty() ? "" : " (paper: " + row.row->source + ")";
    if (heading != row.row->heading + source) {
      heading = row.row->heading + source;
      text += "\n" + heading + ": " + runs_text(done) + "\n" +
              widths.line("", "paper", "documentation", "this machine", "");
    }
    text += "  " + row.row->id + ": " + row.row->what + "\n";
    for (const study::ReproducedFigure& figure : row.figures) {
      text += widths.line(figure.figure->name, figure.figure->paper, figure.figure->documentation,
                          figure.here, mark_text(figure));
    }
  }
  return text;
}

host::Json reproduced_json(const study::ReproducedRuns& done) {
  host::Json rows = host::Json::array();
  for (const study::ReproducedRow& row : done.rows) {
    host::Json figures = host::Json::array();
    for (const study::ReproducedFigure& figure : row.figures) {
      figures.push_back(figure_json(figure));
    }
    rows.push_back({{"id", row.row->id},
                    {"what", row.row->what},
                    {"heading", row.row->heading},
                    {"source", row.row->source},
                    {"study", done.runs->study.string()},
                    {"pairs", done.pairs},
                    {"pairs_documented", done.runs->pairs},
                    {"figures", std::move(figures)}});
  }
  return rows;
}

std::string list_text(const study::Paper& paper) {
  std::size_t width = 0;
  for (const study::ReproducibleRow& row : paper.rows) {
    width = std::max(width, row.id.size());
  }
  const auto line = [&](const std::string& id, const std::string& quick, const std::string& full,
                        const std::string& what) {
    return "  " + left(id, width) + right(quick, 9) + right(full, 9) + "  " + what + "\n";
  };
  std::string text = title_text(paper) + line("row", "--quick", "full", "processor time, of");
  for (const study::ReproducibleRow& row : paper.rows) {
    text += line(row.id, duration(paper.cpu_s({&row}, true)), duration(paper.cpu_s({&row}, false)),
                 row.what);
  }
  return text + line("all", duration(paper.cpu_s(paper.all_rows(), true)),
                     duration(paper.cpu_s(paper.all_rows(), false)),
                     "all " + std::to_string(paper.rows.size()) + " rows, which share runs");
}

host::Json list_json(const study::Paper& paper) {
  host::Json rows = host::Json::array();
  for (const study::ReproducibleRow& row : paper.rows) {
    host::Json figures = host::Json::array();
    for (const study::PaperFigure& figure : row.figures) {
      figures.push_back(declared_json(figure));
    }
    rows.push_back({{"id", row.id},
                    {"what", row.what},
                    {"heading", row.heading},
                    {"quick_cpu_s", paper.cpu_s({&row}, true)},
                    {"cpu_s", paper.cpu_s({&row}, false)},
                    {"figures", std::move(figures)}});
  }
  return {{"number", paper.name.number},
          {"name", paper.name.name},
          {"title", paper.title},
          {"page", paper.page},
          {"file", paper.path.string()},
          {"quick_cpu_s", paper.cpu_s(paper.all_rows(), true)},
          {"cpu_s", paper.cpu_s(paper.all_rows(), false)},
          {"rows", std::move(rows)}};
}
}  // namespace altiplan::cli
