// SPDX-License-Identifier: Apache-2.0
#include "study/reproduce/paper_file.hpp"

#include "host/config/scenario_file.hpp"

namespace altiplan::study {

void RunsChoice::describe(Fields& f) {
  f("id", id).required().doc("name that tables refer to");
  f("study", study).required().doc("a study");
  f("scenarios", scenarios).doc("id of the study's scenarios that count (default: all)");
  f("quick", quick)
      .greater_than(0)
      .at_most(1)
      .doc("share of the scenarios and repetitions that --quick runs");
  f("cpu_ms", cpu_ms).doc("processor time of a run of each pipeline (ms), for --list, or none");
}

void PaperColumn::describe(Fields& f) {
  f("name", name).required().doc("head of the column in the page's table");
  f("of", of).required().doc(
      "statistic, as in a claim; ROW stands for the row's text: median(ROW.length_m / 1000)");
}

void PaperRow::describe(Fields& f) {
  f("id", id).required().doc("name on the command line");
  f("what", what).required().doc("first cell of the row in the page's table");
  f("row", row).doc("text that replaces ROW, usually a pipeline (default: the id)");
  f("paper", paper)
      .doc(
          "what the paper prints, for each column: 303, 54/100, or words in quotes; \"\": nothing");
  f("documentation", documentation)
      .doc(
          "what the page prints, by column: 303, 0.45, 92.6 %, 54/100; \"\": not compared; without "
          "it all columns are shown, and none is compared");
}

void PaperClaim::describe(Fields& f) {
  f("id", id).required().doc("name on the command line");
  f("claim", claim).doc("id of the study's claim (default: the id)");
  f("what", what).required().doc("what the paper says: first cell of the row in the page's table");
  f("paper", paper).doc("the figure that the paper prints");
  f("verdict", verdict)
      .one_of({"holds", "fails", "undecided", "no data"})
      .doc("verdict in the page; without it the verdict is shown, and not compared");
  f("measured", measured).doc("estimate in the page, with its interval: 0.674 [0.631, 0.722]");
}

void PaperTable::describe(Fields& f) {
  f("heading", heading).required().doc("heading of the page's section with the table");
  f("source", source).doc("where the paper prints its figures: table 1");
  f("runs", runs).required().doc("id of the runs that give the figures");
  f("columns", columns).doc("figures of each row");
  f("rows", rows).doc("rows with a figure for each column");
  f("claims", claims).doc("rows of claims of the study");
  f.check(columns.empty() == rows.empty(), "'columns' and 'rows' need one another");
}

void PaperFile::describe(Fields& f) {
  f("altiplan", altiplan).range(host::kFileFormat, host::kFileFormat).required().doc("file format");
  f("title", title).doc("title for the user; default: none");
  f("page", page).doc("page of the documentation with the tables, only named; default: none");
  f("runs", runs).min_items(1).required().doc("runs of studies");
  f("tables", tables).min_items(1).required().doc("tables of the page");
}
}  // namespace altiplan::study
