// SPDX-License-Identifier: Apache-2.0
#include "host/base/shapes.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"

namespace altiplan::host {
namespace {

/// Vertical limits of an upright solid; unlimited if not given.
struct Heights {
  std::optional<double> floor_m;
  std::optional<double> ceiling_m;

  void describe(Fields& f) {
    f("floor_m", floor_m).unit("m").doc("lower end above sea level; default: none");
    f("ceiling_m", ceiling_m).unit("m").doc("upper end above sea level; default: none");
    f.check(!floor_m || !ceiling_m || *floor_m < *ceiling_m, "expected floor_m below ceiling_m");
  }
  double floor() const { return floor_m.value_or(-kInfinity); }
  double ceiling() const { return ceiling_m.value_or(kInfinity); }
};

struct SphereParams {
  Point centre;
  double radius_m = 0;
  void describe(Fields& f) {
    f.point(centre).required().doc("centre");
    f("radius_m", radius_m).unit("m").greater_than(0).required().doc("radius");
    f.check(centre.has_height || centre.above_ground_m || centre.form == Point::Form::cell,
            "a sphere's centre needs a height: a third coordinate, or above_ground_m");
  }
  Shape shape(const Site& site) const { return Sphere{site.resolve(centre), radius_m}; }
};

struct CylinderParams {
  Point axis;
  double radius_m = 0;
  Heights heights;
  void describe(Fields& f) {
    f.point(axis).required().doc("a point on the vertical axis");
    f("radius_m", radius_m).unit("m").greater_than(0).required().doc("radius");
    heights.describe(f);
  }
  Shape shape(const Site& site) const {
    const Vec3 at = site.resolve(axis);
    return Cylinder{at.x(), at.y(), radius_m, heights.floor(), heights.ceiling()};
  }
};

struct BoxParams {
  Vec3 min_m{0, 0, 0};
  Vec3 max_m{0, 0, 0};
  void describe(Fields& f) {
    f("min_m", min_m).unit("m").required().doc("lower corner");
    f("max_m", max_m).unit("m").required().doc("upper corner");
    f.check((min_m.array() < max_m.array()).all(), "expected min_m below max_m on each axis");
  }
  Shape shape(const Site&) const { return BoxShape{{min_m, max_m}}; }
};

struct PrismParams {
  std::vector<std::array<double, 2>> outline_m;
  std::vector<std::array<double, 2>> outline_lonlat;
  Heights heights;
  void describe(Fields& f) {
    f("outline_m", outline_m).unit("m").doc("corners of the polygon in order, east and north");
    f("outline_lonlat", outline_lonlat).unit("deg").doc("or longitude and latitude");
    heights.describe(f);
    f.check(outline_m.empty() != outline_lonlat.empty(),
            "expected either outline_m or outline_lonlat");
    f.check(outline_m.size() + outline_lonlat.size() >= 3, "expected at least three corners");
  }
  std::vector<Shape> shapes(const Site& site) const {
    std::vector<formats::Polygon> polygons{{outline_m, {}}};
    if (!outline_lonlat.empty()) {
      polygons =
          formats::in_frame(formats::unfolded(formats::Polygon{outline_lonlat, {}}), site.frame);
    }
    std::vector<Shape> prisms;
    for (formats::Polygon& polygon : polygons) {
      prisms.push_back(Prism{std::move(polygon.outline), {}, heights.floor(), heights.ceiling()});
    }
    return prisms;
  }
  /// One that moves.
  Shape shape(const Site& site) const {
    const std::vector<Shape> parts = shapes(site);
    if (parts.size() != 1) {
      throw Error(
          "outline_lonlat: expected a polygon near the other layers, on one side of the Earth");
    }
    return parts.front();
  }
};

template <class Params>
class OneShape final : public kit::ShapeLayer {
 public:
  OneShape(const Params& params, const Site& site) : ShapeLayer({params.shape(site)}) {}
};

class PrismLayer final : public kit::ShapeLayer {
 public:
  PrismLayer(const PrismParams& params, const Site& site) : ShapeLayer(params.shapes(site)) {}
};

constexpr PluginEntry kEnvironments[] = {
    detail::make_entry<Environment, OneShape<SphereParams>, SphereParams>("sphere", "a sphere"),
    detail::make_entry<Environment, OneShape<CylinderParams>, CylinderParams>(
        "cylinder", "an upright cylinder"),
    detail::make_entry<Environment, OneShape<BoxParams>, BoxParams>("box", "an axis-aligned box"),
    detail::make_entry<Environment, PrismLayer, PrismParams>("prism",
                                                             "an upright prism over a polygon")};

/// m/s; beyond this, positions at the end of a long flight overflow.
constexpr double kMaxSpeed = 1e6;

template <class Params>
struct Moving {
  Params params;
  Vec3 velocity_mps{0, 0, 0};
  void describe(Fields& f) {
    params.describe(f);
    f("velocity_mps", velocity_mps).unit("m/s").required().doc("east, north, up");
    f.check((velocity_mps.array().abs() <= kMaxSpeed).all(),
            "expected each component of velocity_mps from -1e6 to 1e6 m/s");
  }
};

template <class Params>
MovingShape make(const Value& parameters, const Site& site) {
  Moving<Params> moving;
  bind(moving, &parameters);
  return {moving.params.shape(site), moving.velocity_mps};
}

struct MovingKind {
  const char* name;
  DescribeMoving describe;
  MovingShape (*make)(const Value& parameters, const Site& site);
};
constexpr MovingKind kMoving[] = {
    {"sphere", &detail::describe<Moving<SphereParams>>, &make<SphereParams>},
    {"cylinder", &detail::describe<Moving<CylinderParams>>, &make<CylinderParams>},
    {"box", &detail::describe<Moving<BoxParams>>, &make<BoxParams>},
    {"prism", &detail::describe<Moving<PrismParams>>, &make<PrismParams>}};

const MovingKind* find_moving(std::string_view name) {
  const auto* found = std::find_if(std::begin(kMoving), std::end(kMoving),
                                   [&](const MovingKind& kind) { return name == kind.name; });
  return found == std::end(kMoving) ? nullptr : found;
}
}  // namespace

std::span<const PluginEntry> built_in_environments() { return kEnvironments; }

std::vector<std::string> moving_shapes() {
  std::vector<std::string> names;
  for (const MovingKind& kind : kMoving) {
    names.emplace_back(kind.name);
  }
  return names;
}

DescribeMoving describe_moving(std::string_view name) {
  if (name == "random") {
    return &detail::describe<RandomMoving>;
  }
  const MovingKind* kind = find_moving(name);
  return kind == nullptr ? nullptr : kind->describe;
}

MovingShape make_moving(std::string_view name, const Value& parameters, const Site& site) {
  return find_moving(name)->make(parameters, site);
}

void RandomMoving::describe(Fields& f) {
  f("count", count).range(1, 100000).doc("number of spheres");
  f("seed", seed).at_least(0).doc("default: the run's seed");
  f("radius_m", radius_m).unit("m").greater_than(0).required().doc("radius of each sphere");
  f("speed_mps", speed_mps).unit("m/s").range(0, kMaxSpeed).required().doc("speed of each sphere");
}
}  // namespace altiplan::host
