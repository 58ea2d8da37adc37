// SPDX-License-Identifier: Apache-2.0
#include "altiplan/world.hpp"
#include "probe.hpp"

namespace altiplan::conformance {
namespace {

using Rule = GridSpec::Rule;

/// A grid over most of the volume, and a small one around a point of the layer.
std::vector<GridSpec> grids(Probe& probe) {
  const Vec3 edges = probe.volume().max - probe.volume().min;
  GridSpec large;
  large.origin = probe.volume().min - 0.03 * edges;
  large.counts = {17, 15, 11};
  large.cell = edges.cwiseQuotient(Vec3(17.3, 14.1, 10.7));
  GridSpec small;
  small.counts = {12, 13, 14};
  small.cell = 0.01 * edges;
  small.origin = probe.point() - 6 * small.cell;
  return {large, small};
}

/// Points of the solid, grown by the inflation, in cells that stayed free.
void touched(const VoxelGrid& grid, Probe& probe, int samples, Report& report) {
  const GridSpec& spec = grid.spec();
  for (int n = 0; n < samples; ++n) {
    const Vec3 near = probe.around(probe.point(), spec.inflation);
    const Vec3 p = n % 2 == 0 && spec.box().contains(near) ? near : probe.random().in(spec.box());
    const Cell cell = spec.cell_of(p);
    if (!spec.holds(cell) || grid.blocked(cell)) {
      continue;
    }
    // The open cell: no point of its faces counts.
    const Box box = spec.cell_box(cell);
    if (((p - box.min).array() < kDeep).any() || ((box.max - p).array() < kDeep).any()) {
      continue;
    }
    const Vec3 q = probe.around(p, spec.inflation);
    const bool solid =
        probe.inside(p) || (probe.inside(q) && (q - p).norm() < spec.inflation - kDeep);
    report.expect(!solid, kEnvironmentRaster, [&] {
      return "rule touched, inflation " + text(spec.inflation) + ": the cell of " + text(p) +
             " stayed free, and " + text(q) + " or itself lies inside the layer";
    });
  }
}

void centres(const VoxelGrid& grid, Probe& probe, Report& report) {
  const GridSpec& spec = grid.spec();
  for (std::size_t n = 0; n < spec.cell_count(); ++n) {
    const Cell cell{int(n) % spec.counts[0], int(n) / spec.counts[0] % spec.counts[1],
                    int(n) / (spec.counts[0] * spec.counts[1])};
    const Vec3 p = spec.centre(cell);
    const Vec3 q = probe.around(p, spec.inflation);
    const bool solid =
        probe.inside(p) || (probe.inside(q) && (q - p).norm() < spec.inflation - kDeep);
    report.expect(grid.blocked(cell) || !solid, kEnvironmentRaster, [&] {
      return "rule centre, inflation " + text(spec.inflation) + ": the cell at " + text(p) +
             " stayed free, and " + text(q) + " or itself lies inside the layer";
    });
  }
}

void rasters(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "raster");
  for (int n = 0; n < 1 + bench.options.rounds / 6; ++n) {
    for (GridSpec spec : grids(probe)) {
      for (const double inflation : {0.0, 0.7 * spec.cell.minCoeff(), 2.3 * spec.cell.minCoeff()}) {
        spec.inflation = inflation;
        spec.rule = Rule::touched;
        VoxelGrid grid(spec);
        probe.layer().rasterize(grid);
        touched(grid, probe, 4000, report);
        spec.rule = Rule::centre;
        VoxelGrid by_centre(spec);
        probe.layer().rasterize(by_centre);
        centres(by_centre, probe, report);
      }
    }
  }
  if (auto native = probe.layer().info().native_grid) {
    native->rule = Rule::native;
    VoxelGrid grid(*native);
    probe.layer().rasterize(grid);
    native->inflation = 0;
    centres(grid, probe, report);
  }
}

/// Layers are rasterized into the same grid: blocked cells stay blocked, and the result is
/// reproducible.
void drawn_over(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "raster twice");
  for (const GridSpec& spec : grids(probe)) {
    VoxelGrid full(spec);
    for (int k = 0; k < spec.counts[2]; ++k) {
      for (int j = 0; j < spec.counts[1]; ++j) {
        full.block_run(0, spec.counts[0] - 1, j, k);
      }
    }
    probe.layer().rasterize(full);
    report.expect(full.blocked_count() == spec.cell_count(), kEnvironmentRaster,
                  [] { return "rasterize frees cells that another layer had blocked"; });
    VoxelGrid one(spec);
    VoxelGrid other(spec);
    probe.layer().rasterize(one);
    bench.make(bench.site())->rasterize(other);
    report.expect(VoxelGrid::diff(one, other).empty(), kEnvironmentPure,
                  [] { return "two objects of one Site rasterize differently"; });
  }
}
}  // namespace

Cases environment_grid_cases(const EnvironmentBench& bench) {
  return cases_on(
      bench, kEnvironmentPure,
      {{"rasterize_leaves_nothing_out", rasters}, {"rasterize_draws_over", drawn_over}});
}
}  // namespace altiplan::conformance
