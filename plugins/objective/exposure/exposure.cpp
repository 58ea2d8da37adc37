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
#include "raster.hpp"

namespace {
using namespace altiplan;

struct Params {
  Path file;
  std::string crs;
  std::optional<double> elsewhere;
  std::string unit;

  void describe(Fields& f) {
    f("file", file)
        .required()
        .doc(
            "values per metre, at least 0, at the centres of cells: a GeoTIFF of one band, or an "
            "ESRI ASCII grid");
    f("crs", crs)
        .doc(
            "coordinate system (EPSG:4326) of a file that names none; default: the world's "
            "metres");
    f("elsewhere", elsewhere)
        .at_least(0)
        .doc(
            "value beyond the file's cells and beside those without one; default: routes do not "
            "lead there");
    f("unit", unit).doc("unit of a value times a metre, for people");
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

kit::ScalarField field_of(const Params& params, const Frame& frame) {
  try {
    const std::string kind = std::filesystem::path(params.file.text).extension().string();
    const bool is_tiff = kind == ".tif" || kind == ".tiff";
    exposure::Raster raster = is_tiff ? exposure::read_tiff(params.file.text)
                                      : exposure::read_text_grid(params.file.text);
    if (!params.crs.empty()) {
      raster.crs = params.crs;
    }
    place(raster, frame);
    exposure::expect_costs(raster);
    return {raster.south_west,        raster.step,
            raster.columns,           raster.rows,
            std::move(raster.values), params.elsewhere.value_or(kInfinity)};
  } catch (const Error& error) {
    throw ParameterError("file", params.file.text + ": " + error.what());
  }
}

class Exposure final : public kit::FieldIntegral {
 public:
  Exposure(const Params& params, const Site& site)
      : FieldIntegral(field_of(params, site.frame), params.unit) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "exposure", Exposure, Params,
                "A field of values in a file, such as risk, integrated along the route")
