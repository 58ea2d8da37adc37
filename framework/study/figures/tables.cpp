// SPDX-License-Identifier: Apache-2.0
#include "study/figures/tables.hpp"

#include <algorithm>
#include <charconv>
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

bool is_none(const Cell& cell) { return cell.text.empty() || cell.text == "–"; }

/// The parts of cells in columns of their own.
Table taken_apart(const Table& table) {
  Table apart{table.name, table.caption, {}, {}, table.note};
  for (const Column& column : table.columns) {
    for (const std::string& part : column.parts) {
      apart.columns.push_back({column.title + part, column.number});
    }
    if (column.parts.empty()) {
      apart.columns.push_back(column);
    }
  }
  for (const auto& row : table.rows) {
    auto& cells = apart.rows.emplace_back();
    for (std::size_t at = 0; at < row.size(); ++at) {
      std::vector<Cell> parts = row[at].parts.empty() ? std::vector{row[at]} : row[at].parts;
      parts.resize(std::max<std::size_t>(table.columns[at].parts.size(), 1), "–");
      cells.insert(cells.end(), parts.begin(), parts.end());
    }
  }
  return apart;
}

/// A number as siunitx reads it, "" for another text; a share as its percentage.
std::string plain_number(std::string text) {
  text = text.ends_with(" %") ? text.substr(0, text.size() - 2) : text;
  std::erase(text, ',');
  const std::string unsigned_text = text.substr(text.starts_with('+') || text.starts_with('-'));
  double value = 0;
  const char* end = unsigned_text.data() + unsigned_text.size();
  const auto read = std::from_chars(unsigned_text.data(), end, value);
  const bool is_number = read.ec == std::errc() && read.ptr == end && std::isfinite(value);
  return is_number && unsigned_text[0] != '-' ? text : "";
}

/// The column's specification: the room that its numbers need.
std::string latex_column(const std::vector<std::string>& numbers) {
  std::size_t whole = 0;
  std::size_t decimals = 0;
  std::size_t exponent = 0;
  bool has_sign = false;
  for (const std::string& number : numbers) {
    const bool is_signed = number.starts_with('-') || number.starts_with('+');
    const std::size_t e = std::min(number.find('e'), number.size());
    const std::size_t point = std::min(number.find('.'), e);
    has_sign = has_sign || is_signed;
    whole = std::max(whole, point - is_signed);
    decimals = std::max(decimals, point < e ? e - point - 1 : 0);
    exponent = std::max(exponent, number.size() - e);  // with its sign
  }
  if (whole == 0) {
    return "r";
  }
  return "S[table-format=" + std::string(has_sign ? "-" : "") + std::to_string(whole) + "." +
         std::to_string(decimals) +
         (exponent > 0 ? "e-" + std::to_string(std::max<std::size_t>(exponent, 3) - 2) : "") + "]";
}
}  // namespace

Grid number_grid(const Table& table) {
  const Table apart = taken_apart(table);
  Grid grid;
  for (const Column& column : apart.columns) {
    grid.columns.push_back(column.title);
  }
  for (const auto& row : apart.rows) {
    auto& cells = grid.rows.emplace_back();
    for (const Cell& cell : row) {
      // "3/4" is kept.
      const bool is_number = !std::isnan(cell.sort) && cell.text.find('/') == std::string::npos;
      cells.push_back(is_none(cell) ? "" : is_number ? exact(cell.sort) : cell.text);
    }
  }
  return grid;
}

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

std::string latex_text(const Table& whole) {
  const Table table = taken_apart(whole);
  std::vector<std::string> kinds;
  std::vector<std::string> titles;
  for (std::size_t at = 0; at < table.columns.size(); ++at) {
    std::vector<std::string> numbers;
    bool are_shares = true;
    for (const auto& row : table.rows) {
      const std::string number = plain_number(row[at].text);
      are_shares = are_shares && (number.empty() || row[at].text.ends_with(" %"));
      if (!number.empty()) {
        numbers.push_back(number);
      }
    }
    const Column& column = table.columns[at];
    kinds.push_back(column.number ? latex_column(numbers) : "l");
    titles.push_back(latex(column.title + (are_shares && !numbers.empty() ? ", %" : "")));
  }
  const auto cell_text = [&](const std::string& text, std::size_t at) {
    const bool is_aligned = kinds[at].size() > 1;
    return is_aligned ? "{" + text + "}" : text;
  };
  std::string out =
      "% needs booktabs, siunitx and textcomp, and UTF-8\n\\begin{table}\n\\centering\n";
  out += "\\caption{" + latex(table.caption + (table.note.empty() ? "" : ". " + table.note)) +
         "}\n\\label{tab:" + table.name + "}\n\\begin{tabular}{" +
         joined_text(kinds, "", [](const std::string& kind) { return kind; }) + "}\n\\toprule\n";
  for (std::size_t at = 0; at < titles.size(); ++at) {
    out += (at > 0 ? " & " : "") + cell_text(titles[at], at);
  }
  out += " \\\\\n\\midrule\n";
  for (const auto& row : table.rows) {
    for (std::size_t at = 0; at < row.size(); ++at) {
      const std::string number = kinds[at].size() > 1 ? plain_number(row[at].text) : "";
      out += (at > 0 ? " & " : "") + (number.empty() ? cell_text(latex(row[at].text), at) : number);
    }
    out += " \\\\\n";
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
