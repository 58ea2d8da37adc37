// SPDX-License-Identifier: Apache-2.0
//
// Airspace of AIXM 5.1 messages. Angles are bearings and arcs as in OGC 12-028, Use of GML for
// aviation data; but publications mix the directions of arcs, so an arc takes its shorter way
// unless the outline then meets itself.
#include <algorithm>
#include <cmath>

#include "aixm_surface.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::formats {
namespace {

using XmlNode = pugi::xml_node;

LimitText limit_at(const XmlNode& volume, const char* key, const char* reference) {
  const std::string text(text_of(volume, key));
  LimitText limit{{},
                  child(volume, key).attribute("uom").value(),
                  std::string(text_of(volume, reference)),
                  text};
  const std::string word = upper_case(text);
  if (word == "UNL") {
    return {1e9, "FT", "MSL", text};
  }
  if (word == "GND" || word == "SFC") {
    return {0, "FT", "SFC", text};
  }
  try {
    limit.value = number_of(text);
  } catch (const Error&) {
    limit.value = std::nullopt;
  }
  return limit;
}

std::optional<DailyHours::Edge> edge_at(const XmlNode& sheet, const char* time, const char* event,
                                        const char* offset) {
  const std::string_view name = text_of(sheet, event);
  if (!name.empty()) {
    const auto found = sun_event(name);
    return found && text_of(sheet, offset).empty() ? std::optional(DailyHours::Edge{*found, 0})
                                                   : std::nullopt;
  }
  const auto seconds = clock_time(std::string(text_of(sheet, time)) + "Z");
  return seconds ? std::optional(DailyHours::Edge{DailyHours::Event::clock, *seconds})
                 : std::nullopt;
}

/// None unless the sheet gives hours of days of the week, all through the year, in UTC.
std::optional<DailyHours> hours_of(const XmlNode& sheet) {
  const std::string_view day = text_of(sheet, "day");
  const auto days = day.empty() ? std::optional(127U) : day_bits(day);
  const std::string_view reference = text_of(sheet, "timeReference");
  const bool by_date = !text_of(sheet, "startDate").empty() || !text_of(sheet, "endDate").empty();
  const std::string_view excluded = text_of(sheet, "excluded");
  if (!days || (!reference.empty() && reference != "UTC") || by_date ||
      !text_of(sheet, "dayTil").empty() || (!excluded.empty() && excluded != "NO")) {
    return std::nullopt;
  }
  const auto from = edge_at(sheet, "startTime", "startEvent", "startTimeRelativeEvent");
  const auto until = edge_at(sheet, "endTime", "endEvent", "endTimeRelativeEvent");
  return from && until ? std::optional(DailyHours{*days, *from, *until}) : std::nullopt;
}

/// Hours of a zone's activations; empty: always active.
std::vector<DailyHours> hours_of(const XmlNode& slice, const std::string& zone, Doubts& doubts) {
  std::vector<DailyHours> hours;
  for (const XmlNode& activation : slice.children()) {
    if (local_name(activation) != "activation") {
      continue;
    }
    std::vector<XmlNode> sheets;
    find_all(activation, "Timesheet", sheets);
    for (const XmlNode& sheet : sheets) {
      const auto found = hours_of(sheet);
      if (!found) {
        doubts.add(
            "hours that are not read (expected days MON to SUN or ANY in UTC), always active",
            zone);
        return {};
      }
      hours.push_back(*found);
    }
    if (sheets.empty()) {
      std::vector<XmlNode> words;
      find_all(activation, "note", words);
      doubts.add(words.empty()
                     ? std::string("activation without hours, always active")
                     : "hours in words ('" + printable(trimmed(words.front().text().get())) +
                           "'), always active",
                 zone);
      return {};
    }
  }
  return hours;
}

ZonePeriod validity_of(const XmlNode& slice, const std::string& zone, Doubts& doubts) {
  const XmlNode period = child(child(slice, "validTime"), "TimePeriod");
  ZonePeriod result{period_start(std::string(text_of(period, "beginPosition")), zone, doubts),
                    period_end(std::string(text_of(period, "endPosition")), zone, doubts),
                    {}};
  settle(result, zone, doubts);
  return result;
}

class AixmReader {
 public:
  AixmReader(const std::string& file, const std::string& text) : file_(file), text_(text) {
    const pugi::xml_parse_result parsed = document_.load_buffer(text.data(), text.size());
    if (!parsed) {
      throw Error(file + ":" + std::to_string(line_at(text, std::size_t(parsed.offset))) +
                  ": is not valid XML: " + parsed.description());
    }
    merge_texts(document_);
    check_depth();
    index();
  }

  Airspace read() {
    for (const XmlNode& airspace : airspaces_) {
      bool has_volume = false;
      for (const XmlNode& time_slice : airspace.children()) {
        const XmlNode slice = child(time_slice, "AirspaceTimeSlice");
        if (local_name(time_slice) == "timeSlice" && slice) {
          has_volume |= read_slice(airspace, slice);
        }
      }
      if (!has_volume) {
        throw wrong(airspace, "airspace '" + identifier(airspace) +
                                  "' has no volume with a horizontal projection");
      }
    }
    airspace_.notes = doubts_.notes();
    return std::move(airspace_);
  }

 private:
  Error wrong(const XmlNode& node, const std::string& why) const {
    const std::ptrdiff_t offset = std::max<std::ptrdiff_t>(node.offset_debug(), 0);
    return Error(file_ + ":" + std::to_string(line_at(text_, std::size_t(offset))) + ": " +
                 printable(why));
  }

  void check_depth() {
    struct Depth : pugi::xml_tree_walker {
      bool for_each(XmlNode&) override { return depth() <= kMaxXmlDepth; }
    } walker;
    if (!document_.traverse(walker)) {
      throw Error(file_ + ": elements are nested more than " + std::to_string(kMaxXmlDepth) +
                  " levels deep");
    }
  }

  void index() {
    std::vector<XmlNode> borders;
    find_all(document_, "Airspace", airspaces_);
    find_all(document_, "GeoBorder", borders);
    for (const XmlNode& border : borders) {
      borders_[identifier(border)] = border;
    }
    for (const XmlNode& airspace : airspaces_) {
      by_id_[identifier(airspace)] = airspace;
    }
  }

  /// False if the time slice has no volume.
  bool read_slice(const XmlNode& airspace, const XmlNode& slice) {
    Zone zone;
    zone.id = printable(text_of(slice, "designator"));
    zone.name = printable(text_of(slice, "name"));
    zone.type = printable(text_of(slice, "type"));
    if (zone.label().empty()) {
      zone.id = printable(identifier(airspace));
    }
    const std::string label = zone.label();
    bool has_volume = false;
    for (const XmlNode& component : slice.children()) {
      if (local_name(component) != "geometryComponent") {
        continue;
      }
      const XmlNode part = child(component, "AirspaceGeometryComponent");
      if (text_of(part, "operation") == "SUBTR") {
        doubts_.add("volume that is subtracted, not opened", label);
        continue;
      }
      const XmlNode volume = child(child(part, "theAirspaceVolume"), "AirspaceVolume");
      if (volume) {
        has_volume = true;
        read_volume(volume, zone);
      }
    }
    if (zone.volumes.empty()) {
      if (!has_volume) {
        doubts_.add("time slice without a volume, skipped", label);
      }
      return has_volume;
    }
    // AIXM's W is a warning area.
    zone.restriction = restriction_of(zone.type == "W" ? "WARNING" : zone.type, label, doubts_);
    ZonePeriod period = validity_of(slice, label, doubts_);
    period.hours = hours_of(slice, label, doubts_);
    zone.periods.push_back(std::move(period));
    airspace_.zones.push_back(std::move(zone));
    return true;
  }

  void read_volume(const XmlNode& volume, Zone& zone) {
    const std::string label = zone.label();
    const ZoneLimit lower =
        lower_limit(limit_at(volume, "lowerLimit", "lowerLimitReference"), label, doubts_);
    const ZoneLimit upper =
        upper_limit(limit_at(volume, "upperLimit", "upperLimitReference"), label, doubts_);
    for (Polygon& polygon : surface_of(volume, label, 0)) {
      zone.volumes.push_back({std::move(polygon), lower, upper});
      settle(zone.volumes.back(), label, doubts_);
    }
  }

  std::vector<Polygon> surface_of(const XmlNode& volume, const std::string& label, int depth) {
    constexpr int kMaxDepth = 8;
    if (const XmlNode projection = child(volume, "horizontalProjection")) {
      try {
        return read_surface(projection, borders_, label, doubts_);
      } catch (const Error& error) {
        throw wrong(volume, "airspace '" + label + "': " + error.what());
      }
    }
    const XmlNode dependency =
        child(child(volume, "contributorAirspace"), "AirspaceVolumeDependency");
    const auto found = by_id_.find(reference(child(dependency, "theAirspace")));
    if (found == by_id_.end() || depth >= kMaxDepth) {
      throw wrong(volume, "airspace '" + label +
                              "': expected a horizontalProjection, or a contributorAirspace that "
                              "the file has");
    }
    std::vector<XmlNode> parts;
    find_all(found->second, "AirspaceVolume", parts);
    std::vector<Polygon> polygons;
    for (const XmlNode& part : parts) {
      std::vector<Polygon> more = surface_of(part, label, depth + 1);
      std::move(more.begin(), more.end(), std::back_inserter(polygons));
    }
    return polygons;
  }

  const std::string& file_;
  const std::string& text_;
  pugi::xml_document document_;
  std::vector<XmlNode> airspaces_;
  std::map<std::string, XmlNode> by_id_;
  std::map<std::string, XmlNode> borders_;
  Doubts doubts_;
  Airspace airspace_{Airspace::Format::aixm, {}, {}};
};
}  // namespace

bool is_aixm(const std::string& text) {
  return text.find("www.aixm.aero/schema") != std::string::npos ||
         text.find("AIXMBasicMessage") != std::string::npos;
}

Airspace read_aixm(const std::string& file, const std::string& text) {
  return AixmReader(file, text).read();
}
}  // namespace altiplan::formats
