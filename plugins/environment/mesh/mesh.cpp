// SPDX-License-Identifier: Apache-2.0
// A closed triangle mesh as a solid.
#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

#include "altiplan/environment.hpp"
#include "altiplan/kit/layers/solid.hpp"
#include "altiplan/plugin.hpp"
#include "model.hpp"
#include "surface.hpp"

namespace altiplan::mesh {
namespace {

/// Distances below this are rounding errors: the leg touches the surface.
constexpr double kMeets = 1e-9;
constexpr double kFarthest = 1e7;

enum class Up { z, y };

struct Params {
  Path file;
  double scale = 1;
  Up up = Up::z;
  double heading_deg = 0;
  Point at;
  double weld_m = 1e-4;
  std::int64_t max_triangles = 1'000'000;

  void describe(Fields& f) {
    f("file", file).doc("closed surface: STL (ASCII or binary) or OBJ").required();
    f("scale", scale).greater_than(0).doc("metres per unit of the file");
    f("up", up, {{"z", Up::z}, {"y", Up::y}})
        .doc("the file's axis that points up; with y its -z points north");
    f("heading_deg", heading_deg)
        .range(-360, 360)
        .doc("rotation of the model about its origin, clockwise as seen from above");
    f.point(at).doc("position of the model's origin; default: [0, 0, 0]");
    f("weld_m", weld_m)
        .unit("m")
        .range(0, 1)
        .doc("corners at most this far apart are merged; they move by no more");
    f("max_triangles", max_triangles)
        .range(1, 100'000'000)
        .doc("a file with more triangles is rejected before they are built");
  }
};

/// From the file's coordinates to the world's.
struct Placement {
  Eigen::Matrix3d turn;
  double scale;
  Vec3 at;

  Placement(const Params& params, const Site& site) : scale(params.scale), at(0, 0, 0) {
    const double angle = radians(params.heading_deg);
    double sine = std::sin(angle);
    double cosine = std::cos(angle);
    if (std::fmod(params.heading_deg, 90) == 0) {  // axis-aligned parts stay exactly so
      sine = std::round(sine);
      cosine = std::round(cosine);
    }
    turn << cosine, sine, 0, -sine, cosine, 0, 0, 0, 1;
    if (params.up == Up::y) {
      Eigen::Matrix3d rise;
      rise << 1, 0, 0, 0, 0, -1, 0, 1, 0;
      turn = turn * rise;
    }
    if (params.at.form != Point::Form::none) {
      at = site.resolve(params.at);
      if (!params.at.has_height && !params.at.above_ground_m &&
          params.at.form != Point::Form::cell) {
        throw Error("a mesh needs the height of its origin: a third number or above_ground_m");
      }
    }
  }
  Vec3 operator()(const Vec3& corner) const { return at + scale * (turn * corner); }
};

std::string text(const Vec3& p) {
  std::ostringstream out;
  out << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return out.str();
}

struct Solid {
  std::vector<Triangle> triangles;
  std::string note;
};

Solid read(const Params& params, const Site& site) {
  const Placement place(params, site);
  const std::string& file = params.file.text;
  Model model = read_model(file, params.max_triangles);
  const std::size_t dropped = weld(model, params.weld_m / params.scale);
  if (model.triangles.empty()) {
    throw ParameterError("weld_m", file + ": all of its triangles are smaller than weld_m");
  }
  std::size_t shells = 0;
  try {
    shells = check_closed(model, [](const Vec3& corner) { return text(corner); });
  } catch (const Error& error) {
    throw ParameterError("file", file + ": " + error.what());
  }
  Solid solid;
  solid.triangles.reserve(model.triangles.size());
  for (const auto& t : model.triangles) {
    solid.triangles.push_back(
        {place(model.corners[t[0]]), place(model.corners[t[1]]), place(model.corners[t[2]])});
    for (const Vec3& corner : solid.triangles.back()) {
      if (!is_finite(corner) || corner.cwiseAbs().maxCoeff() > kFarthest) {
        throw ParameterError("file", file + ": reaches to " + text(corner) +
                                         ", farther than 10,000 km; check `scale`");
      }
    }
  }
  solid.note = std::to_string(solid.triangles.size()) + " triangles in " + std::to_string(shells) +
               (shells == 1 ? " closed part, " : " closed parts, ") + std::to_string(dropped) +
               " without area omitted";
  return solid;
}

/// The positions enclosed by the surface, and the surface. Exact: distances to triangles are closed
/// forms.
class Mesh final : public Environment {
 public:
  Mesh(const Params& params, const Site& site) : Mesh(read(params, site)) {}

 private:
  explicit Mesh(Solid solid) : surface_(std::move(solid.triangles)) {
    info_.notes = {std::move(solid.note)};
  }

  Box do_bounds() const override { return surface_.bounds(); }
  double do_over_approximation() const override { return 0; }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Drawing> do_drawing() const override { return Drawing{{}, surface_.triangles()}; }

  double do_clearance(const Vec3& p) const override {
    const double distance = surface_.nearest(p).distance;
    return surface_.winding(p) != 0 ? -distance : distance;
  }

  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    const double limit = r - kLengthTolerance;
    if (a == b) {
      return do_clearance(a) < limit;
    }
    if (limit > kMeets) {
      return surface_.leg_is_nearer(a, b, limit) || surface_.winding(a) != 0;
    }
    return gets_inside(a, b, limit);
  }

  /// True if a point that flies the leg gets inside: touching is free. Between two contacts with
  /// the surface the leg is on one side of it; there it is checked at half the depth used for
  /// points, so that it is never free where a point of it is not.
  bool gets_inside(const Vec3& a, const Vec3& b, double limit) const {
    std::vector<double> places = surface_.meetings(a, b, kMeets);
    places.insert(places.begin(), 0);
    places.push_back(1);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const double along = places[i] + share * (places[i + 1] - places[i]);
        if (do_clearance(a + along * (b - a)) < limit / 2) {
          return true;
        }
      }
    }
    return false;
  }

  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    const Surface::Nearest nearest = surface_.nearest(p);
    const bool inside = surface_.winding(p) != 0;
    const double distance = inside ? -nearest.distance : nearest.distance;
    if (distance > reach) {
      return;
    }
    Vec3 normal = inside ? Vec3(nearest.point - p) : Vec3(p - nearest.point);
    if (!(normal.norm() > kMeets)) {
      const Triangle& t = *nearest.triangle;
      normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
      const bool is_inward = surface_.winding(nearest.point + kLengthTolerance * normal) != 0;
      normal = is_inward ? Vec3(-normal) : normal;
    }
    const double length = normal.norm();
    sink({nearest.point, distance, length > 0 ? Vec3(normal / length) : Vec3(0, 0, 1), 0});
  }

  /// A volume that meets no triangle is wholly inside or wholly outside.
  bool do_meets(const SweptVolume& volume) const override {
    return surface_.meets(volume) || surface_.winding(volume.centre()) != 0;
  }

  void do_rasterize(VoxelGrid& grid) const override {
    kit::rasterize(
        grid, surface_.bounds(), [&](const Vec3& p) { return do_clearance(p); },
        [&](const Box& box, double by) {
          // The open box: its faces do not count.
          return surface_.box_is_nearer(box.grown(-2 * kMeets), std::max(by, kMeets));
        });
  }

  Surface surface_;
  LayerInfo info_;
};
}  // namespace
}  // namespace altiplan::mesh

ALTIPLAN_PLUGIN(Environment, "mesh", altiplan::mesh::Mesh, altiplan::mesh::Params,
                "a closed triangle mesh (STL, OBJ) as a solid")
