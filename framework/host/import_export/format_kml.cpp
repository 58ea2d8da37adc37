// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "altiplan/earth.hpp"
#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/base/xml_text.hpp"
#include "host/base/zip.hpp"
#include "host/import_export/format_functions.hpp"
#include "host/import_export/map_parts.hpp"

namespace altiplan::host {
namespace {

using formats::AltitudeFrame;
using formats::MissionItem;
using formats::Zone;

/// Writes KML with the indentation of its element.
class KmlWriter {
 public:
  KmlWriter(const MissionText& text, bool has_marks) : decimals_(text.decimals) {
    const formats::MissionFile& mission = text.mission;
    const AltitudeFrame frame = mission.items.front().at.frame;
    out_ = kXml;
    out_ += "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n";
    out_ += "  <name>" + xml_text(mission.name) + "</name>\n";
    out_ +=
        "  <Style id=\"keep_out\"><PolyStyle><color>800000ff</color></PolyStyle></Style>\n"
        "  <Style id=\"keep_in\"><PolyStyle><color>4000ff00</color></PolyStyle></Style>\n";
    add_route(mission, frame);
    for (std::size_t n = 0; has_marks && n < mission.items.size(); ++n) {
      add_mark(text, n);
    }
    for (const Zone& zone : mission.zones) {
      add_zone(zone);
    }
    out_ += "</Document>\n</kml>\n";
  }
  const std::string& text() const { return out_; }

 private:
  std::string coordinate(const formats::Point2& p, double altitude) const {
    return rounded_text(p[0], decimals_.degrees) + "," + rounded_text(p[1], decimals_.degrees) +
           "," + rounded_text(altitude, decimals_.metres);
  }

  void add_route(const formats::MissionFile& mission, AltitudeFrame frame) {
    out_ += "  <Placemark>\n    <name>route</name>\n    <description>altitudes are metres " +
            std::string(words_of(frame)) + "</description>\n    <LineString>\n      " +
            mode(frame) + "\n      <coordinates>\n";
    for (const MissionItem& item : mission.items) {
      out_ += "        " + coordinate({item.at.lon, item.at.lat}, item.at.altitude_m) + "\n";
    }
    out_ += "      </coordinates>\n    </LineString>\n  </Placemark>\n";
  }

  static std::string mode(AltitudeFrame frame) {
    return std::string("<altitudeMode>") +
           (frame == AltitudeFrame::sea ? "absolute" : "relativeToGround") + "</altitudeMode>";
  }

  /// The n-th waypoint as a place of its own, with its time where that is known.
  void add_mark(const MissionText& text, std::size_t n) {
    const MissionItem& item = text.mission.items[n];
    out_ += "  <Placemark>\n    <name>" + std::to_string(n + 1) + "</name>\n";
    if (const std::string time = iso_time(text, n); !time.empty()) {
      out_ += "    <TimeStamp><when>" + time + "</when></TimeStamp>\n";
    }
    if (n < text.times_s.size()) {
      out_ += "    <ExtendedData>\n";
      add_data("time_s", rounded_text(text.times_s[n], 3));
      out_ += "    </ExtendedData>\n";
    }
    out_ += "    <Point>" + mode(item.at.frame) + "<coordinates>" +
            coordinate({item.at.lon, item.at.lat}, item.at.altitude_m) +
            "</coordinates></Point>\n  </Placemark>\n";
  }

  void add_ring(const char* element, const formats::Ring& ring, double altitude) {
    out_ += std::string("      <") + element + "><LinearRing><coordinates>\n";
    for (std::size_t n = 0; n <= ring.size(); ++n) {
      out_ += "        " + coordinate(ring[n % ring.size()], altitude) + "\n";
    }
    out_ += std::string("      </coordinates></LinearRing></") + element + ">\n";
  }

  void add_data(const char* key, const std::string& value) {
    out_ += std::string("      <Data name=\"") + key + "\"><value>" + value + "</value></Data>\n";
  }

  /// Extruded from its ceiling down to the ground; both limits are added as data.
  void add_zone(const Zone& zone) {
    const char* role = role_of(zone);
    const auto floor = altitude_of(zone.volumes.front().lower);
    const auto ceiling = altitude_of(zone.volumes.front().upper);
    out_ += "  <Placemark>\n    <name>" + xml_text(zone.name.empty() ? role : zone.name) +
            "</name>\n    <styleUrl>#" + role + "</styleUrl>\n    <ExtendedData>\n";
    add_data("role", role);
    if (floor) {
      add_data("floor_m", rounded_text(*floor, decimals_.metres));
    }
    if (ceiling) {
      add_data("ceiling_m", rounded_text(*ceiling, decimals_.metres));
    }
    out_ += "    </ExtendedData>\n    <Polygon>\n";
    out_ += ceiling ? "      <extrude>1</extrude>\n      <altitudeMode>absolute</altitudeMode>\n"
                    : "      <altitudeMode>clampToGround</altitudeMode>\n";
    const formats::Polygon polygon = polygon_of(zone);
    const double altitude = ceiling.value_or(0);
    add_ring("outerBoundaryIs", polygon.outline, altitude);
    for (const formats::Ring& hole : polygon.holes) {
      add_ring("innerBoundaryIs", hole, altitude);
    }
    out_ += "    </Polygon>\n  </Placemark>\n";
  }

  Decimals decimals_;
  std::string out_;
};
/// Metres between two points, of heights that count from the same.
double distance(const formats::MissionPoint& a, const formats::MissionPoint& b) {
  return std::hypot(geodesic_course({a.lon, a.lat}, {b.lon, b.lat}).metres,
                    a.altitude_m - b.altitude_m);
}

/// Where a template of DJI's says something else than the waylines, "" where it does not: other
/// points, or another way to fly. Heights of which one counts from home count from the sea.
std::string contradiction(const formats::MissionFile& waylines, const formats::MissionFile& templ) {
  constexpr double kSame = 0.5;  // metres: models of the geoid differ
  if (templ.route_problem.starts_with("how DJI flies")) {
    return templ.route_problem;
  }
  if (templ.items.empty()) {  // it is of an area, or of a line, from which DJI Pilot makes points
    return "";
  }
  if (templ.items.size() != waylines.items.size()) {
    return counted(templ.items.size(), "point") + " there, " +
           std::to_string(waylines.items.size()) + " in the waylines";
  }
  const auto above_sea = [&](formats::MissionPoint at) {
    if (at.frame == AltitudeFrame::home && templ.home) {
      at.altitude_m += templ.home->altitude_m;
      at.frame = AltitudeFrame::sea;
    }
    return at;
  };
  for (std::size_t n = 0; n < templ.items.size(); ++n) {
    formats::MissionPoint there = templ.items[n].at;
    formats::MissionPoint here = waylines.items[n].at;
    if (here.frame != there.frame) {
      here = above_sea(here);
      there = above_sea(there);
    }
    if (here.frame != there.frame) {
      return "its heights count from elsewhere than those of the waylines, and how is not known";
    }
    if (const double metres = distance(here, there); metres > kSame) {
      return "point " + std::to_string(n + 1) + " is " + with_decimals(metres, 1) +
             " m away from that of the waylines";
    }
  }
  return "";
}

/// The place of take-off is in the template. What contradicts the waylines may be flown in their
/// place: DJI Pilot makes them anew when the mission is edited.
void take_template(formats::MissionFile& waylines, const formats::MissionFile& templ) {
  waylines.home = templ.home;
  if (const std::string why = contradiction(waylines, templ);
      !why.empty() && waylines.route_problem.empty()) {
    waylines.route_problem =
        "its template.kml, from which DJI Pilot makes the waylines anew when they are edited, "
        "contradicts them: " +
        why;
  }
}
}  // namespace

std::string kml_text(const MissionText& text) { return KmlWriter(text, false).text(); }

std::string kmz_text(const MissionText& text) {
  return zip_of({{"doc.kml", KmlWriter(text, true).text()}});
}

formats::MissionFile read_kmz(const std::string& file, const std::string& text) {
  std::optional<std::string> waylines;
  std::optional<std::string> kml;
  std::string name;  // of the entry that is read
  std::size_t others = 0;
  try {
    for (const std::string& each : zip_names(text)) {
      const bool is_one = each.ends_with(".kml") || each.ends_with("waylines.wpml");
      const bool is_first = is_one && name.empty();
      name = is_first ? each : name;
      others += is_one && !is_first;
    }
    waylines = zip_entry(text, "waylines.wpml");
    kml = zip_entry(text, ".kml");
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  if (!waylines && !kml) {
    throw Error(file + ": the archive holds neither a .kml nor a waylines.wpml");
  }
  const auto read = [&](const std::string& content, const char* entry) {
    formats::MissionFile mission = formats::read_mission(file + entry, content);
    mission.format = formats::MissionFile::Format::other;
    return mission;
  };
  if (!waylines) {
    formats::MissionFile mission = read(*kml, ("/" + name).c_str());
    if (others > 0 && mission.route_problem.empty()) {
      mission.route_problem = "expected one .kml in the archive, found more";
      mission.lacks_heights = false;
    }
    return mission;
  }
  formats::MissionFile mission = read(*waylines, "/waylines.wpml");
  if (kml) {
    try {
      take_template(mission, read(*kml, "/template.kml"));
    } catch (const Error& error) {
      if (std::any_of(mission.items.begin(), mission.items.end(),
                      [](const auto& item) { return item.at.frame == AltitudeFrame::home; })) {
        throw;
      }
      mission.notes.push_back(std::string("its template is not read: ") + error.what());
    }
  }
  return mission;
}
}  // namespace altiplan::host
