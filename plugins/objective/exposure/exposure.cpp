// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "altiplan/environment.hpp"
#include "altiplan/error.hpp"
#include "altiplan/kit/layers/scalar_field.hpp"
#include "altiplan/map_system.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/plugin.hpp"
#include "price.hpp"
#include "raster.hpp"
#include "sampled.hpp"

namespace {
using namespace altiplan;

struct Params {
  Path file;
  std::string crs;
  exposure::Sampled sampled;
  exposure::Price price;
  std::optional<double> elsewhere;
  std::string unit;

  void describe(Fields& f) {
    f("file", file)
        .doc(
            "values per metre, at least 0, at the centres of cells: a GeoTIFF of one band, or an "
            "ESRI ASCII grid");
    f("crs", crs)
        .doc(
            "coordinate system (EPSG:4326) of a file that names none; default: the world's "
            "metres");
    f("layer", sampled.layer)
        .doc("alternatively: the field of the layer with this id, such as a radar's detection");
    f("of", sampled.of)
        .one_of({"clearance", "height_above_ground", "wind_speed"})
        .doc("alternatively: a field of the world: distance to obstacles (m), height (m), m/s");
    f("cell_m", sampled.cell_m)
        .unit("m")
        .at_least(0.001)
        .doc("spacing on each axis of the places where `layer` and `of` are asked; linear between");
    f("price", price.pairs)
        .doc(
            "pairs of a value of the field and its price per metre, at least 0, linear between "
            "them and constant beyond; default: the value itself");
    f("elsewhere", elsewhere)
        .at_least(0)
        .doc(
            "price beyond the file's cells and beside places without a value; default: routes do "
            "not lead there");
    f("unit", unit).doc("unit of a price times a metre, for people");
    f.check(int(!file.text.empty()) + int(!sampled.layer.empty()) + int(!sampled.of.empty()) == 1,
            "expected one of file, layer and of");
    f.check(price.is_in_order(), "expected price as pairs with ascending values, at least 0 each");
    f.check(sampled.of.empty() || sampled.of == "wind_speed" || !price.pairs.empty(),
            "with this field expected price: its values are no prices");
  }
};

/// Brings the centres of a file's cells from its coordinate system to the world's metres. Throws
/// Error where they are no grid there.
void place(exposure::Raster& raster, const Frame& frame) {
  if (raster.crs.empty()) {
    return;
  }
  if (!frame.has_position()) {
    throw Error("is in " + raster.crs +
                ", but the world has no place on the Earth: give frame, or a layer with one");
  }
  const MapSystem system(raster.crs);
  const auto local = [&](double i, double j) {
    const double x = raster.south_west[0] + i * raster.step[0];
    const double y = raster.south_west[1] + j * raster.step[1];
    const auto [lon, lat, height] = system.to_wgs84({x, y, 0});
    return frame.to_local(lon, lat);
  };
  const double last_i = raster.columns - 1;
  const double last_j = raster.rows - 1;
  const std::array<double, 2> origin = local(0, 0);
  const std::array<double, 2> step{(local(last_i, 0)[0] - origin[0]) / last_i,
                                   (local(0, last_j)[1] - origin[1]) / last_j};
  double off = 0;  // in cells
  for (const double i : {0.0, last_i / 2, last_i}) {
    for (const double j : {0.0, last_j / 2, last_j}) {
      const auto [x, y] = local(i, j);
      off = std::max({off, std::abs(x - origin[0] - i * step[0]) / step[0],
                      std::abs(y - origin[1] - j * step[1]) / step[1]});
    }
  }
  constexpr double kOff = 0.05;
  if (!(off <= kOff && step[0] > 0 && step[1] > 0)) {
    throw Error("its cells are no grid in the world's frame (" + frame.crs() +
                "): warp it to that system (gdalwarp -t_srs), or plan in its own (frame: {crs: " +
                raster.crs + "})");
  }
  raster.south_west = origin;
  raster.step = step;
}

kit::ScalarField from_file(const Params& params, const Frame& frame) {
  try {
    const std::string kind = std::filesystem::path(params.file.text).extension().string();
    const bool is_tiff = kind == ".tif" || kind == ".tiff";
    exposure::Raster raster = is_tiff ? exposure::read_tiff(params.file.text)
                                      : exposure::read_text_grid(params.file.text);
    if (!params.crs.empty()) {
      raster.crs = params.crs;
    }
    place(raster, frame);
    params.price.apply(raster.values);
    exposure::expect_costs(raster);
    return {{{raster.south_west[0], raster.south_west[1], 0},
             {raster.step[0], raster.step[1], 1},
             {raster.columns, raster.rows, 1}},
            std::move(raster.values),
            params.elsewhere.value_or(kInfinity)};
  } catch (const Error& error) {
    throw ParameterError("file", params.file.text + ": " + error.what());
  }
}

kit::ScalarField field_of(const Params& params, const Site& site) {
  return params.file.text.empty()
             ? params.sampled.field(site, params.price, params.elsewhere.value_or(kInfinity))
             : from_file(params, site.frame);
}

class Exposure final : public kit::FieldIntegral {
 public:
  Exposure(const Params& params, const Site& site)
      : FieldIntegral(field_of(params, site), params.unit) {}
};
}  // namespace

ALTIPLAN_PLUGIN(
    Objective, "exposure", Exposure, Params,
    "A field, such as risk from a file or a radar's detection, integrated along the route")
