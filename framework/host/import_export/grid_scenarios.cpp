// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/grid_scenarios.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"

namespace altiplan::host {
namespace {

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) {
    words.push_back(word);
  }
  return words;
}

/// A line's columns, read by number.
class Row {
 public:
  Row(std::string where, std::vector<std::string> words)
      : where_(std::move(where)), words_(std::move(words)) {}

  std::size_t size() const { return words_.size(); }
  const std::string& text(std::size_t column) const { return words_[column]; }
  [[noreturn]] void refuse(const std::string& why) const { throw Error(where_ + ": " + why); }

  double number(std::size_t column, const std::string& what) const {
    const std::string& word = words_[column];
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      refuse("expected " + what + " as a number, found " + excerpt(word));
    }
    return value;
  }

  /// A cell whose indices start at the column.
  std::array<double, 3> cell(std::size_t column, const std::array<int, 3>& counts,
                             const std::string& what) const {
    std::array<double, 3> cell{0, 0, 0};
    for (std::size_t axis = 0; axis < (counts[2] > 1 ? 3 : 2); ++axis) {
      const double index = number(column + axis, what);
      if (index != std::floor(index) || index < 0 || index >= counts[axis]) {
        refuse("expected " + what + " within the map's " + std::to_string(counts[axis]) +
               " cells, found " + words_[column + axis]);
      }
      cell[axis] = index;
    }
    return cell;
  }

 private:
  std::string where_;
  std::vector<std::string> words_;
};

int decimals_of(const std::string& number) {
  const std::size_t point = number.find('.');
  return point == number.npos ? 0 : int(number.size() - point - 1);
}

/// bucket, map, width, height, start x y, goal x y, length
GridScenario plane_scenario(const Row& row, const std::array<int, 3>& counts) {
  if (row.size() != 9) {
    row.refuse(
        "expected nine columns (bucket, map, width, height, start x and y, goal x and y, "
        "length), found " +
        std::to_string(row.size()));
  }
  if (row.number(2, "the width") != counts[0] || row.number(3, "the height") != counts[1]) {
    row.refuse("is for a map of " + row.text(2) + " x " + row.text(3) + " cells, the map has " +
               std::to_string(counts[0]) + " x " + std::to_string(counts[1]));
  }
  return {row.cell(4, counts, "the start"), row.cell(6, counts, "the goal"),
          row.number(8, "the length"), decimals_of(row.text(8)), 0};
}

/// start x y z, goal x y z, length, ratio of the heuristic
GridScenario space_scenario(const Row& row, const std::array<int, 3>& counts) {
  if (row.size() != 8) {
    row.refuse(
        "expected eight columns (start x, y, z, goal x, y, z, length, heuristic ratio), "
        "found " +
        std::to_string(row.size()));
  }
  return {row.cell(0, counts, "the start"), row.cell(3, counts, "the goal"),
          row.number(6, "the length"), decimals_of(row.text(6)), 0};
}
}  // namespace

std::array<int, 3> grid_counts(const std::filesystem::path& map) {
  formats::InputFile in(map.string());
  const bool is_3d = map.extension() == ".3dmap";
  std::array<int, 3> counts{0, 0, is_3d ? 0 : 1};
  std::string line;
  for (int number = 1; number <= (is_3d ? 1 : 4) && std::getline(in, line); ++number) {
    const Row row(map.string() + ":" + std::to_string(number), words_of(line));
    const auto set = [&](std::size_t axis, std::size_t column) {
      const double count = row.number(column, "a number of cells");
      if (count != std::floor(count) || count < 1 || count > 1e9) {
        row.refuse("expected a number of cells, found " + row.text(column));
      }
      counts[axis] = int(count);
    };
    if (is_3d && row.size() == 4 && row.text(0) == "voxel") {
      for (const std::size_t axis : {0, 1, 2}) {
        set(axis, axis + 1);
      }
    } else if (!is_3d && row.size() == 2 && row.text(0) == "width") {
      set(0, 1);
    } else if (!is_3d && row.size() == 2 && row.text(0) == "height") {
      set(1, 1);
    }
  }
  if (counts[0] == 0 || counts[1] == 0 || counts[2] == 0) {
    throw Error(map.string() + ": expected a map, which begins with its size");
  }
  return counts;
}

GridScenarios read_grid_scenarios(const std::filesystem::path& file,
                                  const std::array<int, 3>& counts, std::size_t limit) {
  GridScenarios scenarios;
  scenarios.is_3d = file.extension() == ".3dscen";
  if (!scenarios.is_3d && file.extension() != ".scen") {
    throw Error(file.string() + ": expected a .scen or a .3dscen file");
  }
  formats::InputFile in(file.string());
  int number = 0;
  for (std::string line; scenarios.list.size() < limit && std::getline(in, line);) {
    ++number;
    Row row(file.string() + ":" + std::to_string(number), words_of(line));
    if (number == 1) {
      if (row.size() != 2 || row.text(0) != "version" || row.number(1, "the version") != 1) {
        row.refuse("expected 'version 1', found " + excerpt(line));
      }
    } else if (row.size() > 0 && !(scenarios.is_3d && number == 2)) {  // line 2: the map's name
      scenarios.list.push_back(scenarios.is_3d ? space_scenario(row, counts)
                                               : plane_scenario(row, counts));
      scenarios.list.back().line = number;
    }
  }
  if (scenarios.list.empty()) {
    throw Error(file.string() + ": there is no scenario in it");
  }
  return scenarios;
}
}  // namespace altiplan::host
