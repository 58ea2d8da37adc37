// SPDX-License-Identifier: Apache-2.0
#include "published.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>

#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/ground.hpp"
#include "clip.hpp"

namespace altiplan::zones {
namespace {

using formats::Zone;
using formats::ZoneLimit;
using formats::ZoneVolume;
using Datum = ZoneLimit::Datum;
using Use = PublishedRules::Use;

class Converter {
 public:
  Converter(const PublishedRules& rules, const Site& site, Clip* clip)
      : rules_(rules), site_(site), clip_(clip), ground_(ground_area(*site.before)) {}

  void add(const Zone& zone) {
    for (const ZoneVolume& volume : zone.volumes) {
      GroundPrism limits{{}, -kInfinity, kInfinity};
      set(volume.lower, limits.prism.floor, limits.above_floor);
      set(volume.upper, limits.prism.ceiling, limits.above_ceiling);
      two_readings += formats::has_two_readings(volume.polygon);
      for (formats::Polygon& polygon : formats::in_frame(volume.polygon, site_.frame)) {
        limits.prism.outline = std::move(polygon.outline);
        limits.prism.holes = std::move(polygon.holes);
        add_near(zone.label(), limits);
      }
    }
  }

  std::vector<PublishedZone> zones;
  kit::Hours::Times closed;  ///< times of the zones that are added
  std::size_t two_readings = 0;

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    if (levels_ > 0) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "%zu limits are flight levels: altitudes in the standard atmosphere at QNH "
                    "%.2f hPa (FL100 = %.0f m)",
                    levels_, rules_.qnh_hpa, formats::standard_to_sea(3048, rules_.qnh_hpa));
      notes.emplace_back(text);
    }
    if (without_ground_ > 0) {
      notes.push_back(std::to_string(without_ground_) +
                      " volumes with limits above ground closed at all heights: " +
                      (site_.before->has_ground() ? "the ground below them has holes"
                                                  : "expected a layer with ground (terrain) "
                                                    "before this one"));
    }
    if (beyond_ > 0) {
      notes.push_back(std::to_string(beyond_) +
                      " volumes with limits above ground closed at all heights beyond the ground");
    }
    std::vector<std::string> open;
    std::size_t partly = 0;
    for (const auto& [name, places] : empty_) {
      if (places.closed == 0) {
        open.push_back(name);
      }
      partly += places.closed > 0 && places.open > 0;
    }
    if (!open.empty()) {
      notes.push_back(
          "nothing is closed, as the ceiling is below the floor, or the ground, there: " +
          formats::names_text(open));
    }
    if (partly > 0) {
      notes.push_back("the ceiling is below the floor, or the ground, over parts of " +
                      std::to_string(partly) + " zones");
    }
    return notes;
  }

 private:
  void add_near(const std::string& name, GroundPrism limits) {
    const std::vector<Shape> parts =
        clip_ != nullptr ? clip_->cut(limits.prism) : std::vector<Shape>{limits.prism};
    for (const Shape& part : parts) {
      limits.prism = std::get<Prism>(part);
      add_part(name, limits);
    }
  }

  void set(const ZoneLimit& limit, double& sea, double& above) {
    if (limit.datum == Datum::ground) {
      above = limit.metres;
    } else if (limit.datum == Datum::standard) {
      ++levels_;
      sea = formats::standard_to_sea(limit.metres, rules_.qnh_hpa);
    } else if (limit.datum == Datum::sea) {
      sea = limit.metres;
    }
  }

  void close(const std::string& name, Prism prism) {
    ++empty_[name].closed;
    prism.floor = -kInfinity;
    prism.ceiling = kInfinity;
    zones.push_back({name, {std::move(prism)}, closed});
  }

  /// Places spread over a zone at which something is closed, or nothing.
  struct Places {
    std::size_t closed = 0;
    std::size_t open = 0;
  };

  /// Where the ceiling is not above the floor and the ground.
  void look_for_empty(const std::string& name, const GroundPrism& limits) {
    constexpr double kAlong = 8;
    std::vector<Vec3> places;
    for (const auto& [x, y] : limits.prism.outline) {
      places.emplace_back(x, y, 0);
    }
    const Shape outline = Prism{limits.prism.outline, limits.prism.holes};
    const Box area = bounds(outline);
    for (double east = 0.5; east < kAlong; ++east) {
      for (double north = 0.5; north < kAlong; ++north) {
        const Vec3 place(area.min.x() + east / kAlong * (area.max.x() - area.min.x()),
                         area.min.y() + north / kAlong * (area.max.y() - area.min.y()), 0);
        if (signed_distance(outline, place) < 0) {
          places.push_back(place);
        }
      }
    }
    Places& found = empty_[name];
    for (const Vec3& place : places) {
      const auto ground = site_.before->ground(place.x(), place.y());
      const double floor =
          std::max(limits.prism.floor, ground.value_or(0) + std::max(0.0, limits.above_floor));
      const double ceiling =
          std::min(limits.prism.ceiling, ground.value_or(0) + limits.above_ceiling);
      ++(!ground || ceiling > floor ? found.closed : found.open);
    }
  }

  /// Closed at all heights where the ground is not known.
  void add_part(const std::string& name, const GroundPrism& limits) {
    if (!limits.follows_ground()) {
      zones.push_back({name, limits, closed});
      look_for_empty(name, limits);
      return;
    }
    if (!site_.before->has_ground()) {
      ++without_ground_;
      close(name, limits.prism);
      return;
    }
    const Parts parts = split(limits.prism, ground_);
    for (const Prism& within : parts.within) {
      const double slope = site_.before->ground_slope(bounds(Shape(within)));
      if (std::isfinite(slope)) {
        GroundPrism above = limits;
        above.prism = within;
        above.slope = slope;
        look_for_empty(name, above);
        zones.push_back({name, std::move(above), closed});
      } else {
        ++without_ground_;
        close(name, within);
      }
    }
    beyond_ += !parts.beyond.empty();
    for (const Prism& beyond : parts.beyond) {
      close(name, beyond);
    }
  }

  const PublishedRules& rules_;
  const Site& site_;
  Clip* clip_;
  Box ground_;
  std::size_t levels_ = 0;
  std::size_t without_ground_ = 0;
  std::size_t beyond_ = 0;
  std::map<std::string, Places> empty_;  ///< by the name of a zone
};

bool has_times(const Zone& zone) {
  return std::any_of(zone.periods.begin(), zone.periods.end(), [](const auto& period) {
    return std::isfinite(period.from) || std::isfinite(period.until) || !period.hours.empty();
  });
}

Use use_of(const Zone& zone, const PublishedRules& rules) {
  if (zone.takes_permission() &&
      std::any_of(rules.permitted.begin(), rules.permitted.end(),
                  [&](const std::string& called) { return zone.is_called(called); })) {
    return Use::skip;
  }
  switch (zone.restriction) {
    case formats::Restriction::ask:
      return rules.ask;
    case formats::Restriction::inform:
      return rules.inform;
    default:
      return Use::keep_out;
  }
}

/// The zones that a permission opens: "open by a permission: 'LSZB CTR'", "" if there are none.
std::string opened(const formats::Airspace& airspace, const PublishedRules& rules) {
  std::vector<std::string> names;
  for (const Zone& zone : airspace.zones) {
    if (zone.restriction == formats::Restriction::ask && use_of(zone, rules) == Use::skip) {
      names.push_back(zone.label());
    }
  }
  return names.empty() ? "" : "open by a permission: " + formats::names_text(names);
}

/// "keep out: 2 P, 6 R; ask (closed): 3 CTR; inform (skipped): 4 G"
std::string mapping(const formats::Airspace& airspace, const PublishedRules& rules) {
  std::map<formats::Restriction, std::map<std::string, std::size_t>> counts;
  for (const Zone& zone : airspace.zones) {
    if (zone.restriction == formats::Restriction::ask && rules.ask != use_of(zone, rules)) {
      continue;  // by its name
    }
    ++counts[zone.restriction][zone.type.empty() ? "without a class" : zone.type];
  }
  const auto heading = [](const char* word, Use use) {
    return std::string(word) + (use == Use::skip ? " (skipped): " : " (closed): ");
  };
  std::string text;
  for (const auto& [restriction, types] : counts) {
    text += text.empty() ? "" : "; ";
    text += restriction == formats::Restriction::keep_out ? "keep out (closed): "
            : restriction == formats::Restriction::ask    ? heading("ask", rules.ask)
                                                          : heading("inform", rules.inform);
    const char* comma = "";
    for (const auto& [type, count] : types) {
      text += comma + std::to_string(count) + " " + type;
      comma = ", ";
    }
  }
  return text;
}
}  // namespace

kit::Hours::Times closed_times(const Zone& zone, const Site& site) {
  constexpr double kMonth = 30 * 86400.0;
  const bool has_hours = std::any_of(zone.periods.begin(), zone.periods.end(),
                                     [](const auto& period) { return !period.hours.empty(); });
  const double start = site.start_time_s;
  kit::Hours::Times times = zone.active_between(start, has_hours ? start + kMonth : kInfinity);
  for (auto& each : times) {
    each = {each[0] - start, each[1] - start};
  }
  if (has_hours) {
    times.push_back({kMonth, kInfinity});
  }
  return times;
}

void PublishedRules::describe(Fields& f) {
  f("ask", ask, {{"keep_out", Use::keep_out}, {"skip", Use::skip}})
      .doc("published airspace that takes a permission: closed, or ignored because you have it");
  f("inform", inform, {{"keep_out", Use::keep_out}, {"skip", Use::skip}})
      .doc("published airspace that only informs");
  f("permitted", permitted)
      .doc(
          "identifiers or names of zones of published airspace that are open, because you have "
          "the permission that they take");
  f("qnh_hpa", qnh_hpa)
      .unit("hPa")
      .range(850, 1100)
      .doc("air pressure at sea level, for limits that are flight levels");
}

std::vector<formats::Point2> corners_in_use(const formats::Airspace& airspace,
                                            const PublishedRules& rules) {
  std::vector<Zone> used;
  std::copy_if(airspace.zones.begin(), airspace.zones.end(), std::back_inserter(used),
               [&](const Zone& zone) { return use_of(zone, rules) != Use::skip; });
  return formats::corners_of(used.empty() ? airspace.zones : used);
}

Published published_zones(const formats::Airspace& airspace, const PublishedRules& rules,
                          const Site& site, double horizon_s, bool in_time, Clip* clip) {
  for (const std::string& called : rules.permitted) {
    if (const std::string why = formats::permission_problem(airspace.zones, called); !why.empty()) {
      throw ParameterError("permitted", why);
    }
  }
  Published published;
  Converter converter(rules, site, clip);
  std::size_t volumes = 0;
  std::size_t timed = 0;
  for (const Zone& zone : airspace.zones) {
    volumes += zone.volumes.size();
    if (use_of(zone, rules) == Use::skip) {
      continue;
    }
    timed += !site.has_start_time && has_times(zone);
    const bool is_in_time = in_time && has_times(zone);
    kit::Hours::Times closed = is_in_time ? closed_times(zone, site) : kit::Hours::Times{};
    const bool is_used =
        !site.has_start_time ||
        (is_in_time ? !closed.empty()
                    : zone.is_active(site.start_time_s, site.start_time_s + horizon_s));
    if (!is_used) {
      ++published.inactive;
      continue;
    }
    converter.closed = std::move(closed);
    converter.add(zone);
  }
  published.notes = {formats::format_name(airspace.format) + ": " +
                         std::to_string(airspace.zones.size()) + " zones of " +
                         std::to_string(volumes) + " volumes read",
                     mapping(airspace, rules)};
  if (const std::string names = opened(airspace, rules); !names.empty()) {
    published.notes.push_back(names);
  }
  const std::vector<std::string> more = converter.notes();
  published.notes.insert(published.notes.end(), more.begin(), more.end());
  published.notes.insert(published.notes.end(), airspace.notes.begin(), airspace.notes.end());
  if (timed > 0) {
    published.notes.push_back(std::to_string(timed) +
                              " zones with times closed at all times: when the flight starts is "
                              "not given");
  }
  published.two_readings = converter.two_readings;
  published.zones = std::move(converter.zones);
  return published;
}
}  // namespace altiplan::zones
