// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>

#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/swept_volume.hpp"
#include "altiplan/what_blocks.hpp"
#include "altiplan/world.hpp"
#include "clip.hpp"
#include "ground_zones.hpp"
#include "keep_in.hpp"
#include "published.hpp"
#include "zone_file.hpp"

namespace altiplan::zones {
namespace {

using formats::Point2;
using formats::Polygon;
using formats::Ring;
using Rings = std::vector<Ring>;

struct CylinderParams {
  Point at;
  double radius_m = 0;

  void describe(Fields& f) {
    f.point(at).required().doc("position of the axis; its height is ignored");
    f("radius_m", radius_m).unit("m").greater_than(0).required().doc("radius");
  }
};

struct PolygonParams {
  Ring outline_m;
  Ring outline_lonlat;
  Rings holes_m;
  Rings holes_lonlat;

  void describe(Fields& f) {
    f("outline_m", outline_m).unit("m").doc("corners [x, y], in either sense");
    f("outline_lonlat", outline_lonlat).unit("deg").doc("corners [longitude, latitude] instead");
    f("holes_m", holes_m).unit("m").doc("rings inside the outline that the zone excludes");
    f("holes_lonlat", holes_lonlat).unit("deg").doc("the same as [longitude, latitude]");
    f.check(outline_m.empty() != outline_lonlat.empty(),
            "a polygon needs either outline_m or outline_lonlat");
    f.check(holes_lonlat.empty() || !outline_lonlat.empty(),
            "holes_lonlat goes with outline_lonlat, holes_m with outline_m");
    f.check(holes_m.empty() || !outline_m.empty(),
            "holes_m goes with outline_m, holes_lonlat with outline_lonlat");
  }
};

/// A zone of the scenario: its keys, in which positions may be local or relative to a layer.
struct ZoneParams {
  std::string id;
  formats::Restriction kind = formats::Restriction::keep_out;
  std::optional<CylinderParams> cylinder;
  std::optional<PolygonParams> polygon;
  std::optional<double> floor_m;
  std::optional<double> ceiling_m;
  std::string from;
  std::string until;

  void describe(Fields& f) {
    f("id", id).doc("name for messages");
    f("kind", kind,
      {{"keep_out", formats::Restriction::keep_out}, {"keep_in", formats::Restriction::keep_in}})
        .doc("forbids the inside (keep_out), or everything outside the keep_in zones (keep_in)");
    f("cylinder", cylinder).doc("an upright cylinder");
    f("polygon", polygon).doc("an upright prism");
    f("floor_m", floor_m).unit("m").doc("lower limit above sea level; default: no floor");
    f("ceiling_m", ceiling_m).unit("m").doc("upper limit above sea level; default: no ceiling");
    f("from", from).doc("start of the time window (2026-06-17T05:00:00Z); default: no start");
    f("until", until).doc("end of the time window; default: no end");
    f.check(cylinder.has_value() != polygon.has_value(),
            "a zone is either a cylinder or a polygon");
    f.check(floor_m.value_or(-kInfinity) < ceiling_m.value_or(kInfinity),
            "floor_m must be below ceiling_m");
  }
};

/// How many of several keep-in zones must hold the vehicle.
enum class KeepInRule { any, all };

struct Params {
  std::vector<ZoneParams> list;
  std::optional<Path> file;
  FileRules rules;
  PublishedRules published;
  KeepInRule keep_in = KeepInRule::any;
  double buffer_m = 0;
  bool clip = false;
  double horizon_s = 3600;
  bool in_time = false;

  void describe(Fields& f) {
    f("list", list).doc("zones defined in the scenario");
    f("file", file)
        .doc(
            "zones from a file, whose content tells its kind: published airspace (ED-269, ED-318, "
            "AIXM 5.1, OpenAir, UAS facility maps of the FAA), GeoJSON (Polygons and "
            "MultiPolygons in WGS 84), KML (Polygons), or the fence of a .plan or of QGC WPL 110 "
            "(.waypoints, .txt)");
    rules.describe(f);
    published.describe(f);
    f("keep_in", keep_in, {{"any", KeepInRule::any}, {"all", KeepInRule::all}})
        .doc(
            "of several keep_in zones the vehicle must be in one (any), or in every one (all), as "
            "autopilots ask of a fence");
    f("buffer_m", buffer_m)
        .unit("m")
        .range(0, 100000)
        .doc(
            "distance to keep from each zone, in any direction: from keep_out zones outside, from "
            "the border of keep_in zones inside");
    f("clip", clip)
        .doc(
            "drop keep-out zones outside the world's bounds (the volume, else the preceding "
            "layers) and cut polygons at them; anything beyond the bounds is then ignored, also "
            "when measuring clearance near them");
    f("horizon_s", horizon_s)
        .unit("s")
        .at_least(0)
        .doc(
            "only zones that are active at some time from the scenario's start_time to this much "
            "later are used");
    f("in_time", in_time)
        .doc(
            "the judge and the planner sipp hold each leg to the keep-out zones that are active "
            "while it is flown; all else keeps out of the zones above at all times");
    f.check(!list.empty() || file.has_value(), "give zones in list, in file or in both");
    f.check(published.permitted.empty() || file.has_value(),
            "permitted names zones of published airspace: give its file");
  }
};

/// "12.5 m"
std::string metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g m", value);
  return text;
}

class Zones : public Environment, public WhatBlocks {
 public:
  Zones(const Params& params, const Site& site) : Zones(Reader(params, site)) {}

 protected:
  static constexpr std::size_t kAlways = ~std::size_t{0};

  // Everything that the constructor computes, in order.
  struct Reader {
    Site site;
    double horizon_s = 0;
    std::optional<Frame> frame;
    bool in_time = false;
    bool has_windows = false;              ///< zones that are active at times alone
    std::vector<kit::Hours::Times> times;  ///< at which a part is closed
    std::vector<std::size_t> keep_out_of;  ///< part of each zone; kAlways: of none
    std::vector<std::size_t> above_ground_of;
    std::vector<Shape> keep_out;
    std::vector<std::vector<Shape>> keep_in;  ///< the parts of each zone
    std::vector<bool> keep_in_lasts;          ///< true of one that is active all the time
    KeepInRule rule = KeepInRule::any;
    double buffer_m = 0;
    std::vector<GroundPrism> above_ground;
    std::vector<std::string> above_ground_names;
    Drawing drawing;
    std::size_t inactive = 0;
    std::size_t two_readings = 0;  // polygons, see formats::has_two_readings
    std::vector<std::string> notes;
    std::string why_none;  // zones lie within the bounds
    std::vector<Threat> threats;

    Reader() = default;
    Reader(const Params& params, const Site& where)
        : site(where),
          horizon_s(params.horizon_s),
          in_time(params.in_time && where.has_start_time),
          rule(params.keep_in),
          buffer_m(params.buffer_m) {
      drawing.keeps_in_all = rule == KeepInRule::all;
      if (params.file) {
        try {
          read_file(params);
        } catch (const ParameterError&) {
          throw;
        } catch (const Error& error) {
          throw ParameterError("file", error.what());
        }
      }
      for (std::size_t n = 0; n < params.list.size(); ++n) {
        try {
          read_zone(params.list[n], n);
        } catch (const Error& error) {
          throw ParameterError("list." + std::to_string(n), error.what());
        }
      }
      notes.push_back(
          std::to_string(keep_out.size() + above_ground.size()) + " keep-out and " +
          std::to_string(keep_in.size()) + " keep-in zones" +
          (keep_in.size() > 1 && drawing.keeps_in_all ? ", to be in all of them, " : ", ") +
          std::to_string(inactive) + " not active");
      if (buffer_m > 0) {
        notes.push_back(metres(buffer_m) + " are kept from each of them");
      }
      if (two_readings > 0) {
        notes.push_back(
            "an edge over more than half of the Earth can be read either way around in " +
            std::to_string(two_readings) +
            " polygons: both are closed; cut them at the 180th meridian");
      }
      if (!why_none.empty()) {
        notes.push_back(why_none);
      }
    }

    /// One for each zone that must hold the vehicle, or one of all zones: of those that are active
    /// all the time, since the others give no room before or after. Where none is, whatever is in
    /// all of them is in each that is active.
    std::vector<KeepIn> kept_in() {
      const bool any_lasts =
          std::find(keep_in_lasts.begin(), keep_in_lasts.end(), true) != keep_in_lasts.end();
      std::vector<KeepIn> groups;
      std::vector<Shape> any;
      for (std::size_t n = 0; n < keep_in.size(); ++n) {
        if (rule == KeepInRule::all || !any_lasts) {
          groups.emplace_back(std::move(keep_in[n]));
        } else if (keep_in_lasts[n]) {
          any.insert(any.end(), keep_in[n].begin(), keep_in[n].end());
        }
      }
      if (rule == KeepInRule::any && any_lasts && !keep_in.empty()) {
        groups.emplace_back(std::move(any));
      }
      return groups;
    }

    /// True if zones with these periods are active all the time that counts.
    bool lasts(const std::vector<formats::ZonePeriod>& periods) const {
      return periods.empty() || (periods.front().from <= site.start_time_s &&
                                 periods.front().until >= site.start_time_s + horizon_s);
    }

    void add(bool keeps_in, const std::vector<Shape>& parts, const std::string& name,
             kit::Hours::Times closed = {}) {
      if (keeps_in) {
        keep_in.push_back(parts);
      } else {
        keep_out.insert(keep_out.end(), parts.begin(), parts.end());
        keep_out_of.resize(keep_out.size(), part_of(std::move(closed)));
      }
      for (const Shape& part : parts) {
        drawing.shapes.push_back(
            {part, keeps_in ? Drawn::Role::keep_in : Drawn::Role::keep_out, name});
      }
    }

    /// The part that is closed at these times; none: at all times.
    std::size_t part_of(kit::Hours::Times closed) {
      if (closed.empty()) {
        return kAlways;
      }
      times.push_back(std::move(closed));
      return times.size() - 1;
    }

    /// The keep-out zones of which `is_closed(part)`, as they are drawn; nothing to keep in.
    template <class IsClosed>
    Reader part(const IsClosed& is_closed) const {
      Reader some;
      some.site = site;
      some.horizon_s = horizon_s;
      some.frame = frame;
      some.rule = rule;
      some.buffer_m = buffer_m;
      some.drawing.keeps_in_all = drawing.keeps_in_all;
      for (std::size_t n = 0, drawn = 0; n < keep_out.size(); ++n, ++drawn) {
        while (drawing.shapes[drawn].role == Drawn::Role::keep_in) {
          ++drawn;
        }
        if (is_closed(keep_out_of[n])) {
          some.keep_out.push_back(keep_out[n]);
          some.drawing.shapes.push_back(drawing.shapes[drawn]);
        }
      }
      for (std::size_t n = 0; n < above_ground.size(); ++n) {
        if (is_closed(above_ground_of[n])) {
          some.above_ground.push_back(above_ground[n]);
          some.above_ground_names.push_back(above_ground_names[n]);
        }
      }
      return some;
    }

    /// The same with the zones to keep in.
    template <class IsClosed>
    Reader part_kept_in(const IsClosed& is_closed) const {
      Reader some = part(is_closed);
      some.keep_in = keep_in;
      some.keep_in_lasts = keep_in_lasts;
      std::copy_if(drawing.shapes.begin(), drawing.shapes.end(),
                   std::back_inserter(some.drawing.shapes),
                   [](const Drawn& one) { return one.role == Drawn::Role::keep_in; });
      return some;
    }

    /// False for a zone that is not used; `closed` are the times of one that is closed at times.
    bool is_active(const std::vector<formats::ZonePeriod>& periods, bool keeps_in,
                   kit::Hours::Times& closed) {
      has_windows = has_windows || !periods.empty();
      if (!in_time || keeps_in || periods.empty()) {
        return is_active(periods);
      }
      formats::Zone zone;
      zone.periods = periods;
      closed = closed_times(zone, site);
      inactive += closed.empty();
      return !closed.empty();
    }

    bool is_active(const std::vector<formats::ZonePeriod>& periods) {
      if (periods.empty()) {
        return true;
      }
      if (!site.has_start_time) {
        throw Error("a zone with a time window needs the scenario's start_time");
      }
      const formats::ZonePeriod& window = periods.front();
      const bool active =
          window.from <= site.start_time_s + horizon_s && window.until >= site.start_time_s;
      inactive += !active;
      return active;
    }

    std::vector<Shape> prisms(const Polygon& lonlat, bool keeps_in, double floor, double ceiling) {
      std::vector<Shape> parts;
      two_readings += formats::has_two_readings(lonlat);
      for (Polygon& part : formats::in_frame(lonlat, site.frame, keeps_in)) {
        parts.push_back(Prism{std::move(part.outline), std::move(part.holes), floor, ceiling});
      }
      return parts;
    }

    /// Holds all of the file's zones: what lies beyond a frame's surroundings would be open.
    static Frame own_frame(const std::string& name, const FileZones& file,
                           const PublishedRules& rules) {
      std::vector<Point2> corners = corners_of(file);
      Frame own = formats::frame_around(corners);
      if (file.airspace && !formats::are_in_frame(corners, own)) {
        corners = corners_in_use(*file.airspace, rules);
        own = formats::frame_around(corners);
      }
      if (!formats::are_in_frame(corners, own)) {
        throw Error(name +
                    ": its zones lie farther apart than a frame of their own holds (20 degrees): "
                    "expected the scenario's frame: {origin_lonlat: [lon, lat]}, or a layer with a "
                    "position (terrain) before this one");
      }
      return own;
    }

    void read_file(const Params& params) {
      const std::string& name = params.file->text;
      FileZones file = read_zone_file(name, params.rules);
      notes.insert(notes.end(), file.notes.begin(), file.notes.end());
      if (!site.frame.has_position() && (file.airspace || !file.zones.empty())) {
        site.frame = own_frame(name, file, params.published);
        frame = site.frame;
      }
      try {
        expect_longitude_first(site, corners_of(file));
      } catch (const Error& error) {
        throw Error(name + ": " + error.what());
      }
      std::optional<Clip> clip;
      if (params.clip) {
        clip.emplace(site, buffer_m);
      }
      if (!file.airspace && !params.published.permitted.empty()) {
        throw ParameterError(
            "permitted", name + ": is no published airspace: no permission opens " + "its zones");
      }
      if (file.airspace) {
        add_published(*file.airspace, params, clip ? &*clip : nullptr);
      }
      for (const formats::Zone& zone : file.zones) {
        try {
          kit::Hours::Times closed;
          if (!is_active(zone.periods, zone.keeps_in(), closed)) {
            continue;
          }
          std::vector<Shape> parts;
          const std::vector<Shape> shapes = shapes_of(zone.volumes.front(), zone.keeps_in());
          if (clip && shapes.empty()) {
            clip->drop();  // on the other side of the Earth
          }
          for (const Shape& shape : shapes) {
            const std::vector<Shape> within =
                clip && !zone.keeps_in() ? clip->cut(shape) : std::vector<Shape>{shape};
            parts.insert(parts.end(), within.begin(), within.end());
          }
          add(zone.keeps_in(), parts, zone.name, std::move(closed));
          keep_in_lasts.resize(keep_in.size(), lasts(zone.periods));
        } catch (const Error& error) {
          throw Error(name + ": '" + zone.name + "': " + error.what());
        }
      }
      if (clip) {
        notes.push_back(clip->note());
        why_none = clip->why_none(corners_of(file));
      }
    }

    void add_published(const formats::Airspace& airspace, const Params& params, Clip* clip) {
      Published published =
          published_zones(airspace, params.published, site, params.horizon_s, in_time, clip);
      has_windows = has_windows || site.has_start_time;
      notes.insert(notes.end(), published.notes.begin(), published.notes.end());
      inactive += published.inactive;
      two_readings += published.two_readings;
      for (PublishedZone& zone : published.zones) {
        if (zone.limits.follows_ground()) {
          above_ground.push_back(std::move(zone.limits));
          above_ground_of.push_back(part_of(std::move(zone.closed)));
          above_ground_names.push_back(zone.name);
        } else {
          add(false, {zone.limits.prism}, zone.name, std::move(zone.closed));
        }
      }
    }

    /// A circle where the frame makes it none: chords around it, or within it to stay in, that are
    /// at most half a centimetre off.
    static Ring circle(const formats::ZoneVolume& volume, bool keeps_in) {
      constexpr double kChord = 0.005;
      const double half_step = std::acos(volume.radius_m / (volume.radius_m + kChord));
      const int corners = std::max(8, int(std::ceil(kPi / half_step)));
      const double radius = keeps_in ? volume.radius_m : volume.radius_m / std::cos(kPi / corners);
      Ring ring;
      for (int n = 0; n < corners; ++n) {
        ring.push_back(geodesic_end(volume.centre, 360.0 * n / corners, radius));
      }
      return formats::continuous(ring);
    }

    /// Of a volume whose limits are above sea level.
    std::vector<Shape> shapes_of(const formats::ZoneVolume& volume, bool keeps_in) {
      const auto height = [](const formats::ZoneLimit& limit, double none) {
        return limit.datum == formats::ZoneLimit::Datum::none ? none : limit.metres;
      };
      const double floor = height(volume.lower, -kInfinity);
      const double ceiling = height(volume.upper, kInfinity);
      if (volume.polygon.outline.empty()) {
        const auto [x, y] = site.frame.to_local(volume.centre[0], volume.centre[1]);
        const double inner = formats::radius_in(site.frame, volume.centre, volume.radius_m, true);
        const double outer = formats::radius_in(site.frame, volume.centre, volume.radius_m, false);
        constexpr double kRound = 0.01;  // metres
        return outer - inner <= kRound
                   ? std::vector<Shape>{Cylinder{x, y, keeps_in ? inner : outer, floor, ceiling}}
                   : prisms({circle(volume, keeps_in), {}}, keeps_in, floor, ceiling);
      }
      return prisms(volume.polygon, keeps_in, floor, ceiling);
    }

    void read_zone(const ZoneParams& zone, std::size_t n) {
      const double floor = zone.floor_m.value_or(-kInfinity);
      const double ceiling = zone.ceiling_m.value_or(kInfinity);
      const bool keeps_in = zone.kind == formats::Restriction::keep_in;
      std::vector<Shape> shapes;
      if (zone.cylinder) {
        if (zone.cylinder->at.above_ground_m) {
          throw Error("above_ground_m does not go with a zone: use floor_m and ceiling_m");
        }
        const Vec3 at = site.resolve(zone.cylinder->at);
        shapes = {Cylinder{at.x(), at.y(), zone.cylinder->radius_m, floor, ceiling}};
      } else {
        const bool is_local = !zone.polygon->outline_m.empty();
        Polygon polygon{formats::without_repeats(is_local ? zone.polygon->outline_m
                                                          : zone.polygon->outline_lonlat),
                        is_local ? zone.polygon->holes_m : zone.polygon->holes_lonlat};
        for (Ring& hole : polygon.holes) {
          hole = formats::without_repeats(hole);
        }
        if (!is_local) {
          polygon = formats::unfolded(std::move(polygon));
        }
        if (const std::string problem = formats::polygon_problem(polygon); !problem.empty()) {
          throw Error(problem);
        }
        shapes = is_local
                     ? std::vector<Shape>{Prism{polygon.outline, polygon.holes, floor, ceiling}}
                     : prisms(polygon, keeps_in, floor, ceiling);
      }
      kit::Hours::Times closed;
      if (!is_active(time_window(zone.from, zone.until), keeps_in, closed)) {
        return;
      }
      add(keeps_in, shapes, zone.id, std::move(closed));
      keep_in_lasts.resize(keep_in.size(), lasts(time_window(zone.from, zone.until)));
      if (zone.cylinder && !keeps_in) {
        const auto& cylinder = std::get<Cylinder>(shapes.front());
        const double middle = std::isfinite(floor + ceiling) ? (floor + ceiling) / 2 : 0;
        threats.push_back({{cylinder.x, cylinder.y, middle},
                           cylinder.radius + buffer_m,
                           "zone",
                           zone.id.empty() ? "zone_" + std::to_string(n) : zone.id});
      }
    }
  };

  explicit Zones(Reader&& reader)
      : keep_out_(std::move(reader.keep_out)),
        keep_in_(reader.kept_in()),
        above_ground_(*reader.site.before, std::move(reader.above_ground)),
        buffer_(reader.buffer_m),
        over_approximation_(
            above_ground_.over_approximation(reader.site.vehicle.radius_m + buffer_)),
        drawing_(std::move(reader.drawing)),
        above_ground_names_(std::move(reader.above_ground_names)),
        info_{std::move(reader.frame), {}, std::move(reader.threats), std::move(reader.notes)} {}

 private:
  Box do_bounds() const override {
    return keep_in_.empty() ? keep_out_.bounds().united(above_ground_.bounds()).grown(buffer_)
                            : Box{};
  }
  double do_clearance(const Vec3& p) const override {
    double nearest = keep_out_.clearance(p);
    if (!above_ground_.empty()) {
      nearest = std::min(nearest, above_ground_.clearance(p));
    }
    for (const KeepIn& zones : keep_in_) {
      nearest = std::min(nearest, zones.clearance(p));
    }
    return nearest - buffer_;
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double radius) const override {
    const double r = radius + buffer_;
    return keep_out_.blocked(a, b, r) || above_ground_.blocked(a, b, r) ||
           std::any_of(keep_in_.begin(), keep_in_.end(),
                       [&](const KeepIn& zones) { return zones.blocked(a, b, r); });
  }
  void do_near(const Vec3& p, double to_buffer, const NearSink& to) const override {
    const double reach = to_buffer + buffer_;
    const auto sink = [&](Nearby nearby) {
      nearby.point += nearby.normal * buffer_;
      nearby.distance -= buffer_;
      to(nearby);
    };
    keep_out_.near(p, reach, sink);
    const int count = static_cast<int>(keep_out_.shapes().size());
    above_ground_.near(p, reach, count, sink);
    int id = count + static_cast<int>(above_ground_.size());
    for (const KeepIn& zones : keep_in_) {
      Nearby outside = zones.nearest(p);
      outside.id = id++;
      if (outside.distance <= reach) {
        sink(outside);
      }
    }
  }
  void do_rasterize(VoxelGrid& grid) const override {
    if (buffer_ == 0) {
      rasterize_grown(grid);
      return;
    }
    GridSpec spec = grid.spec();
    spec.inflation += buffer_;
    VoxelGrid grown(spec);
    grown.watch([&grid] { grid.ask_watch(); });
    rasterize_grown(grown);
    for (int k = 0; k < spec.counts[2]; ++k) {
      for (int j = 0; j < spec.counts[1]; ++j) {
        grown.for_each_run(j, k, [&](int first, int last) { grid.block_run(first, last, j, k); });
      }
    }
  }
  /// The zones, grown by the grid's inflation.
  void rasterize_grown(VoxelGrid& grid) const {
    keep_out_.rasterize(grid);
    above_ground_.rasterize(grid);
    for (const KeepIn& zones : keep_in_) {
      zones.rasterize(grid);
    }
  }
  double do_over_approximation() const override { return over_approximation_; }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Drawing> do_drawing() const override {
    // Limits above ground take thousands of heights, which few calls need.
    std::call_once(is_drawn_, [this] {
      for (std::size_t n = 0; n < above_ground_names_.size(); ++n) {
        drawing_.shapes.push_back(
            {above_ground_.drawn(n), Drawn::Role::keep_out, above_ground_names_[n]});
      }
    });
    return drawing_;
  }
  bool do_meets(const SweptVolume& volume) const override {
    if (buffer_ > 0) {
      return meets_by_clearance(
          volume, [this](const Vec3& p) { return do_clearance(p); }, kBodyTolerance);
    }
    return keep_out_.meets(volume) || above_ground_.meets(volume) ||
           std::any_of(keep_in_.begin(), keep_in_.end(),
                       [&](const KeepIn& zones) { return zones.meets(volume); });
  }

  std::string do_what_blocks(const Vec3&, const Vec3&, double distance) const override {
    const double away = distance + buffer_;
    return buffer_ > 0 ? metres(std::abs(away)) +
                             (away < 0 ? " beyond a zone's border" : " from a zone's border") +
                             ", from which " + metres(buffer_) + " are kept"
                       : "";
  }

  kit::ObstacleSet keep_out_;
  std::vector<KeepIn> keep_in_;  ///< each must hold the vehicle
  GroundZones above_ground_;
  double buffer_;  ///< metres that are kept from all of them
  double over_approximation_;
  mutable Drawing drawing_;
  mutable std::once_flag is_drawn_;
  std::vector<std::string> above_ground_names_;
  LayerInfo info_;
};

/// Zones of which some are closed at times: closed to what knows no time if they are within the
/// horizon.
class ZonesInTime final : public Zones, public kit::Hours {
 public:
  ZonesInTime(const Params& params, const Site& site)
      : ZonesInTime(std::make_shared<Reader>(params, site)) {}

 private:
  explicit ZonesInTime(const std::shared_ptr<Reader>& all) : Zones(at_some_time(*all)) {
    known_until_s_ = all->has_windows ? all->horizon_s : kInfinity;
    if (all->times.empty()) {
      return;
    }
    all_ = all;
    before_ = *all->site.before;
    all_->site.before = &before_;
    for (std::size_t n = 0; n < all->times.size(); ++n) {
      Reader one = all->part([&](std::size_t part) { return part == n; });
      parts_.push_back({std::make_shared<const ZonePart>(std::move(one)), all->times[n]});
    }
  }

  static Reader at_some_time(Reader& all) {
    if (all.times.empty()) {
      return std::move(all);
    }
    Reader some = all.part_kept_in([&](std::size_t part) {
      return part == kAlways || kit::Hours::meet(all.times[part], 0, all.horizon_s);
    });
    some.notes = all.notes;
    some.threats = all.threats;
    return some;
  }

  class ZonePart final : public Zones {
   public:
    explicit ZonePart(Reader&& reader) : Zones(std::move(reader)) {}
  };

  const std::vector<kit::Hours::Part>& do_parts() const override { return parts_; }
  std::shared_ptr<const Environment> do_between(double from, double until) const override {
    std::vector<bool> closed(parts_.size());
    for (std::size_t n = 0; n < parts_.size(); ++n) {
      closed[n] = kit::Hours::meet(parts_[n].closed, from, until);
    }
    const std::lock_guard lock(mutex_);
    std::shared_ptr<const Environment>& known = known_[closed];
    if (known == nullptr) {
      known = std::make_shared<const ZonePart>(
          all_->part_kept_in([&](std::size_t part) { return part == kAlways || closed[part]; }));
    }
    return known;
  }

  double do_known_until_s() const override { return known_until_s_; }

  double known_until_s_ = kInfinity;
  World before_;
  std::shared_ptr<Reader> all_;  ///< null where no zone has times
  std::vector<kit::Hours::Part> parts_;
  mutable std::mutex mutex_;
  mutable std::map<std::vector<bool>, std::shared_ptr<const Environment>> known_;
};
}  // namespace
}  // namespace altiplan::zones

ALTIPLAN_PLUGIN(Environment, "zones", altiplan::zones::ZonesInTime, altiplan::zones::Params,
                "keep-out and keep-in zones: cylinders, polygons, published airspace, GeoJSON, "
                "KML, fences, time "
                "windows")
