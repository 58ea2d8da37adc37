// SPDX-License-Identifier: Apache-2.0
#include "table.hpp"

#include <algorithm>
#include <numeric>

#include "host/base/utf8.hpp"

namespace altiplan::cli {
namespace {

using host::characters;

/// A last column of text is wrapped to that many characters at least.
constexpr std::size_t kMinWrapped = 24;
constexpr std::size_t kMaxBlocks = 3;

/// Lines of at most that many characters, broken at blanks; a longer word has a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t max_width) {
  std::vector<std::string> lines;
  std::size_t at = 0;
  while (at < text.size() || lines.empty()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (lines.empty() || characters(lines.back()) + 1 + characters(word) > max_width) {
      lines.push_back(word);
    } else {
      lines.back() += " " + word;
    }
    at = end + 1;
  }
  return lines;
}

std::string blanks(std::size_t count) { return std::string(count, ' '); }
}  // namespace

Table::Table(std::vector<Column> columns, std::size_t indent, std::size_t keys)
    : columns_(std::move(columns)), indent_(indent), keys_(keys) {}

void Table::add(std::vector<Cell> row) {
  for (Cell& cell : row) {
    cell.text = host::printable(cell.text);
  }
  rows_.push_back(std::move(row));
}

Table::Widths Table::widths(bool with_min) const {
  Widths widths;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    std::size_t width =
        std::max(characters(columns_[c].title), with_min ? columns_[c].min_width : 0);
    for (const auto& row : rows_) {
      width = std::max(width, characters(row[c].text));
    }
    widths.push_back(width);
  }
  return widths;
}

std::size_t Table::gap(std::size_t before, std::size_t column) const {
  return columns_[before].is_number && !columns_[column].is_number ? 2 : 1;
}

std::size_t Table::total(const Widths& widths, const Columns& columns) const {
  std::size_t total = indent_;
  for (std::size_t n = 0; n < columns.size(); ++n) {
    total += widths[columns[n]] + (n > 0 ? gap(columns[n - 1], columns[n]) : 0);
  }
  return total;
}

void Table::print(std::FILE* to) const {
  Columns all(columns_.size());
  std::iota(all.begin(), all.end(), 0);
  const std::size_t room = terminal_columns(fileno(to));
  const Widths wide = widths(true);
  if (room == 0 || total(wide, all) <= room) {
    return print_block(to, wide, all);
  }
  Widths narrow = widths(false);
  const std::size_t before_last = total(narrow, all) - narrow.back();
  if (!columns_.back().is_number && before_last + kMinWrapped <= room) {
    narrow.back() = std::min(narrow.back(), room - before_last);
    return print_block(to, narrow, all);
  }
  const std::vector<Columns> parts = blocks(narrow, room);
  for (const Columns& part : parts) {
    print_block(to, narrow, part);
  }
  if (parts.empty()) {
    print_lists(to);
  }
}

std::vector<Table::Columns> Table::blocks(const Widths& widths, std::size_t room) const {
  Columns keys(keys_);
  std::iota(keys.begin(), keys.end(), 0);
  std::vector<Columns> blocks(1, keys);
  for (std::size_t c = keys_; c < columns_.size(); ++c) {
    blocks.back().push_back(c);
    if (total(widths, blocks.back()) <= room) {
      continue;
    }
    blocks.back().pop_back();
    blocks.push_back(keys);
    blocks.back().push_back(c);
    if (total(widths, blocks.back()) > room || blocks.size() > kMaxBlocks) {
      return {};
    }
  }
  return blocks;
}

void Table::print_block(std::FILE* to, const Widths& widths, const Columns& columns) const {
  std::vector<Cell> titles;
  bool has_titles = false;
  for (const Column& column : columns_) {
    titles.emplace_back(column.title, Color::strong);
    has_titles = has_titles || !column.title.empty();
  }
  if (has_titles) {
    print_row(to, titles, widths, columns);
  }
  for (const auto& row : rows_) {
    print_row(to, row, widths, columns);
  }
}

void Table::print_row(std::FILE* to, const std::vector<Cell>& row, const Widths& widths,
                      const Columns& columns) const {
  std::string line = blanks(indent_);
  for (std::size_t n = 0; n < columns.size(); ++n) {
    const std::size_t c = columns[n];
    const Cell& cell = row[c];
    line += blanks(n > 0 ? gap(columns[n - 1], c) : 0);
    const std::size_t used = std::min(characters(cell.text), widths[c]);
    const bool is_last = n + 1 == columns.size();
    if (columns_[c].is_number) {
      line += blanks(widths[c] - used) + painted(to, cell.color, cell.text);
    } else if (!is_last) {
      line += painted(to, cell.color, cell.text) + blanks(widths[c] - used);
    } else {
      std::string break_before;
      for (const std::string& part : wrapped(cell.text, widths[c])) {
        line += break_before + painted(to, cell.color, part);
        break_before = "\n" + blanks(total(widths, columns) - widths[c]);
      }
    }
  }
  line.erase(line.find_last_not_of(' ') + 1);
  std::fprintf(to, "%s\n", line.c_str());
}

void Table::print_lists(std::FILE* to) const {
  std::size_t width = 0;
  for (const Column& column : columns_) {
    width = std::max(width, characters(column.title));
  }
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::string title = columns_[c].title + blanks(width - characters(columns_[c].title));
      std::fprintf(to, "%s%s  %s\n", blanks(c == 0 ? indent_ : indent_ + 2).c_str(),
                   painted(to, Color::strong, title).c_str(),
                   painted(to, row[c].color, row[c].text).c_str());
    }
  }
}
}  // namespace altiplan::cli
