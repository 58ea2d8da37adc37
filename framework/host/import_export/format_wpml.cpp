// SPDX-License-Identifier: Apache-2.0
// DJI's WPML 1.0.2, as https://developer.dji.com/doc/cloud-api-tutorial documents it: an archive of
// the template that ground stations show and the waylines that the aircraft flies.
#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/map_system.hpp"
#include "host/base/words.hpp"
#include "host/base/xml_text.hpp"
#include "host/base/zip.hpp"
#include "host/import_export/format_functions.hpp"
#include "host/import_export/map_parts.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;

/// Numbers of waypoints in a wayline go from 0 to 65535.
constexpr std::size_t kWaylinePoints = 65536;
constexpr double kMinTakeOffHeight = 1.2;
constexpr double kMaxTakeOffHeight = 1500;
constexpr double kMaxTransitionalSpeed = 15;

/// "<wpml:NAME>TEXT</wpml:NAME>" on a line of its own.
std::string wpml(const char* name, const std::string& text) {
  return std::string("<wpml:") + name + ">" + text + "</wpml:" + name + ">\n";
}

/// First and last item of each wayline. The next begins where one ends, so that all legs are flown.
std::vector<std::pair<std::size_t, std::size_t>> waylines_of(std::size_t items) {
  std::vector<std::pair<std::size_t, std::size_t>> parts;
  std::size_t first = 0;
  do {
    const std::size_t last = std::min(first + kWaylinePoints, items) - 1;
    parts.emplace_back(first, last);
    first = last;
  } while (first + 1 < items);
  return parts;
}

class WpmlWriter {
 public:
  explicit WpmlWriter(const MissionText& text) : text_(text), items_(text.mission.items) {
    for (const MissionItem& item : items_) {
      highest_ = std::max(highest_, item.at.altitude_m);
    }
  }

  std::string waylines() const {
    std::string out = begin() + config("") + "";
    std::size_t number = 0;
    for (const auto& [first, last] : waylines_of(items_.size())) {
      const std::string id = std::to_string(number++);
      out += "<Folder>\n" + wpml("templateId", id) +
             wpml("executeHeightMode", "relativeToStartPoint") + wpml("waylineId", id) +
             wpml("autoFlightSpeed", metres(text_.speed_mps));
      for (std::size_t n = first; n <= last; ++n) {
        out += point(n, n - first) + wpml("executeHeight", metres(items_[n].at.altitude_m)) +
               wpml("waypointSpeed", metres(speed_after(n))) + "<wpml:waypointHeadingParam>\n" +
               wpml("waypointHeadingMode", "followWayline") + "</wpml:waypointHeadingParam>\n" +
               "<wpml:waypointTurnParam>\n" + wpml("waypointTurnMode", kStopAtPoints) +
               wpml("waypointTurnDampingDist", "0") + "</wpml:waypointTurnParam>\n</Placemark>\n";
      }
      out += "</Folder>\n";
    }
    return out + "</Document>\n</kml>\n";
  }

  std::string template_text() const {
    const formats::MissionPoint& home = text_.mission.home.value();
    const double undulation = geoid_height(home.lon, home.lat);
    const std::string take_off =
        wpml("takeOffRefPoint", degrees_text(home.lat) + "," + degrees_text(home.lon) + "," +
                                    metres(home.altitude_m + undulation)) +
        wpml("takeOffRefPointAGLHeight", metres(home.altitude_m));
    std::string out = begin() + wpml("author", "altiplan") + config(take_off);
    std::size_t number = 0;
    for (const auto& [first, last] : waylines_of(items_.size())) {
      out += "<Folder>\n" + wpml("templateType", "waypoint") +
             wpml("templateId", std::to_string(number++)) + "<wpml:waylineCoordinateSysParam>\n" +
             wpml("coordinateMode", "WGS84") + wpml("heightMode", "relativeToStartPoint") +
             "</wpml:waylineCoordinateSysParam>\n" +
             wpml("autoFlightSpeed", metres(text_.speed_mps)) +
             wpml("globalHeight", metres(highest_)) + wpml("gimbalPitchMode", "manual") +
             "<wpml:globalWaypointHeadingParam>\n" + wpml("waypointHeadingMode", "followWayline") +
             "</wpml:globalWaypointHeadingParam>\n" +
             wpml("globalWaypointTurnMode", kStopAtPoints) + wpml("globalUseStraightLine", "1");
      for (std::size_t n = first; n <= last; ++n) {
        const double height = items_[n].at.altitude_m;
        out += point(n, n - first) +
               wpml("ellipsoidHeight", metres(height + home.altitude_m + undulation)) +
               wpml("height", metres(height)) + wpml("useGlobalHeight", "0") +
               wpml("useGlobalSpeed", "0") + wpml("waypointSpeed", metres(speed_after(n))) +
               wpml("useGlobalHeadingParam", "1") + wpml("useGlobalTurnParam", "1") +
               "</Placemark>\n";
      }
      out += "</Folder>\n";
    }
    return out + "</Document>\n</kml>\n";
  }

 private:
  /// Straight legs, as judged; corners that are flown through are cut.
  static constexpr const char* kStopAtPoints = "toPointAndStopWithDiscontinuityCurvature";

  std::string metres(double value) const { return rounded_text(value, text_.decimals.metres); }
  std::string degrees_text(double value) const {
    return rounded_text(value, text_.decimals.degrees);
  }

  static std::string begin() {
    return std::string(kXml) +
           "<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
           "xmlns:wpml=\"http://www.dji.com/wpmz/1.0.2\">\n<Document>\n";
  }

  /// The mission as a whole; it is flown to its end without its remote control, as it was judged.
  std::string config(const std::string& take_off) const {
    const double first = items_.front().at.altitude_m;
    return "<wpml:missionConfig>\n" + wpml("flyToWaylineMode", "safely") +
           wpml("finishAction", "noAction") + wpml("exitOnRCLost", "goContinue") +
           wpml("executeRCLostAction", "hover") +
           wpml("takeOffSecurityHeight",
                metres(std::clamp(first, kMinTakeOffHeight, kMaxTakeOffHeight))) +
           take_off +
           wpml("globalTransitionalSpeed",
                metres(std::min(text_.speed_mps, kMaxTransitionalSpeed))) +
           wpml("globalRTHHeight", metres(std::max(highest_, kMinTakeOffHeight))) +
           "<wpml:droneInfo>\n" + wpml("droneEnumValue", "77") + wpml("droneSubEnumValue", "0") +
           "</wpml:droneInfo>\n<wpml:payloadInfo>\n" + wpml("payloadEnumValue", "66") +
           wpml("payloadPositionIndex", "0") + "</wpml:payloadInfo>\n</wpml:missionConfig>\n";
  }

  /// The beginning of a waypoint's Placemark.
  std::string point(std::size_t item, std::size_t index) const {
    return "<Placemark>\n<Point><coordinates>" + degrees_text(items_[item].at.lon) + "," +
           degrees_text(items_[item].at.lat) + "</coordinates></Point>\n" +
           wpml("index", std::to_string(index));
  }

  /// On the way from the item to the next one.
  double speed_after(std::size_t item) const {
    const double own = items_[std::min(item + 1, items_.size() - 1)].speed_mps;
    return own > 0 ? own : text_.speed_mps;
  }

  const MissionText& text_;
  const std::vector<MissionItem>& items_;
  double highest_ = 0;
};
}  // namespace

std::string wpml_text(const MissionText& text) {
  const WpmlWriter writer(text);
  return zip_of(
      {{"wpmz/template.kml", writer.template_text()}, {"wpmz/waylines.wpml", writer.waylines()}});
}

std::vector<std::string> wpml_notes(const MissionText& text) {
  std::vector<std::string> notes{
      "heights count from where the aircraft takes off: take off at " +
          rounded_text(text.mission.home.value().altitude_m, 1) +
          " m above sea level, straight below the first point",
      "it stops at each point; the aircraft is named as a Mavic 3E: choose yours in DJI Pilot 2"};
  const std::size_t parts = waylines_of(text.mission.items.size()).size();
  if (parts > 1) {
    notes.push_back("split into " + counted(parts, "wayline") +
                    " of at most 65,536 points, to be flown one after the other");
  }
  return notes;
}
}  // namespace altiplan::host
