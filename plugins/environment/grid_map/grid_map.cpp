// SPDX-License-Identifier: Apache-2.0
// Two-dimensional grid maps in the format of N. Sturtevant, "Benchmarks for Grid-Based
// Pathfinding", IEEE Trans. Computational Intelligence and AI in Games 4(2), 2012 (.map): rows of
// characters, the first row northernmost.
#include <charconv>

#include "altiplan/environment.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  Path file;
  double cell_m = 1;
  double height_m = 1;
  std::int64_t max_cells = 1'000'000'000;

  void describe(Fields& f) {
    f("file", file).doc("MovingAI grid map (.map)").required();
    f("cell_m", cell_m).unit("m").range(0.001, 1e6).doc("edge length of a cell");
    f("height_m", height_m)
        .unit("m")
        .range(0.001, 1e6)
        .doc("height of the blocked cells above 0; the map is one layer of cells");
    f("max_cells", max_cells)
        .at_least(1)
        .doc("a file that declares more cells is rejected before anything is allocated");
  }
};

/// The file's lines, numbered for messages.
class Lines {
 public:
  /// Throws InputError if the file cannot be read.
  explicit Lines(const std::string& file) : file_(file), stream_(file) {}
  [[noreturn]] void refuse(const std::string& why) const {
    throw ParameterError("file", file_ + ":" + std::to_string(number_) + ": " + why);
  }
  /// The next line, without its end (LF or CRLF); throws at the end of the file.
  std::string next(const std::string& expected) {
    std::string line;
    ++number_;
    if (!std::getline(stream_, line)) {
      refuse("the file ends here, expected " + expected);
    }
    if (line.ends_with('\r')) {
      line.pop_back();
    }
    return line;
  }
  /// The number after a key of the header, such as "height 512".
  int count(const std::string& line, const std::string& key) const {
    int value = 0;
    const char* from = line.data() + std::min(line.size(), key.size() + 1);
    const char* to = line.data() + line.size();
    const auto [end, error] = std::from_chars(from, to, value);
    if (error != std::errc() || end != to || value < 1) {
      refuse("expected '" + key + "' and a whole number of at least 1, found " + excerpt(line));
    }
    return value;
  }
  bool at_end() {
    std::string rest;
    while (std::getline(stream_, rest)) {
      ++number_;
      if (rest.find_first_not_of(" \r\t") != rest.npos) {
        return false;
      }
    }
    return true;
  }

 private:
  std::string file_;
  formats::InputFile stream_;
  int number_ = 0;
};

/// A byte as shown in messages.
std::string quoted(char c) {
  constexpr char kHex[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return byte >= ' ' && byte < 0x7f ? std::string{'\'', c, '\''}
                                    : std::string("0x") + kHex[byte >> 4] + kHex[byte & 15];
}

/// Height and width of the map, which precede it.
std::pair<int, int> read_size(Lines& lines) {
  if (const std::string type = lines.next("'type octile'"); type != "type octile") {
    lines.refuse("expected 'type octile', found " + excerpt(type));
  }
  int height = 0;
  int width = 0;
  for (std::string line = lines.next("'height'"); line != "map"; line = lines.next("'map'")) {
    if (line.starts_with("height ") && height == 0) {
      height = lines.count(line, "height");
    } else if (line.starts_with("width ") && width == 0) {
      width = lines.count(line, "width");
    } else {
      lines.refuse("expected 'height', 'width', each once, then 'map', found " + excerpt(line));
    }
  }
  if (height == 0 || width == 0) {
    lines.refuse("expected 'height' and 'width' before 'map'");
  }
  return {height, width};
}

/// Blocks the cells that the line marks in row j.
void read_row(const std::string& line, int j, const Lines& lines, VoxelGrid& cells) {
  const int width = cells.spec().counts[0];
  if (line.size() != std::size_t(width)) {
    lines.refuse("expected a row of " + std::to_string(width) + " cells, found " +
                 std::to_string(line.size()));
  }
  int first_blocked = 0;  // first of the cells since the last free one
  for (int column = 0; column < width; ++column) {
    const char c = line[std::size_t(column)];
    if (c == '.' || c == 'G') {
      if (column > first_blocked) {
        cells.block_run(first_blocked, column - 1, j, 0);
      }
      first_blocked = column + 1;
    } else if (c != '@' && c != 'O' && c != 'T') {
      lines.refuse("cell " + std::to_string(column + 1) +
                   ": expected '.' or 'G' (free), '@', 'O' or 'T' (blocked), found " + quoted(c) +
                   " (swamp and water have traversal costs, which no planner " + "here supports)");
    }
  }
  cells.block_run(first_blocked, width - 1, j, 0);
}

VoxelGrid read(const Params& params) {
  const std::string& file = params.file.text;
  if (const std::string why = formats::why_unreadable(file); !why.empty()) {
    throw ParameterError("file", file + ": " + why);
  }
  Lines lines(file);
  const auto [height, width] = read_size(lines);
  if (std::int64_t(height) * width > params.max_cells) {
    throw ParameterError("max_cells", params.file.text + ": declares " + std::to_string(width) +
                                          " x " + std::to_string(height) +
                                          " cells, more than max_cells");
  }
  GridSpec spec;
  spec.cell = {params.cell_m, params.cell_m, params.height_m};
  spec.counts = {width, height, 1};
  spec.rule = GridSpec::Rule::native;
  VoxelGrid cells(spec);
  for (int row = 0; row < height; ++row) {
    const std::string line = lines.next("row " + std::to_string(row + 1) + " of the map");
    read_row(line, height - 1 - row, lines, cells);
  }
  if (!lines.at_end()) {
    lines.refuse("the file continues after the " + std::to_string(height) +
                 " rows that it declares");
  }
  return cells;
}

class GridMap final : public kit::CellLayer {
 public:
  GridMap(const Params& params, const Site&) : CellLayer(read(params)) {}

 private:
  /// Column and row from the file's top left.
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return CellLayer::do_cell_centre({cell[0], cells().spec().counts[1] - 1 - cell[1], 0});
  }
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "grid_map", GridMap, Params,
                "a two-dimensional grid map in MovingAI's format")
