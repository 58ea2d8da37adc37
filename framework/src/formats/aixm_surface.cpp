// SPDX-License-Identifier: Apache-2.0
#include "aixm_surface.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/earth.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::formats {
namespace {

using XmlNode = pugi::xml_node;

// Edges follow geodesics to this, unless they are longer than a country, metres.
constexpr double kStraight = 0.5;
constexpr double kLongEdge = 2e6;
// Tried in both directions.
constexpr std::size_t kMaxFlips = 10;

/// The order of coordinates, by the nearest srsName.
bool is_lat_first(XmlNode node) {
  for (; node; node = node.parent()) {
    const std::string_view name = node.attribute("srsName").value();
    if (name.empty()) {
      continue;
    }
    if (name.find("CRS84") != std::string_view::npos) {
      return false;
    }
    if (name.find("4326") == std::string_view::npos) {
      throw Error("expected the coordinate system EPSG:4326 or CRS84, found '" + printable(name) +
                  "'");
    }
    return true;
  }
  return true;
}

void add_positions(std::string_view text, bool lat_first, std::vector<Point2>& to) {
  std::vector<double> numbers;
  while (!(text = trimmed(text)).empty()) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    numbers.push_back(number_of(text.substr(0, end)));
    text.remove_prefix(end);
  }
  if (numbers.empty() || numbers.size() % 2 != 0) {
    throw Error("expected positions of two coordinates, found " + std::to_string(numbers.size()) +
                " numbers");
  }
  for (std::size_t n = 0; n < numbers.size(); n += 2) {
    const Point2 p =
        lat_first ? Point2{numbers[n + 1], numbers[n]} : Point2{numbers[n], numbers[n + 1]};
    expect_lonlat(p);
    to.push_back(p);
  }
}

void add_points(const XmlNode& node, std::vector<Point2>& to) {
  const std::string_view name = local_name(node);
  if (name == "pos" || name == "posList") {
    add_positions(node.text().get(), is_lat_first(node), to);
    return;
  }
  if ((name == "pointProperty" || name == "pointRep") && !node.first_child()) {
    throw Error("expected a position within " + std::string(name) + ", found none");
  }
  for (const XmlNode& inner : node.children()) {
    add_points(inner, to);
  }
}

std::vector<Point2> points_of(const XmlNode& node) {
  std::vector<Point2> points;
  add_points(node, points);
  if (points.empty()) {
    throw Error("expected positions within " + std::string(local_name(node)) + ", found none");
  }
  return points;
}

double radius_of(const XmlNode& segment) {
  const XmlNode radius = child(segment, "radius");
  const std::string unit = upper_case(radius.attribute("uom").value());
  const double value = number_of(trimmed(radius.text().get()));
  const double scale = unit == "[NMI_I]" || unit == "NM"  ? kNauticalMile
                       : unit == "M"                      ? 1
                       : unit == "KM"                     ? 1000
                       : unit == "[FT_I]" || unit == "FT" ? kFoot
                                                          : 0;
  if (scale == 0) {
    throw Error("expected a radius in [nmi_i], NM, M, KM or FT, found '" + printable(unit) + "'");
  }
  expect_radius(value * scale);
  return value * scale;
}

/// A piece of a ring: a part of its outline, or a border to follow.
struct Piece {
  Outline outline;
  std::vector<Point2> border;
  std::optional<std::pair<Point2, double>> circle;
};

OutlineArc arc_of(const XmlNode& segment) {
  const std::vector<Point2> centre = points_of(segment);
  if (centre.size() != 1) {
    throw Error("expected one centre of an arc, found " + std::to_string(centre.size()));
  }
  const double from = number_of(text_of(segment, "startAngle"));
  const double to = number_of(text_of(segment, "endAngle"));
  const double radius = radius_of(segment);
  expect_bearing(from);
  expect_bearing(to);
  // The shorter way; if the angles run the longer one, or it is half a circle, either may be meant.
  const double sweep = std::remainder(to - from, 360);
  OutlineArc arc{centre.front(), radius, radius, from, sweep == 0 ? 360 : sweep};
  arc.is_uncertain = sweep != 0 && std::abs(to - from) >= 180;
  return arc;
}

/// Points of the geodesic between two others, so that straight edges in longitude and latitude
/// follow it.
void add_geodesic(const Point2& p, const Point2& q, Outline& to) {
  const GeodesicCourse course = geodesic_course(p, q);
  constexpr double kOpposite = 19'900'000;  // metres: half of the Earth is 20,004 km or more
  if (course.metres > kOpposite) {
    throw Error("expected a geodesic between places that are not opposite to each other, found " +
                std::to_string(course.metres / 1000) + " km: it may run in any direction");
  }
  const Point2 middle = geodesic_end(p, course.bearing_deg, course.metres / 2);
  const Point2 straight{(p[0] + longitude_near(q[0], p[0])) / 2, (p[1] + q[1]) / 2};
  if (geodesic_course(middle, straight).metres <= kStraight || course.metres > kLongEdge) {
    return;
  }
  add_geodesic(p, middle, to);
  to.emplace_back(middle);
  add_geodesic(middle, q, to);
}

void add_segment(const XmlNode& segment, Piece& piece) {
  const std::string_view name = local_name(segment);
  if (name == "GeodesicString" || name == "Geodesic") {
    const std::vector<Point2> points = points_of(segment);
    for (std::size_t n = 0; n < points.size(); ++n) {
      if (n > 0) {
        add_geodesic(points[n - 1], points[n], piece.outline);
      }
      piece.outline.emplace_back(points[n]);
    }
  } else if (name == "LineStringSegment" || name == "LineString") {
    const std::vector<Point2> points = points_of(segment);
    piece.outline.insert(piece.outline.end(), points.begin(), points.end());
  } else if (name == "ArcByCenterPoint") {
    piece.outline.emplace_back(arc_of(segment));
  } else if (name == "CircleByCenterPoint") {
    const std::vector<Point2> centre = points_of(segment);
    piece.circle = {centre.front(), radius_of(segment)};
  } else {
    throw Error("unsupported curve '" + std::string(name) +
                "', expected GeodesicString, LineStringSegment, ArcByCenterPoint or "
                "CircleByCenterPoint");
  }
}

Piece piece_of(const XmlNode& member, const std::map<std::string, XmlNode>& borders) {
  Piece piece;
  if (const std::string id = reference(member); !id.empty()) {
    const auto found = borders.find(id);
    if (found == borders.end()) {
      throw Error("expected the border '" + printable(id) + "' in the file, found none");
    }
    piece.border = points_of(found->second);
    return piece;
  }
  const XmlNode curve =
      member.find_child([](const XmlNode& node) { return node.type() == pugi::node_element; });
  const XmlNode segments = child(curve, "segments");
  for (const XmlNode& segment : segments.children()) {
    add_segment(segment, piece);
  }
  if (!segments) {
    add_segment(curve, piece);
  }
  return piece;
}

Point2 end_of(const OutlinePart& part, double share) {
  const auto* arc = std::get_if<OutlineArc>(&part);
  return arc == nullptr
             ? std::get<Point2>(part)
             : geodesic_end(arc->centre, arc->from_deg + share * arc->sweep_deg, arc->max_radius_m);
}

Outline joined(const std::vector<Piece>& pieces) {
  Outline outline;
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const Piece& piece = pieces[n];
    if (piece.border.empty()) {
      outline.insert(outline.end(), piece.outline.begin(), piece.outline.end());
      continue;
    }
    if (pieces.size() == 1) {
      return {piece.border.begin(), piece.border.end()};
    }
    const Outline& before = pieces[(n + pieces.size() - 1) % pieces.size()].outline;
    const Outline& after = pieces[(n + 1) % pieces.size()].outline;
    if (before.empty() || after.empty()) {
      throw Error("expected curves on both sides of a border, found another border");
    }
    const Outline between =
        along_border(piece.border, end_of(before.back(), 1), end_of(after.front(), 0));
    outline.insert(outline.end(), between.begin(), between.end());
  }
  return outline;
}

/// The outline with these of its arcs the other way round.
Outline flipped(Outline outline, const std::vector<std::size_t>& arcs, unsigned flips) {
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    auto& arc = std::get<OutlineArc>(outline[arcs[k]]);
    if ((flips >> k & 1U) != 0 && std::abs(arc.sweep_deg) < 360) {
      arc.sweep_deg -= std::copysign(360, arc.sweep_deg);
    }
  }
  return outline;
}

/// The outline, with arcs the other way round if it meets itself otherwise, and with the uncertain
/// ones either way as long as it does not.
std::vector<Outline> turned(const Outline& outline) {
  std::vector<std::size_t> arcs;
  unsigned uncertain = 0;
  for (std::size_t n = 0; n < outline.size(); ++n) {
    if (const auto* arc = std::get_if<OutlineArc>(&outline[n])) {
      uncertain |= unsigned(arc->is_uncertain) << std::min(arcs.size(), kMaxFlips);
      arcs.push_back(n);
    }
  }
  if (arcs.empty() || arcs.size() > kMaxFlips) {
    return {outline};
  }
  unsigned flips = 0;
  while (flips < 1U << arcs.size() && !is_simple(flipped(outline, arcs, flips))) {
    ++flips;
  }
  if (flips == 1U << arcs.size()) {
    return {outline};
  }
  std::vector<Outline> outlines{flipped(outline, arcs, flips)};
  for (unsigned other = uncertain; other != 0; other = (other - 1) & uncertain) {
    if (Outline candidate = flipped(outline, arcs, flips ^ other); is_simple(candidate)) {
      outlines.push_back(std::move(candidate));
    }
  }
  return outlines;
}

/// A circle, or outlines one of which is meant.
struct RingParts {
  std::vector<Outline> outlines;
  std::optional<std::pair<Point2, double>> circle;
};

RingParts ring_parts(const XmlNode& boundary, const std::map<std::string, XmlNode>& borders) {
  if (const XmlNode linear = child(boundary, "LinearRing")) {
    const std::vector<Point2> points = points_of(linear);
    return {{{points.begin(), points.end()}}, {}};
  }
  std::vector<Piece> pieces;
  for (const XmlNode& member : child(boundary, "Ring").children()) {
    if (local_name(member) == "curveMember") {
      pieces.push_back(piece_of(member, borders));
    }
  }
  if (pieces.empty()) {
    throw Error("expected a Ring of curveMembers or a LinearRing, found none");
  }
  for (const Piece& piece : pieces) {
    if (piece.circle) {
      if (pieces.size() > 1 || !piece.outline.empty()) {
        throw Error("expected a circle alone in its ring, found other curves with it");
      }
      return {{}, piece.circle};
    }
  }
  return {turned(joined(pieces)), {}};
}

std::vector<Polygon> covered(const RingParts& parts, const std::string& zone, Doubts& doubts) {
  if (parts.circle) {
    return {{circle_ring(parts.circle->first, parts.circle->second), {}}};
  }
  if (parts.outlines.size() > 1) {
    doubts.add("arc that may run either way round, closed both ways", zone);
  }
  std::vector<Polygon> polygons;
  for (const Outline& outline : parts.outlines) {
    std::vector<Polygon> more = cover_of(outline, zone, doubts);
    std::move(more.begin(), more.end(), std::back_inserter(polygons));
  }
  return polygons;
}

void read_patch(const XmlNode& patch, const std::map<std::string, XmlNode>& borders,
                const std::string& zone, Doubts& doubts, std::vector<Polygon>& to) {
  std::vector<Ring> holes;
  for (const XmlNode& node : patch.children()) {
    if (local_name(node) != "interior") {
      continue;
    }
    const RingParts inner = ring_parts(node, borders);
    if (inner.circle) {
      holes.push_back(circle_ring(inner.circle->first, inner.circle->second, true));
    } else if (inner.outlines.size() == 1) {
      holes.push_back(ring_within(inner.outlines.front()));
    } else {
      doubts.add("hole with an arc that may run either way round, closed", zone);
    }
  }
  for (Polygon& polygon : covered(ring_parts(child(patch, "exterior"), borders), zone, doubts)) {
    cut_holes(polygon, holes, zone, doubts);
    to.push_back(std::move(polygon));
  }
}
}  // namespace

void find_all(const XmlNode& node, std::string_view name, std::vector<XmlNode>& to) {
  for (const XmlNode& inner : node.children()) {
    if (local_name(inner) == name) {
      to.push_back(inner);
    } else {
      find_all(inner, name, to);
    }
  }
}

std::string identifier(const XmlNode& feature) {
  const std::string_view text = text_of(feature, "identifier");
  return std::string(text.starts_with("urn:uuid:") ? text.substr(9) : text);
}

std::string reference(const XmlNode& node) {
  const pugi::xml_attribute href = node.find_attribute([](const pugi::xml_attribute& attribute) {
    return std::string_view(attribute.name()).ends_with("href");
  });
  std::string_view text = href.value();
  for (const std::string_view prefix : {"urn:uuid:", "#"}) {
    if (text.starts_with(prefix)) {
      text.remove_prefix(prefix.size());
    }
  }
  return std::string(text);
}

std::vector<Polygon> read_surface(const XmlNode& projection,
                                  const std::map<std::string, XmlNode>& borders,
                                  const std::string& zone, Doubts& doubts) {
  std::vector<XmlNode> patches;
  find_all(projection, "PolygonPatch", patches);
  find_all(projection, "Polygon", patches);
  if (patches.empty()) {
    throw Error("expected a PolygonPatch within horizontalProjection, found none");
  }
  std::vector<Polygon> polygons;
  for (const XmlNode& patch : patches) {
    read_patch(patch, borders, zone, doubts, polygons);
  }
  return polygons;
}
}  // namespace altiplan::formats
