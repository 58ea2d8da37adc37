// SPDX-License-Identifier: Apache-2.0
//
// Zones that a file gives as a point or a line, and how far they reach.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "airspace_parts.hpp"
#include "altiplan/earth.hpp"
#include "altiplan/formats/earth_polygon.hpp"

namespace altiplan::formats {
namespace {

/// Ends of the names of properties that say how far a point or a line reaches.
constexpr std::array kReaches{"RADIUS",      "BUFFER",         "BUFFERZONE",
                              "BUFFER_ZONE", "BUFFERDISTANCE", "BUFFER_DISTANCE"};
}  // namespace

double reach_of(const std::string& name, const std::string& value) {
  static const std::map<std::string, double> kUnits{
      {"M", 1},       {"METER", 1},          {"METERS", 1},          {"METRES", 1},
      {"KM", 1000},   {"NM", kNauticalMile}, {"NMI", kNauticalMile}, {"FT", kFoot},
      {"FEET", kFoot}};
  std::string word = upper_case(name);
  std::string unit;
  for (const std::string end : {"_METERS", "_METRES", "_KM", "_NM", "_FT", "_M"}) {
    if (word.ends_with(end)) {
      unit = end.substr(1);
      word.resize(word.size() - end.size());
      break;
    }
  }
  const bool is_reach = std::any_of(kReaches.begin(), kReaches.end(),
                                    [&](const char* end) { return word.ends_with(end); });
  if (!is_reach || value.empty()) {
    return 0;
  }
  std::string text = upper_case(value);
  std::replace(text.begin(), text.end(), ',', '.');
  double number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string own_unit = text.substr(std::size_t(stop - text.data()));
  own_unit.erase(0, std::min(own_unit.find_first_not_of(' '), own_unit.size()));
  unit = own_unit.empty() ? unit : own_unit;
  const auto scale = kUnits.find(unit);
  if (error != std::errc() || !(number >= 0) || (!unit.empty() && scale == kUnits.end())) {
    throw Error("expected a length such as 5 km in the property '" + name + "', found '" +
                printable(value) + "'");
  }
  return number * (!unit.empty() ? scale->second : number < 100 ? 1000 : 1);
}

std::vector<Polygon> corridor_of(const Ring& line, double distance_m) {
  constexpr double kEdge = 0.05;  // more than what straight edges are off, metres
  constexpr double kPiece = 0.1;  // degrees, in which a course turns by as much at most
  const double over = 0.002 * distance_m + kEdge;  // closes the wedges between pieces
  const double aside = 1.00001 * distance_m + kEdge;
  std::vector<Polygon> parts;
  for (std::size_t n = 0; n < line.size(); ++n) {
    parts.push_back({circle_ring(line[n], distance_m), {}});
    if (n + 1 == line.size() || line[n] == line[n + 1]) {
      continue;
    }
    const double lon = std::remainder(line[n + 1][0] - line[n][0], 360.0);
    const double lat = line[n + 1][1] - line[n][1];
    const int count = std::max(1, int(std::ceil(std::max(std::abs(lon), std::abs(lat)) / kPiece)));
    const auto at = [&](int piece) {
      const double share = double(piece) / count;
      return Point2{std::remainder(line[n][0] + share * lon, 360.0), line[n][1] + share * lat};
    };
    for (int piece = 0; piece < count; ++piece) {
      const double course = geodesic_course(at(piece), at(piece + 1)).bearing_deg;
      const Point2 from = geodesic_end(at(piece), course + 180, over);
      const Point2 to = geodesic_end(at(piece + 1), course, over);
      parts.push_back(
          {continuous({geodesic_end(from, course + 90, aside), geodesic_end(to, course + 90, aside),
                       geodesic_end(to, course - 90, aside),
                       geodesic_end(from, course - 90, aside)}),
           {}});
    }
  }
  return parts;
}

}  // namespace altiplan::formats
