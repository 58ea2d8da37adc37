// SPDX-License-Identifier: Apache-2.0
// Cities: generated from a seed (paper 003, section 4), or read from footprints, CityJSON or the
// colliders of a simulator.
#include <algorithm>

#include "altiplan/environment.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/plugin.hpp"
#include "buildings.hpp"
#include "generator.hpp"

namespace altiplan::city {
namespace {

enum class Source { file, simple, complex };

struct Params {
  std::optional<Path> file;
  Source generate = Source::file;
  std::optional<std::int64_t> seed;
  Vec3 cells{80, 80, 100};
  double cell_m = 10;
  int buildings = 60;
  std::int64_t max_cells = 4'000'000'000;
  Heights heights;
  double base_m = 0;
  std::optional<std::array<double, 2>> origin_m;
  std::string attribution;

  void describe(Fields& f) {
    f("generate", generate,
      {{"nothing", Source::file}, {"simple", Source::simple}, {"complex", Source::complex}})
        .doc("generate a city of paper 003: blocks along streets (simple), or anywhere (complex)");
    f("seed", seed).at_least(0).doc("random seed of the city; default: the run's seed");
    f("cells", cells).at_least(10).doc("cells of a generated city along x, y and z");
    f("cell_m", cell_m).unit("m").range(0.001, 1e6).doc("edge length of its cells");
    f("buildings", buildings).at_least(0).doc("number of buildings in a complex city");
    f("max_cells", max_cells)
        .at_least(1)
        .doc("a generated city with more cells is rejected before anything is allocated");
    f("file", file)
        .doc(
            "buildings: GeoJSON footprints in WGS 84, CityJSON, or the .csv colliders of a "
            "simulator");
    f("height_property", heights.height_property)
        .doc("the footprints' property with the height above ground, m");
    f("levels_property", heights.levels_property)
        .doc("the property with the number of levels, for footprints without a height");
    f("metres_per_level", heights.metres_per_level)
        .unit("m")
        .greater_than(0)
        .doc("height of each level");
    f("default_height_m", heights.default_height_m)
        .unit("m")
        .greater_than(0)
        .doc("height of footprints that have neither; if omitted, such a file is rejected");
    f("base_m", base_m)
        .unit("m")
        .doc(
            "height of the footprints above sea level, if no preceding layer has ground below "
            "them");
    f("origin_m", origin_m)
        .unit("m")
        .doc(
            "the point [x, y] in a CityJSON file's metres that becomes (0, 0) here; default: its "
            "coordinate system tells, or in a world without a frame the south-west corner of its "
            "buildings");
    f("attribution", attribution)
        .doc(
            "source to credit in pictures of the city, such as '© OpenStreetMap contributors, "
            "ODbL'");
    f.check(file.has_value() == (generate == Source::file),
            "give either file, or generate: simple or complex");
  }
};

class City final : public Environment {
 public:
  City(const Params& params, const Site& site) {
    if (params.generate == Source::file) {
      try {
        read(params, site);
      } catch (const Error& error) {
        throw ParameterError("file", error.what());
      }
    } else {
      draw(params, site);
    }
    if (!params.attribution.empty()) {
      info_.notes.push_back("attribution: " + params.attribution);
    }
  }

 private:
  void draw(const Params& params, const Site& site) {
    Draw draw;
    draw.kind = params.generate == Source::simple ? Kind::simple : Kind::complex;
    RandomStream of_run = site.random;
    draw.seed = params.seed ? std::uint64_t(*params.seed) : of_run();
    double total = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (params.cells[axis] != std::floor(params.cells[axis])) {
        throw ParameterError("cells", "expected whole numbers");
      }
      total *= params.cells[axis];
      draw.cells[std::size_t(axis)] = int(std::min(params.cells[axis], 1e9));
    }
    if (total > double(params.max_cells)) {
      throw ParameterError("cells", "more cells than max_cells allows");
    }
    draw.cell_m = params.cell_m;
    draw.buildings = params.buildings;
    draw.start = site.start;
    draw.goal = site.goal;
    auto cells = std::make_unique<kit::CellLayer>(draw_city(draw));
    info_.native_grid = cells->cells().spec();
    info_.notes.push_back(std::to_string(cells->cells().blocked_count()) + " of " +
                          std::to_string(cells->cells().spec().cell_count()) + " cells blocked");
    if (!site.start || !site.goal) {
      info_.notes.push_back("start and goal are kept free only if they are given as at_m");
    }
    layer_ = std::move(cells);
    drawing_ = layer_->drawing().value();
  }

  void read(const Params& params, const Site& site) {
    const std::string& file = params.file->text;
    Buildings buildings = formats::ending_of(file) == ".csv" ? read_colliders(file, site)
                          : is_city_json(file)
                              ? read_city_json(file, params.origin_m, site)
                              : read_footprints(file, params.heights, params.base_m, site);
    std::vector<Shape> shapes;
    for (Building& building : buildings.list) {
      shapes.push_back(building.shape);
      drawing_.shapes.push_back(
          {std::move(building.shape), Drawn::Role::obstacle, std::move(building.name)});
    }
    layer_ = std::make_unique<kit::ShapeLayer>(std::move(shapes));
    info_.notes = std::move(buildings.notes);
    info_.frame = std::move(buildings.frame);
  }

  Box do_bounds() const override { return layer_->bounds(); }
  double do_clearance(const Vec3& p) const override { return layer_->clearance(p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return layer_->blocked(a, b, r);
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    layer_->near(p, reach, sink);
  }
  void do_rasterize(VoxelGrid& grid) const override { layer_->rasterize(grid); }
  double do_over_approximation() const override { return layer_->over_approximation(); }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return layer_->cell_centre(cell);
  }
  std::optional<Drawing> do_drawing() const override { return drawing_; }
  bool do_meets(const SweptVolume& volume) const override { return layer_->meets(volume); }

  std::unique_ptr<Environment> layer_;
  LayerInfo info_;
  Drawing drawing_;
};
}  // namespace
}  // namespace altiplan::city

ALTIPLAN_PLUGIN(Environment, "city", altiplan::city::City, altiplan::city::Params,
                "buildings: generated cities, GeoJSON footprints, CityJSON, simulator colliders")
