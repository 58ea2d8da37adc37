// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "terminal.hpp"

namespace altiplan::cli {

/// A table as text. Columns are as wide as their longest cell. On a narrower terminal the last
/// column, if it is text, is wrapped; else the columns that do not fit follow below, each block
/// beginning with the columns that name a row; and if that takes many blocks, each row becomes a
/// list.
class Table {
 public:
  struct Column {
    std::string title;          ///< without any, no titles are printed
    bool is_number = false;     ///< right-aligned
    std::size_t min_width = 0;  ///< where there is room
  };
  struct Cell {
    Cell(std::string words, Color paint = Color::none) : text(std::move(words)), color(paint) {}
    Cell(const char* words) : text(words) {}
    std::string text;
    Color color = Color::none;
  };

  /// The first `keys` columns name a row.
  explicit Table(std::vector<Column> columns, std::size_t indent = 2, std::size_t keys = 1);
  /// One cell per column.
  void add(std::vector<Cell> row);
  void print(std::FILE* to) const;

 private:
  using Widths = std::vector<std::size_t>;
  using Columns = std::vector<std::size_t>;  ///< indices

  Widths widths(bool with_min) const;
  std::size_t gap(std::size_t before, std::size_t column) const;
  std::size_t total(const Widths& widths, const Columns& columns) const;
  void print_block(std::FILE* to, const Widths& widths, const Columns& columns) const;
  void print_row(std::FILE* to, const std::vector<Cell>& row, const Widths& widths,
                 const Columns& columns) const;
  void print_lists(std::FILE* to) const;
  /// Blocks of columns that fit; empty if there are many.
  std::vector<Columns> blocks(const Widths& widths, std::size_t room) const;

  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
  std::size_t indent_;
  std::size_t keys_;
};
}  // namespace altiplan::cli
