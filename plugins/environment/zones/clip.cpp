// SPDX-License-Identifier: Apache-2.0
// Compiled with -O1: Boost's overlays take twice as long with -O3, and a zone is cut once.
#include "clip.hpp"

#define BOOST_ALLOW_DEPRECATED_HEADERS  // NOLINT: a name of Boost, whose own headers include some

#include <algorithm>
#include <boost/geometry/algorithms/convert.hpp>
#include <boost/geometry/algorithms/correct.hpp>
#include <boost/geometry/algorithms/difference.hpp>
#include <boost/geometry/algorithms/for_each.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <cstdio>
#include <optional>

#include "altiplan/error.hpp"
#include "altiplan/formats/polygon.hpp"
#include "altiplan/world.hpp"

namespace altiplan::zones {
namespace {

namespace bg = boost::geometry;
using PlanePoint = bg::model::d2::point_xy<double>;
using PlanePolygon = bg::model::polygon<PlanePoint, true, false>;  // clockwise, not closed

PlanePolygon to_boost(const Prism& prism) {
  PlanePolygon polygon;
  for (const auto& p : prism.outline) {
    polygon.outer().emplace_back(p[0], p[1]);
  }
  for (const auto& hole : prism.holes) {
    auto& inner = polygon.inners().emplace_back();
    for (const auto& p : hole) {
      inner.emplace_back(p[0], p[1]);
    }
  }
  bg::correct(polygon);
  return polygon;
}

template <class Ring>
formats::Ring from_boost(const Ring& ring) {
  formats::Ring result;
  for (const PlanePoint& p : ring) {
    result.push_back({p.x(), p.y()});
  }
  return formats::without_repeats(result);
}

/// Prisms over the polygons; false if one of them touches itself.
bool add_prisms(const std::vector<PlanePolygon>& polygons, const Prism& like,
                std::vector<Prism>& to) {
  for (const PlanePolygon& piece : polygons) {
    formats::Polygon polygon{from_boost(piece.outer()), {}};
    for (const auto& hole : piece.inners()) {
      polygon.holes.push_back(from_boost(hole));
    }
    if (!formats::polygon_problem(polygon).empty()) {
      return false;
    }
    to.push_back({polygon.outline, polygon.holes, like.floor, like.ceiling});
  }
  return true;
}

/// Horizontally.
bool is_outside(const Box& box, const Box& bounds) {
  return (box.min.head<2>().array() >= bounds.max.head<2>().array()).any() ||
         (box.max.head<2>().array() <= bounds.min.head<2>().array()).any();
}
bool is_inside(const Box& box, const Box& bounds) {
  return (box.min.head<2>().array() >= bounds.min.head<2>().array()).all() &&
         (box.max.head<2>().array() <= bounds.max.head<2>().array()).all();
}
}  // namespace

namespace {

/// Corners that rounding has put beyond the box.
void keep_in(PlanePolygon& polygon, const Box& box) {
  bg::for_each_point(polygon, [&](PlanePoint& p) {
    p.x(std::clamp(p.x(), box.min.x(), box.max.x()));
    p.y(std::clamp(p.y(), box.min.y(), box.max.y()));
  });
}
}  // namespace

Parts split(const Prism& prism, const Box& box) {
  const Box area = bounds(Shape(prism));
  if (is_inside(area, box)) {
    return {{prism}, {}};
  }
  if (is_outside(area, box)) {
    return {{}, {prism}};
  }
  // Boost takes no infinite coordinates.
  const Box cut = box.intersected(area.grown(1));
  const PlanePolygon polygon = to_boost(prism);
  PlanePolygon rectangle;
  bg::convert(bg::model::box<PlanePoint>({cut.min.x(), cut.min.y()}, {cut.max.x(), cut.max.y()}),
              rectangle);
  std::vector<PlanePolygon> within;
  std::vector<PlanePolygon> beyond;
  bg::intersection(polygon, rectangle, within);
  bg::difference(polygon, rectangle, beyond);
  Parts parts;
  for (PlanePolygon& part : within) {
    keep_in(part, cut);
  }
  return add_prisms(within, prism, parts.within) && add_prisms(beyond, prism, parts.beyond)
             ? parts
             : Parts{{}, {prism}};
}

Clip::Clip(const Site& site, double beyond) : bounds_(site.volume) {
  const Box layers = site.before->bounds();
  for (int axis = 0; axis < 2; ++axis) {
    if (!std::isfinite(bounds_.min[axis])) {
      bounds_.min[axis] = layers.min[axis];
    }
    if (!std::isfinite(bounds_.max[axis])) {
      bounds_.max[axis] = layers.max[axis];
    }
    if (!std::isfinite(bounds_.min[axis]) || !std::isfinite(bounds_.max[axis])) {
      throw ParameterError("clip",
                           "needs a world with bounds: give the scenario's volume, or put a layer "
                           "with bounds before this one");
    }
  }
  bounds_ = bounds_.grown(beyond);
}

std::vector<Shape> Clip::cut(const Shape& shape) {
  const Box box = bounds(shape);
  const Prism* prism = std::get_if<Prism>(&shape);
  if (is_outside(box, bounds_)) {
    ++dropped_;
    return {};
  }
  if (is_inside(box, bounds_) || prism == nullptr) {
    ++kept_;
    return {shape};
  }
  std::vector<PlanePolygon> pieces;
  bg::intersection(to_boost(*prism),
                   bg::model::box<PlanePoint>({bounds_.min.x(), bounds_.min.y()},
                                              {bounds_.max.x(), bounds_.max.y()}),
                   pieces);
  std::vector<Prism> parts;
  if (!add_prisms(pieces, *prism, parts)) {
    ++kept_;
    return {shape};  // pieces that touch each other: the whole shape is equally correct
  }
  if (parts.empty()) {
    ++dropped_;
  } else {
    ++kept_;
    ++cut_;
  }
  return {parts.begin(), parts.end()};
}

std::string Clip::note() const {
  return std::to_string(dropped_) + " zones outside the bounds dropped, " + std::to_string(cut_) +
         " cut at them";
}

std::string Clip::why_none(const std::vector<formats::Point2>& corners) const {
  return kept_ > 0 || dropped_ == 0 || corners.empty()
             ? ""
             : "none of its zones lies within the bounds: they cover " + extent_text(corners);
}

Box ground_area(const World& before) {
  Box area = Box::empty();
  for (const Layer& layer : before.layers()) {
    if (layer.environment->ground() != nullptr) {
      area = area.united(layer.environment->bounds());
    }
  }
  area.min.z() = -kInfinity;
  area.max.z() = kInfinity;
  return area;
}

std::string extent_text(const std::vector<formats::Point2>& corners) {
  Box degrees = Box::empty();
  for (const auto& [lon, lat] : corners) {
    degrees = degrees.with({lon, lat, 0});
  }
  char text[120];
  std::snprintf(text, sizeof text, "longitude %.7g to %.7g and latitude %.7g to %.7g",
                degrees.min.x(), degrees.max.x(), degrees.min.y(), degrees.max.y());
  return text;
}

namespace {
/// Horizontally; none if a corner lies so far away that the projection fails.
std::optional<Box> bounds_of(const std::vector<formats::Point2>& corners, const Frame& frame,
                             bool exchanged) {
  Box bounds = Box::empty();
  try {
    for (const auto& [lon, lat] : corners) {
      const auto [x, y] = exchanged ? frame.to_local(lat, lon) : frame.to_local(lon, lat);
      bounds = bounds.with({x, y, 0});
    }
  } catch (const Error&) {
    return std::nullopt;
  }
  return bounds;
}
}  // namespace

void expect_longitude_first(const Site& site, const std::vector<formats::Point2>& corners) {
  constexpr double kFar = 500'000;  // metres
  const Box ground = ground_area(*site.before);
  const Box here = ground.min.x() < ground.max.x() ? ground : site.volume;
  if (!site.frame.has_position() || corners.empty() ||
      !(here.max - here.min).head<2>().allFinite()) {
    return;
  }
  const auto written = bounds_of(corners, site.frame, false);
  const auto exchanged = bounds_of(corners, site.frame, true);
  const Vec3 reach(kFar, kFar, 0);
  if ((!written || is_outside(*written, {here.min - reach, here.max + reach})) && exchanged &&
      !is_outside(*exchanged, here)) {
    throw Error(
        "its zones lie here only with longitude and latitude exchanged: does latitude stand "
        "first in the file? They cover " +
        extent_text(corners));
  }
}
}  // namespace altiplan::zones
