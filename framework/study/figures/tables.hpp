// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace altiplan::study::report {

/// Numbers as a CSV file has them: cells are raw text.
struct Grid {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A cell of a table that people read.
struct Cell {
  std::string text;                                        ///< raw; escaped for each form
  double sort = std::numeric_limits<double>::quiet_NaN();  ///< in place of the text
  std::string kind;                                        ///< class of the page's style sheet
  std::string open;  ///< what a click shows: "run 17", "cell 3 1"; "" for nothing

  Cell(std::string shown) : text(std::move(shown)) {}  // NOLINT(google-explicit-constructor)
  Cell(const char* shown) : text(shown) {}             // NOLINT(google-explicit-constructor)
  Cell(std::string shown, double by) : text(std::move(shown)), sort(by) {}
};

struct Column {
  std::string title;
  bool number = false;  ///< to the right, digits below digits
  bool operator==(const Column&) const = default;
};

/// A table of the page, and of the files under tables/.
struct Table {
  std::string name;
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  std::string note = {};  ///< a sentence that goes with the caption
};

std::string csv_text(const Grid& grid);
std::string markdown_text(const Table& table);
/// For LaTeX with the packages booktabs and textcomp.
std::string latex_text(const Table& table);
/// `most` rows, the others left to the script.
std::string html_text(const Table& table, std::size_t most = std::size_t(-1));
/// The cells of one row, <td>… .
std::string html_row(const Table& table, std::size_t row);
}  // namespace altiplan::study::report
