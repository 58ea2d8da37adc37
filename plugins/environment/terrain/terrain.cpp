// SPDX-License-Identifier: Apache-2.0
// Ground from an elevation model in a file: the layer of the kit over a model that is read in part.
#include <cmath>
#include <cstdio>

#include "altiplan/kit/layers/field_layer.hpp"
#include "altiplan/plugin.hpp"
#include "model.hpp"

namespace {
using namespace altiplan;

std::string text(const char* format, auto... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

class Terrain final : public kit::FieldLayer<terrain::Model> {
 public:
  Terrain(const terrain::Params& params, const Site& site)
      : FieldLayer(site.vehicle.radius_m, params, site) {
    info_.frame = model().layout().frame;
    info_.notes = notes(params.voids);
  }

 private:
  const LayerInfo& do_info() const override { return info_; }

  std::vector<std::string> notes(terrain::Voids voids_rule) const {
    const HeightField& field = model().field();
    const terrain::Layout& layout = model().layout();
    std::vector<std::string> notes;
    std::string voids = "no voids";
    if (model().voids() > 0) {
      voids = std::to_string(model().voids()) + " voids " +
              (voids_rule == terrain::Voids::fill_m ? "filled with fill_m"
                                                    : "filled from their neighbours");
    }
    const bool is_part = field.columns() < layout.columns || field.rows() < layout.rows;
    notes.push_back(
        text("%d x %d posts of %.1f x %.1f m, ", is_part ? layout.columns : field.columns(),
             is_part ? layout.rows : field.rows(), field.spacing()[0], field.spacing()[1]) +
        (is_part ? text("%d x %d of them read, around the volume, ", field.columns(), field.rows())
                 : "") +
        text("%.0f to %.0f m, ", field.min_height(), field.max_height()) + voids);
    if (model().joined()) {
      notes.push_back("joined to the ground of the preceding layers, a post's spacing away");
    }
    if (layout.resampled) {
      const terrain::Dem& dem = model().dem();
      notes.push_back("resampled (bilinear) from " + std::to_string(dem.columns) + " x " +
                      std::to_string(dem.rows) + " posts in " + dem.crs_name + " to " +
                      layout.frame.crs());
    }
    notes.push_back(
        text("scale error at most %.2g %% in ", 100 * layout.frame.scale_error(model().bounds())) +
        layout.frame.crs());
    const std::string& datum = model().dem().datum;
    notes.push_back(model().dem().above_ellipsoid
                        ? "heights above the ellipsoid, brought to sea level by the geoid (EGM96)"
                    : datum.empty() ? "heights without a datum, taken as above sea level"
                                    : "heights above the zero of '" + datum + "'");
    notes.push_back(own_extent(model().dem()));
    notes.push_back((layout.resampled ? "the rectangle of that frame which it covers: " : "") +
                    extent(layout.frame));
    return notes;
  }

  /// "in EPSG:32632 (WGS 84 / UTM zone 32N): x 562125 to 624875, y 5134250 to 5182500"
  static std::string own_extent(const terrain::Dem& dem) {
    const char* range =
        dem.geographic ? "x %.6f to %.6f, y %.6f to %.6f" : "x %.2f to %.2f, y %.2f to %.2f";
    const auto& [x, y] = dem.south_west;
    return "in " +
           (dem.crs_code.empty() ? dem.crs_name : dem.crs_code + " (" + dem.crs_name + ")") + ": " +
           text(range, x, x + (dem.columns - 1) * dem.step[0], y, y + (dem.rows - 1) * dem.step[1]);
  }

  /// Of the posts, in local metres and in degrees.
  std::string extent(const Frame& frame) const {
    const Vec3& low = model().bounds().min;
    const Vec3& high = model().bounds().max;
    const std::string metres =
        text("x %.0f to %.0f m, y %.0f to %.0f m", low.x(), high.x(), low.y(), high.y());
    if (!frame.has_position()) {
      return metres;
    }
    const Box degrees = frame.degrees({Vec3(low.x(), low.y(), 0), Vec3(high.x(), high.y(), 0)});
    return metres + text("; longitude %.4f to %.4f, latitude %.4f to %.4f", degrees.min.x(),
                         degrees.max.x(), degrees.min.y(), degrees.max.y());
  }

  LayerInfo info_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "terrain", Terrain, terrain::Params,
                "ground from an elevation model (GeoTIFF, SRTM, DTED, ESRI ASCII, ENVI)")
