// SPDX-License-Identifier: Apache-2.0
// Voxel maps in the format of D. Brewer and N. Sturtevant, "Benchmarks for Pathfinding in 3D Voxel
// Space", SoCS 2018 (.3dmap): the counts, then one blocked voxel per line.
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
  std::int64_t max_cells = 1'000'000'000;

  void describe(Fields& f) {
    f("file", file).doc("voxel map (.3dmap)").required();
    f("cell_m", cell_m).unit("m").range(0.001, 1e6).doc("edge length of a voxel");
    f("max_cells", max_cells)
        .at_least(1)
        .doc("a file that declares more voxels is rejected before anything is allocated");
  }
};

/// Three integers separated by single spaces, and nothing else.
std::optional<Cell> three(std::string_view text) {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis) {
    while (text.starts_with(' ')) {
      text.remove_prefix(1);
    }
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), cell[std::size_t(axis)]);
    if (error != std::errc()) {
      return std::nullopt;
    }
    text.remove_prefix(std::size_t(end - text.data()));
  }
  return text.find_first_not_of(" \r\t") == text.npos ? std::optional(cell) : std::nullopt;
}

VoxelGrid read(const Params& params) {
  const std::string file = params.file.text;
  if (const std::string why = formats::why_unreadable(file); !why.empty()) {
    throw ParameterError("file", file + ": " + why);
  }
  formats::InputFile stream(file);
  std::string line;
  std::int64_t number = 1;
  const auto refuse = [&](const std::string& expected) {
    throw ParameterError("file", file + ":" + std::to_string(number) + ": expected " + expected +
                                     ", found " + excerpt(line));
  };
  std::getline(stream, line);
  const auto counts =
      line.starts_with("voxel ") ? three(std::string_view(line).substr(6)) : std::nullopt;
  if (!counts || *std::min_element(counts->begin(), counts->end()) < 1) {
    refuse("'voxel' and three counts of at least 1");
  }
  const double cells_asked = double((*counts)[0]) * (*counts)[1] * (*counts)[2];
  if (cells_asked > double(params.max_cells)) {
    throw ParameterError("max_cells", file + ": declares " + std::to_string((*counts)[0]) + " x " +
                                          std::to_string((*counts)[1]) + " x " +
                                          std::to_string((*counts)[2]) +
                                          " voxels, more than max_cells");
  }
  GridSpec spec;
  spec.cell = Vec3::Constant(params.cell_m);
  spec.counts = *counts;
  spec.rule = GridSpec::Rule::native;
  VoxelGrid cells(spec);
  while (++number, std::getline(stream, line)) {
    if (line.find_first_not_of(" \r\t") == line.npos) {
      continue;
    }
    const auto cell = three(line);
    if (!cell || !spec.holds(*cell)) {
      refuse("a voxel 'x y z' within the counts");
    }
    cells.set(*cell, true);
  }
  return cells;
}

class VoxelMap final : public kit::CellLayer {
 public:
  VoxelMap(const Params& params, const Site&) : CellLayer(read(params)) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "voxel_map", VoxelMap, Params,
                "a voxel map in the format of the Warframe benchmarks")
