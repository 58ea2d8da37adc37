// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace altiplan::study::report {

/// The content of a CSV file: cells are raw text.
struct Grid {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A cell of a table of the report.
struct Cell {
  std::string text;                                        ///< raw; escaped for each format
  double sort = std::numeric_limits<double>::quiet_NaN();  ///< sort key instead of the text
  std::string kind;                                        ///< class of the page's style sheet
  std::string open;  ///< target of a click: "run 17", "cell 3 1"; "" for none
  std::vector<Cell>
      parts;  ///< what files have in columns of their own: 12, 9 and 20 of "12 [9, 20]"

  Cell(std::string shown) : text(std::move(shown)) {}  // NOLINT(google-explicit-constructor)
  Cell(const char* shown) : text(shown) {}             // NOLINT(google-explicit-constructor)
  Cell(std::string shown, double by) : text(std::move(shown)), sort(by) {}
  Cell(std::string shown, double by, std::vector<Cell> apart)
      : text(std::move(shown)), sort(by), parts(std::move(apart)) {}
};

struct Column {
  std::string title;
  bool number = false;                  ///< right-aligned, digits below digits
  std::vector<std::string> parts = {};  ///< in files columns of this title and each of these words
  bool operator==(const Column&) const = default;
};

/// A table of the page, and of the files under tables/.
struct Table {
  std::string name;
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  std::string note = {};  ///< a sentence added to the caption
};

std::string csv_text(const Grid& grid);
/// Each cell's parts in columns of their own: numbers in full, "" for none.
Grid number_grid(const Table& table);
std::string markdown_text(const Table& table);
/// For LaTeX with the packages booktabs, siunitx (aligned numbers) and textcomp.
std::string latex_text(const Table& table);
/// At most `max_rows` rows; the script adds the others.
std::string html_text(const Table& table, std::size_t max_rows = std::size_t(-1));
/// The cells of one row, <td>… .
std::string html_row(const Table& table, std::size_t row);
}  // namespace altiplan::study::report
