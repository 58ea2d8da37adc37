// SPDX-License-Identifier: Apache-2.0
// Ground of the scenarios of a published benchmark of multi-objective searches.
//
// Citation: D. Darlan, O. S. Ajani, A. Paul, R. Mallipeddi: A multi-objective benchmark for UAV
//   path planning with baseline results. Swarm and Evolutionary Computation, 2025; files and their
//   fields by the authors' program (github.com/Anomaly33/UAV-Path-Planning-Benchmark).
// Deviations: the program looks up the highest of the four posts around a waypoint; here the ground
//   between posts is bilinear, and whole legs count.
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/mat_file.hpp"
#include "altiplan/kit/layers/field_layer.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  Path file;

  void describe(Fields& f) {
    f("file", file).doc("MAT-file (level 5) with the structure terrainStruct").required();
  }
};

HeightField field_of(const std::string& file) {
  const auto fail = [&](const std::string& why) -> formats::InputError { return {file, why}; };
  const auto fields = formats::read_mat_structure(file, "terrainStruct");
  const auto numbers = [&](const char* name) -> const formats::MatArray& {
    const auto found = fields.find(name);
    if (found == fields.end()) {
      throw fail(std::string("terrainStruct has no numbers '") + name + "'");
    }
    return found->second;
  };
  const std::vector<double>& x = numbers("X").values;
  const std::vector<double>& y = numbers("Y").values;
  const formats::MatArray& heights = numbers("H");
  if (heights.rows != y.size() || heights.columns != x.size() || x.size() < 2 || y.size() < 2) {
    throw fail("expected H with a row for each of Y and a column for each of X, two at least");
  }
  for (const auto& [places, name] : {std::pair(&x, "X"), std::pair(&y, "Y")}) {
    const double step = (*places)[1] - (*places)[0];
    for (std::size_t i = 0; i < places->size(); ++i) {
      if (!(step > 0) || (*places)[i] != (*places)[0] + double(i) * step) {
        throw fail(std::string(name) + " is not evenly spaced and ascending");
      }
    }
  }
  std::vector<float> posts;
  for (std::size_t row = 0; row < heights.rows; ++row) {
    for (std::size_t column = 0; column < heights.columns; ++column) {
      posts.push_back(float(heights.values[column * heights.rows + row]));
    }
  }
  return {{x[0], y[0]}, {x[1] - x[0], y[1] - y[0]}, int(x.size()), int(y.size()), std::move(posts)};
}

class MatTerrain final : public kit::FieldLayer<kit::WholeField> {
 public:
  MatTerrain(const Params& params, const Site& site)
      : FieldLayer(site.vehicle.radius_m, field_of(params.file.text)) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "mat_terrain", MatTerrain, Params,
                "ground of the MOEA benchmark's MAT-files")
