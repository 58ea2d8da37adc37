// SPDX-License-Identifier: Apache-2.0
//
// Ground from an elevation model. Heights stand at the posts and are bilinear between them; beyond
// the posts nothing is known, and everything is blocked.
//
// The slope bounds every answer: where it is at most s within a distance d of a point at height v
// above its ground, the ground is at least min(d, v / sqrt(1 + s²)) away.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "altiplan/kit/ground.hpp"
#include "altiplan/plugin.hpp"
#include "place.hpp"

namespace {
using namespace altiplan;

std::string text(const char* format, auto... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

class Terrain final : public Environment {
 public:
  Terrain(const terrain::Params& params, const Site& site)
      : Terrain(params, site, terrain::read_dem(params)) {}

 private:
  Terrain(const terrain::Params& params, const Site& site, terrain::Dem dem)
      : voids_(dem.voids),
        voids_rule_(params.voids),
        source_(std::to_string(dem.columns) + " x " + std::to_string(dem.rows) + " posts in " +
                dem.crs_name),
        placed_(terrain::place(std::move(dem), site, params)),
        field_(placed_.field),
        vehicle_radius_(site.vehicle.radius_m),
        bounds_{{field_.origin()[0], field_.origin()[1], -kInfinity},
                {field_.origin()[0] + (field_.columns() - 1) * field_.spacing()[0],
                 field_.origin()[1] + (field_.rows() - 1) * field_.spacing()[1], kInfinity}} {}

  /// Horizontal distance to the edge of the posts, negative beyond it.
  double edge(const Vec3& p) const {
    const Vec3 low = p - bounds_.min;
    const Vec3 high = bounds_.max - p;
    const double inside = std::min({low.x(), high.x(), low.y(), high.y()});
    if (inside >= 0) {
      return inside;
    }
    return -std::hypot(std::max({-low.x(), -high.x(), 0.0}), std::max({-low.y(), -high.y(), 0.0}));
  }
  /// Of the nearest place that has ground.
  double ground_near(double x, double y) const {
    return *field_.at(std::clamp(x, bounds_.min.x(), bounds_.max.x()),
                      std::clamp(y, bounds_.min.y(), bounds_.max.y()));
  }

  Box do_bounds() const override { return bounds_; }
  bool do_has_ground() const override { return true; }
  std::optional<double> do_ground(double x, double y) const override { return field_.at(x, y); }
  double do_ground_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return field_.gap(a, b, enough);
  }
  double do_ground_gap_max(const Vec3& a, const Vec3& b) const override {
    return field_.gap_max(a, b);
  }
  double do_ground_slope(const Box& box) const override {
    return field_.void_posts() > 0
               ? kInfinity
               : field_.max_slope(box.min.x(), box.min.y(), box.max.x(), box.max.y());
  }
  std::optional<Frame> do_frame() const override { return placed_.frame; }

  double do_clearance(const Vec3& p) const override {
    const double above = (p.z() - ground_near(p.x(), p.y())) / std::hypot(1, field_.max_slope());
    return std::min(std::max(above, p.z() - field_.max_height()), edge(p));
  }

  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    const double keep = r - kLengthTolerance;
    if (std::min(edge(a), edge(b)) < keep) {  // least at an end: the posts' rectangle is convex
      return true;
    }
    if (std::min(a.z(), b.z()) - field_.max_height() >= keep) {
      return false;
    }
    const auto gap = [&](const Vec3& from, const Vec3& to, double enough) {
      return field_.gap(from, to, enough);
    };
    const auto slope = [&](const Vec3& from, const Vec3& to, double within) {
      const Box box = leg_box(from, to).grown(within);
      return field_.max_slope(box.min.x(), box.min.y(), box.max.x(), box.max.y());
    };
    return kit::too_near_ground(a, b, r, kit::height_for(keep, field_.max_slope()),
                                std::max(field_.spacing()[0], field_.spacing()[1]), gap, slope);
  }

  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    constexpr int kGround = 0;
    constexpr int kEdge = 1;
    near_edge(p, reach, sink, kEdge);
    const double x = std::clamp(p.x(), bounds_.min.x(), bounds_.max.x());
    const double y = std::clamp(p.y(), bounds_.min.y(), bounds_.max.y());
    const double gap = p.z() - ground_near(x, y);
    if (gap <= kLengthTolerance) {
      // The way out is up; the depth is a lower bound, as clearance has it.
      sink({{x, y, p.z() - gap}, gap / std::hypot(1, field_.max_slope()), {0, 0, 1}, kGround});
      return;
    }
    if (p.z() - field_.max_height() > reach) {
      return;
    }
    const auto ground = [&](double at_x, double at_y) { return ground_near(at_x, at_y); };
    const auto highest = [&](double x0, double y0, double x1, double y1) {
      return field_.max_height(x0, y0, x1, y1);
    };
    const kit::NearestGround nearest({x, y, p.z()}, bounds_, ground, highest);
    const double distance = (p - nearest.point()).norm();
    if (distance <= reach) {
      sink({nearest.point(), distance, (p - nearest.point()) / distance, kGround});
    }
  }

  /// The end of what is known is an obstacle too: a wall of any height.
  void near_edge(const Vec3& p, double reach, const NearSink& sink, int id) const {
    const double distance = edge(p);
    if (distance > reach) {
      return;
    }
    Vec3 point(std::clamp(p.x(), bounds_.min.x(), bounds_.max.x()),
               std::clamp(p.y(), bounds_.min.y(), bounds_.max.y()), p.z());
    Vec3 normal = point - p;
    if (distance >= 0) {
      for (int axis = 0; axis < 2; ++axis) {
        for (const double side : {bounds_.min[axis], bounds_.max[axis]}) {
          if (std::abs(p[axis] - side) == distance) {
            point = p;
            point[axis] = side;
            normal = Vec3::Zero();
            normal[axis] = side == bounds_.min[axis] ? 1 : -1;
          }
        }
      }
    }
    sink({point, distance, normal.normalized(), id});
  }

  void do_rasterize(VoxelGrid& grid) const override {
    kit::rasterize_ground(grid, [this](double x0, double y0, double x1, double y1) {
      return field_.max_height(x0, y0, x1, y1);
    });
  }

  // A sphere of the vehicle's size may be kept off by the slope though the ground is a little
  // farther away than its radius.
  double do_slack() const override {
    return vehicle_radius_ * (std::hypot(1, field_.max_slope()) - 1);
  }

  std::vector<std::string> do_notes() const override {
    std::vector<std::string> notes;
    std::string voids = "no voids";
    if (voids_ > 0) {
      voids = std::to_string(voids_) + " voids " +
              (voids_rule_ == terrain::Voids::fill_m ? "filled with fill_m"
                                                     : "filled from their neighbours");
    }
    notes.push_back(text("%d x %d posts of %.1f x %.1f m, %.0f to %.0f m, ", field_.columns(),
                         field_.rows(), field_.spacing()[0], field_.spacing()[1],
                         field_.min_height(), field_.max_height()) +
                    voids);
    if (placed_.resampled) {
      notes.push_back("resampled (bilinear) from " + source_ + " to " + placed_.frame.crs());
    }
    notes.push_back(
        text("scale error at most %.2g %% in ", 100 * placed_.frame.scale_error(bounds_)) +
        placed_.frame.crs());
    return notes;
  }

  std::size_t voids_;
  terrain::Voids voids_rule_;
  std::string source_;
  terrain::Placed placed_;
  const HeightField& field_;
  double vehicle_radius_;
  Box bounds_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "terrain", Terrain, terrain::Params,
                "ground from an elevation model (GeoTIFF, SRTM, DTED, ESRI ASCII, ENVI)")
