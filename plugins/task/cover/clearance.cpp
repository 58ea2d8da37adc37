// SPDX-License-Identifier: Apache-2.0
#include "clearance.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): of Boost, whose own headers include such
#define BOOST_ALLOW_DEPRECATED_HEADERS

#include <algorithm>
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/buffer.hpp>
#include <boost/geometry/algorithms/correct.hpp>
#include <boost/geometry/algorithms/difference.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>

namespace altiplan::cover {
namespace {

namespace bg = boost::geometry;
namespace buffering = bg::strategy::buffer;
using PlanePoint = bg::model::d2::point_xy<double>;
using PlanePolygon = bg::model::polygon<PlanePoint, true, false>;  // clockwise, not closed
using Polygons = bg::model::multi_polygon<PlanePolygon>;

PlanePolygon with_outline(const formats::Ring& ring) {
  PlanePolygon polygon;
  for (const formats::Point2& p : ring) {
    polygon.outer().emplace_back(p[0], p[1]);
  }
  bg::correct(polygon);
  return polygon;
}

formats::Ring ring_of(const PlanePolygon::ring_type& ring) {
  formats::Ring points;
  for (const PlanePoint& p : ring) {
    points.push_back({p.x(), p.y()});
  }
  return formats::without_repeats(points);
}
}  // namespace

std::vector<formats::Polygon> clear_of_islands(const formats::Polygon& area, double distance_m) {
  Polygons left{with_outline(area.outline)};
  for (const formats::Ring& hole : area.holes) {
    Polygons enlarged;
    bg::buffer(with_outline(hole), enlarged, buffering::distance_symmetric<double>(distance_m),
               buffering::side_straight(), buffering::join_miter(2), buffering::end_flat(),
               buffering::point_square());
    Polygons cut;
    bg::difference(left, enlarged, cut);
    left = std::move(cut);
  }
  std::vector<formats::Polygon> parts;
  for (const PlanePolygon& piece : left) {
    constexpr double kSliver = 1e-3;  // square metres
    if (std::abs(bg::area(piece)) < kSliver) {
      continue;
    }
    formats::Polygon& part = parts.emplace_back();
    part.outline = ring_of(piece.outer());
    for (const auto& inner : piece.inners()) {
      part.holes.push_back(ring_of(inner));
    }
  }
  return parts;
}

double shared(const formats::Ring& one, const formats::Ring& other) {
  const PlanePolygon a = with_outline(one);
  const PlanePolygon b = with_outline(other);
  Polygons common;
  bg::intersection(a, b, common);
  return bg::area(common) / std::min(bg::area(a), bg::area(b));
}
}  // namespace altiplan::cover
