// SPDX-License-Identifier: Apache-2.0
#include "study/figures/tables.hpp"

#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"

namespace altiplan::study::report {
namespace {

template <class List, class Text>
std::string joined_text(const List& list, const char* between, const Text& text) {
  std::string out;
  bool first = true;
  for (const auto& item : list) {
    out += (first ? "" : between) + text(item);
    first = false;
  }
  return out;
}
}  // namespace

std::string csv_text(const Grid& grid) {
  const auto line = [](const std::vector<std::string>& cells) {
    return joined_text(cells, ",", [](const std::string& cell) { return csv(cell); }) + "\r\n";
  };
  std::string out = line(grid.columns);
  for (const auto& row : grid.rows) {
    out += line(row);
  }
  return out;
}

std::string markdown_text(const Table& table) {
  std::string out = markdown(table.caption) + "\n\n";
  out += table.note.empty() ? "" : "**" + markdown(table.note) + "**\n\n";
  out += "| " +
         joined_text(table.columns, " | ", [](const Column& c) { return markdown(c.title); }) +
         " |\n|" +
         joined_text(table.columns, "|",
                     [](const Column& c) { return std::string(c.number ? "---:" : "---"); }) +
         "|\n";
  for (const auto& row : table.rows) {
    out += "| " + joined_text(row, " | ", [](const Cell& cell) { return markdown(cell.text); }) +
           " |\n";
  }
  return out;
}

std::string latex_text(const Table& table) {
  std::string out = "% needs booktabs and textcomp, and UTF-8\n\\begin{table}\n\\centering\n";
  out += "\\caption{" + latex(table.caption + (table.note.empty() ? "" : ". " + table.note)) +
         "}\n\\label{tab:" + table.name + "}\n\\begin{tabular}{" +
         joined_text(table.columns, "",
                     [](const Column& c) { return std::string(c.number ? "r" : "l"); }) +
         "}\n\\toprule\n";
  out += joined_text(table.columns, " & ", [](const Column& c) { return latex(c.title); }) +
         " \\\\\n\\midrule\n";
  for (const auto& row : table.rows) {
    out += joined_text(row, " & ", [](const Cell& cell) { return latex(cell.text); }) + " \\\\\n";
  }
  return out + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

std::string html_row(const Table& table, std::size_t at) {
  std::string out;
  const auto& row = table.rows[at];
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Cell& cell = row[column];
    std::string kind = cell.kind;
    if (table.columns[column].number) {
      kind += kind.empty() ? "n" : " n";
    }
    out += column == 0 ? "<th scope=row" : "<td";
    out += kind.empty() ? "" : " class=\"" + html(kind) + "\"";
    out += std::isnan(cell.sort) ? "" : " data-v=\"" + exact(cell.sort) + "\"";
    out += cell.open.empty() ? "" : " data-open=\"" + html(cell.open) + "\"";
    out += ">" + html(cell.text) + (column == 0 ? "</th>" : "</td>");
  }
  return out;
}

std::string html_text(const Table& table, std::size_t max_rows) {
  const std::string id = html(table.name);
  std::string out = "<p class=caption id=\"caption-" + id + "\">" + html(table.caption) +
                    "</p><div class=scroll><table id=\"table-" + id +
                    "\" class=sortable aria-labelledby=\"caption-" + id + "\"><thead><tr>";
  for (const Column& column : table.columns) {
    out += std::string("<th scope=col") + (column.number ? " class=n>" : ">") + html(column.title) +
           "</th>";
  }
  out += "</tr></thead><tbody>\n";
  for (std::size_t at = 0; at < std::min(max_rows, table.rows.size()); ++at) {
    out += "<tr>" + html_row(table, at) + "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}
}  // namespace altiplan::study::report
