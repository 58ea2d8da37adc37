// SPDX-License-Identifier: Apache-2.0
#include "place.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "altiplan/earth.hpp"
#include "altiplan/error.hpp"
#include "altiplan/map_system.hpp"

namespace terrain {
namespace {

using altiplan::Box;
using altiplan::Frame;
using altiplan::ParameterError;
using altiplan::Vec3;
using XY = std::array<double, 2>;

/// Between a coordinate system (x, y in its own units) and WGS 84. GDAL's transformations serve one
/// thread at a time.
class ToWgs84 {
 public:
  explicit ToWgs84(const gdal::Reference& crs) {
    if (crs) {
      const gdal::Reference wgs84 = gdal::reference("EPSG:4326");
      there_.emplace(crs, wgs84);
      back_.emplace(wgs84, crs);
    }
  }
  XY lonlat(const XY& p) const { return by(there_, p); }
  XY native(double lon, double lat) const { return by(back_, {lon, lat}); }

 private:
  XY by(const std::optional<gdal::Transform>& transform, const XY& p) const {
    if (!transform) {
      return p;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    return (*transform)(p[0], p[1]);
  }

  mutable std::mutex mutex_;
  std::optional<gdal::Transform> there_;  ///< none for WGS 84 itself
  std::optional<gdal::Transform> back_;
};

/// The width of a map of the whole Earth whose east side is its west side, in its units, by a walk
/// around the Earth at a latitude; 0 for other maps.
double width_of(const ToWgs84& map, double lat) try {
  constexpr int kSteps = 36;
  double jump = 0;
  double width = 0;
  XY before = map.native(-180, lat);
  for (int n = 1; n <= kSteps; ++n) {
    const XY p = map.native(-180 + 360.0 * n / kSteps, lat);
    const double step = p[0] - before[0];
    if (step < 0 && jump != 0) {
      return 0;
    }
    jump = step < 0 ? step : jump;
    width += step < 0 ? 0 : step;
    before = p;
  }
  return jump == 0 ? width : -jump * kSteps / (kSteps - 1);
} catch (const altiplan::Error&) {
  return 0;
}

/// The axes of a projected system, with a separate origin and in metres.
class MapProjection final : public altiplan::Projection {
 public:
  /// `unit_m`: metres for one of the system's units along each axis.
  MapProjection(std::shared_ptr<const ToWgs84> map, const XY& origin, const XY& unit_m)
      : map_(std::move(map)), origin_(origin), unit_m_(unit_m) {
    width_ = width_of(*map_, map_->lonlat(origin)[1]);
  }
  XY to_local(double lon, double lat) const override {
    XY p = map_->native(lon, lat);
    if (width_ > 0) {
      p[0] -= width_ * std::round((p[0] - origin_[0]) / width_);
    }
    return {(p[0] - origin_[0]) * unit_m_[0], (p[1] - origin_[1]) * unit_m_[1]};
  }
  XY to_lonlat(double x, double y) const override {
    return map_->lonlat({origin_[0] + x / unit_m_[0], origin_[1] + y / unit_m_[1]});
  }

 private:
  std::shared_ptr<const ToWgs84> map_;
  XY origin_;
  XY unit_m_;
  double width_ = 0;
};

XY middle_of(const Dem& dem) {
  return {dem.south_west[0] + (dem.columns - 1) * dem.step[0] / 2,
          dem.south_west[1] + (dem.rows - 1) * dem.step[1] / 2};
}

/// Longitude and latitude of another datum are shifted as a whole, by the shift at the centre.
XY datum_shift(const Dem& dem) {
  if (!dem.crs || gdal::api().OSRIsSameGeogCS(dem.crs.get(), gdal::reference("EPSG:4326").get())) {
    return {0, 0};
  }
  const XY middle = middle_of(dem);
  const XY there = ToWgs84(dem.crs).lonlat(middle);
  return {there[0] - middle[0], there[1] - middle[1]};
}

/// The model's own axes, true to scale at a latitude or by factors.
struct OwnScale {
  double lat;
  XY factors;
};

Layout in_own_frame(const Dem& dem, const std::optional<OwnScale>& scale = {}) {
  Frame frame;
  XY spacing;
  if (dem.geographic) {
    const XY shift = datum_shift(dem);
    const double lon = dem.south_west[0] + shift[0];
    const double lat = dem.south_west[1] + shift[1];
    const double height_deg = (dem.rows - 1) * dem.step[1];
    const double width_deg = (dem.columns - 1) * dem.step[0];
    frame =
        Frame::geographic(lon, lat, scale ? scale->lat : lat + height_deg / 2, lon + width_deg / 2);
    // By the spacing of one post: a model may span more than half of the Earth.
    spacing = frame.to_local(lon + dem.step[0], lat + dem.step[1]);
  } else {
    const XY factors = scale ? scale->factors : XY{1, 1};
    const XY unit_m{dem.unit_m * factors[0], dem.unit_m * factors[1]};
    frame = Frame::projected(
        std::make_shared<MapProjection>(std::make_shared<ToWgs84>(dem.crs), dem.south_west, unit_m),
        dem.crs_name + (scale ? ", scaled by " + number(factors[0]) : ""));
    spacing = {dem.step[0] * unit_m[0], dem.step[1] * unit_m[1]};
  }
  return {frame, {0, 0}, spacing, dem.columns, dem.rows, false, {}};
}

/// The model as seen from a frame: posts are (column, row) from the south-west, as fractions.
class View {
 public:
  View(const Dem& dem, const Frame& frame) : dem_(dem), map_(dem.crs), frame_(frame) {}

  XY local(double column, double row) const {
    const XY lonlat = map_.lonlat(
        {dem_.south_west[0] + column * dem_.step[0], dem_.south_west[1] + row * dem_.step[1]});
    return frame_.to_local(lonlat[0], lonlat[1]);
  }
  XY post(double x, double y) const {
    const XY lonlat = frame_.to_lonlat(x, y);
    XY p = map_.native(lonlat[0], lonlat[1]);
    if (dem_.geographic) {
      p[0] = altiplan::longitude_near(p[0], middle_of(dem_)[0]);
    }
    return {(p[0] - dem_.south_west[0]) / dem_.step[0], (p[1] - dem_.south_west[1]) / dem_.step[1]};
  }
  bool covers(double x, double y) const try {
    const XY at = post(x, y);
    return at[0] >= 0 && at[0] <= dem_.columns - 1 && at[1] >= 0 && at[1] <= dem_.rows - 1;
  } catch (const altiplan::Error&) {
    return false;  // where its system is undefined
  }

 private:
  const Dem& dem_;
  ToWgs84 map_;
  const Frame& frame_;
};

/// The rectangle between the images of the model's edges, and the spacing in its middle.
struct Footprint {
  XY low;
  XY high;
  XY spacing;
  bool is_grid = true;  ///< the posts' images are a grid along the frame's axes
};

Footprint footprint(const Dem& dem, const View& view) {
  const double last_i = dem.columns - 1;
  const double last_j = dem.rows - 1;
  Footprint print{
      {-altiplan::kInfinity, -altiplan::kInfinity}, {altiplan::kInfinity, altiplan::kInfinity}, {}};
  constexpr int kPoints = 64;
  for (int k = 0; k <= kPoints; ++k) {
    const double i = last_i * k / kPoints;
    const double j = last_j * k / kPoints;
    print.low[0] = std::max(print.low[0], view.local(0, j)[0]);
    print.high[0] = std::min(print.high[0], view.local(last_i, j)[0]);
    print.low[1] = std::max(print.low[1], view.local(i, 0)[1]);
    print.high[1] = std::min(print.high[1], view.local(i, last_j)[1]);
  }
  const XY middle = view.local(last_i / 2, last_j / 2);
  const XY column = view.local(last_i / 2 + 1, last_j / 2);
  const XY row = view.local(last_i / 2, last_j / 2 + 1);
  print.spacing = {std::abs(column[0] - middle[0]), std::abs(row[1] - middle[1])};
  const double across = std::hypot(column[0] - middle[0], column[1] - middle[1]);
  const double up = std::hypot(row[0] - middle[0], row[1] - middle[1]);
  constexpr double kAskew = 0.8;  // the cosine of 37 degrees
  if (print.spacing[0] < kAskew * across || print.spacing[1] < kAskew * up) {
    print.spacing = {std::min(across, up), std::min(across, up)};
  }
  const XY origin = view.local(0, 0);
  constexpr double kSame = 1e-4;  // metres: round-trip error of transformations
  for (const XY& share : {XY{0, 1}, XY{1, 0}, XY{1, 1}, XY{0.5, 0.5}, XY{0.25, 0.75}}) {
    const XY p = view.local(share[0] * last_i, share[1] * last_j);
    print.is_grid =
        print.is_grid &&
        std::hypot(p[0] - origin[0] - share[0] * (print.high[0] - print.low[0]),
                   p[1] - origin[1] - share[1] * (print.high[1] - print.low[1])) < kSame;
  }
  return print;
}
}  // namespace

Box reach_of(const Frame& frame, const std::vector<altiplan::LonLat>& about, double metres) {
  if (about.empty()) {
    return {};
  }
  Box box = Box::empty();
  for (const auto& [lon, lat] : about) {
    const XY p = frame.to_local(lon, lat);
    box = box.with({p[0], p[1], 0});
  }
  return box.grown(metres);
}

namespace {
/// A rectangle along the frame's axes that the model covers, however its rows run: as far about the
/// mission, or else the middle, as it goes, then each side as far as it goes.
Box rectangle_in(const View& view, const Box& mission, const Vec3& middle, double reach) {
  const auto is_covered = [&](const Box& box) {
    constexpr int kPoints = 32;
    for (int k = 0; k <= kPoints; ++k) {
      const Vec3 at = box.min + (box.max - box.min) * k / kPoints;
      if (!view.covers(at.x(), box.min.y()) || !view.covers(at.x(), box.max.y()) ||
          !view.covers(box.min.x(), at.y()) || !view.covers(box.max.x(), at.y())) {
        return false;
      }
    }
    return true;
  };
  const auto longest = [&](double maximum, const auto& grown) {
    double low = 0;
    for (double high = maximum; high - low > 1e-3 * (1 + low);) {
      const double length = (low + high) / 2;
      (is_covered(grown(length)) ? low : high) = length;
    }
    return low;
  };
  const Box point{Vec3(middle.x(), middle.y(), 0), Vec3(middle.x(), middle.y(), 0)};
  const Box& seed = mission.is_bounded() && is_covered(mission) ? mission : point;
  Box box = seed.grown(longest(reach, [&](double by) { return seed.grown(by); }));
  for (int axis = 0; axis < 2; ++axis) {
    for (Vec3 Box::*const side : {&Box::min, &Box::max}) {
      const auto grown = [&](double by) {
        Box larger = box;
        (larger.*side)[axis] += side == &Box::min ? -by : by;
        return larger;
      };
      box = grown(longest(reach, grown));
    }
  }
  return box;
}

/// The model's own posts below the layout's.
Part needed_for(const Dem& dem, const View& view, const Layout& layout) {
  constexpr int kPoints = 64;
  XY low{altiplan::kInfinity, altiplan::kInfinity};
  XY high{-altiplan::kInfinity, -altiplan::kInfinity};
  for (int i = 0; i <= kPoints; ++i) {
    for (int j = 0; j <= kPoints; ++j) {
      const XY at =
          view.post(layout.origin[0] + (layout.columns - 1) * layout.spacing[0] * i / kPoints,
                    layout.origin[1] + (layout.rows - 1) * layout.spacing[1] * j / kPoints);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], at[axis]);
        high[axis] = std::max(high[axis], at[axis]);
      }
    }
  }
  // Between the points the model's rows bend by less than this.
  const auto margin = [&](std::size_t axis) { return 2 + (high[axis] - low[axis]) / kPoints; };
  const auto range = [&](std::size_t axis, int posts) {
    const int first = int(std::clamp(low[axis] - margin(axis), 0.0, posts - 2.0));
    const int last = int(std::clamp(high[axis] + margin(axis), first + 1.0, posts - 1.0));
    return std::array<int, 2>{first, last - first + 1};
  };
  const auto [column, columns] = range(0, dem.columns);
  const auto [row, rows] = range(1, dem.rows);
  return {column, row, columns, rows};
}

Layout in_frame(const Dem& dem, const Frame& frame, const Params& params,
                const std::vector<altiplan::LonLat>& about) {
  const View view(dem, frame);
  Footprint print = footprint(dem, view);
  const auto is_empty = [](const Footprint& p) {
    return !(p.high[0] - p.low[0] > 2 * p.spacing[0] && p.high[1] - p.low[1] > 2 * p.spacing[1]);
  };
  if (print.is_grid && !is_empty(print)) {
    const XY spacing{(print.high[0] - print.low[0]) / (dem.columns - 1),
                     (print.high[1] - print.low[1]) / (dem.rows - 1)};
    return {frame, print.low, spacing, dem.columns, dem.rows, false, {}};
  }
  Box reach = reach_of(frame, about, kReach);
  const Box whole{Vec3(print.low[0], print.low[1], 0), Vec3(print.high[0], print.high[1], 0)};
  if (!is_empty(print) && whole.intersected(reach).is_empty()) {
    reach = {};  // a tile beside the mission's
  }
  if (is_empty(print) || std::isfinite(reach.min.x())) {
    Vec3 middle = (reach.min + reach.max) / 2;
    if (!altiplan::is_finite(middle) || !view.covers(middle.x(), middle.y())) {
      const XY at = view.local((dem.columns - 1) / 2.0, (dem.rows - 1) / 2.0);
      middle = {at[0], at[1], 0};
    }
    const XY corner = view.local(0, 0);
    const Box box = rectangle_in(view, reach_of(frame, about, 0), middle,
                                 2 * std::hypot(corner[0] - middle.x(), corner[1] - middle.y()));
    print.low = {std::max(box.min.x(), reach.min.x()), std::max(box.min.y(), reach.min.y())};
    print.high = {std::min(box.max.x(), reach.max.x()), std::min(box.max.y(), reach.max.y())};
  }
  if (is_empty(print)) {
    throw ParameterError("file", params.file.text + ": covers no rectangle of the world's frame (" +
                                     frame.crs() +
                                     (about.empty() ? ")" : ") within 20 km of the mission"));
  }
  const double columns = std::floor((print.high[0] - print.low[0]) / print.spacing[0]) + 1;
  const double rows = std::floor((print.high[1] - print.low[1]) / print.spacing[1]) + 1;
  if (columns * rows > double(params.max_posts)) {
    throw ParameterError("max_posts", params.file.text + ": would need more than max_posts (" +
                                          std::to_string(params.max_posts) +
                                          ") in the world's frame");
  }
  Layout layout{frame, print.low, print.spacing, int(columns), int(rows), true, {}};
  layout.needed = needed_for(dem, view, layout);
  return layout;
}

/// The layout in a frame whose origin becomes its south-west corner.
template <class FrameAt>
Layout from_corner(const Dem& dem, const Params& params, const FrameAt& frame_at) {
  const Frame far = frame_at(std::nullopt);
  const Layout there = in_frame(dem, far, params, {});
  Layout layout =
      in_frame(dem, frame_at(far.to_lonlat(there.origin[0], there.origin[1])), params, {});
  return layout;
}

/// The scenario's `frame: {crs: …}`.
Layout in_asked_frame(const Dem& dem, const Params& params, const std::string& crs) {
  const gdal::Reference reference = gdal::reference(crs);
  if (!reference || !gdal::api().OSRIsProjected(reference.get())) {
    throw altiplan::Error(
        "frame.crs: expected auto, or EPSG: and the code of a projected coordinate system "
        "(EPSG:32616), found " +
        crs);
  }
  const double unit_m = gdal::api().OSRGetLinearUnits(reference.get(), nullptr);
  const auto map = std::make_shared<ToWgs84>(reference);
  return from_corner(dem, params, [&](const std::optional<altiplan::LonLat>& corner) {
    const XY origin = corner ? map->native((*corner)[0], (*corner)[1]) : XY{0, 0};
    return Frame::projected(std::make_shared<MapProjection>(map, origin, XY{unit_m, unit_m}), crs);
  });
}

/// The part of the model within the box, in its own frame; all of it where that is none.
Box area_of(const Dem& dem, const Layout& own, const Box& box) {
  const Box all{Vec3(0, 0, 0),
                Vec3((dem.columns - 1) * own.spacing[0], (dem.rows - 1) * own.spacing[1], 0)};
  Box area = all.intersected(box);
  area.min.z() = area.max.z() = 0;
  return area.is_empty() ? all : area;
}

/// Metres on the ground for a metre of the frame there, along each axis.
XY scale_at(const Frame& frame, double x, double y) {
  constexpr double kStep = 10;
  const auto along = [&](double dx, double dy) {
    return altiplan::geodesic_course(frame.to_lonlat(x - dx, y - dy),
                                     frame.to_lonlat(x + dx, y + dy))
               .metres /
           (2 * kStep);
  };
  return {along(kStep, 0), along(0, kStep)};
}

/// Of lengths, beyond which a model is resampled. That rounds summits, which is the worse the
/// steeper the ground is.
constexpr double kMaxError = 0.005;
/// The same where no mission says which part of a model of degrees is flown over: its posts are
/// kept, and a warning says what lengths are off by.
constexpr double kMaxErrorOfDegrees = 0.02;

/// The middle of the positions, and how far it is from the model's.
struct Judged {
  altiplan::LonLat middle;
  double metres;
};
Judged judged(const Dem& dem, const std::vector<altiplan::LonLat>& about) {
  const Frame near = Frame::local(about.front());
  const Box box = reach_of(near, about, 0);
  const Vec3 middle = (box.min + box.max) / 2;
  const altiplan::LonLat lonlat = near.to_lonlat(middle.x(), middle.y());
  return {lonlat,
          altiplan::geodesic_course(lonlat, ToWgs84(dem.crs).lonlat(middle_of(dem))).metres};
}

Layout in_local_frame(const Dem& dem, const Params& params, const altiplan::LonLat& middle) {
  return from_corner(dem, params, [&](const std::optional<altiplan::LonLat>& corner) {
    return Frame::local(middle, corner.value_or(middle));
  });
}

/// The model's own axes, true to scale in the middle of the area, if that leaves them wrong by
/// less.
std::optional<Layout> in_scaled_frame(const Dem& dem, const Layout& own, const Box& area,
                                      double max_error) {
  const Vec3 middle = (area.min + area.max) / 2;
  const XY lonlat = own.frame.to_lonlat(middle.x(), middle.y());
  const Layout scaled =
      in_own_frame(dem, OwnScale{lonlat[1], scale_at(own.frame, middle.x(), middle.y())});
  const Vec3 by(scaled.spacing[0] / own.spacing[0], scaled.spacing[1] / own.spacing[1], 1);
  const double error =
      scaled.frame.scale_error({area.min.cwiseProduct(by), area.max.cwiseProduct(by)});
  return error <= max_error ? std::optional(scaled) : std::nullopt;
}

/// The one rule of the frame that a model defines, about a mission.
Layout in_frame_about(const Dem& dem, const altiplan::Site& site, const Params& params) {
  constexpr double kMargin = 1000;    // metres that a mission may leave its positions
  constexpr double kFar = 1'000'000;  // a mission elsewhere, which is told so
  const Layout own = in_own_frame(dem);
  const auto [middle, metres] = judged(dem, site.about);
  const Box all = area_of(dem, own, {});
  const XY at = own.frame.to_local(middle[0], middle[1]);
  if (!(metres < kFar) && !all.contains(Vec3(at[0], at[1], 0))) {
    return own;
  }
  const Box reach = reach_of(own.frame, site.about, kMargin);
  if (!all.intersected(reach).is_empty()) {
    if (const auto scaled = in_scaled_frame(dem, own, reach, kMaxError)) {
      return *scaled;
    }
  }
  return in_frame(dem, Frame::local(middle), params, site.about);
}

/// The one rule of the frame that a model defines.
Layout in_best_frame(const Dem& dem, const altiplan::Site& site, const Params& params) {
  if (!site.about.empty()) {
    return in_frame_about(dem, site, params);
  }
  const Layout own = in_own_frame(dem);
  const Box area = area_of(dem, own, site.volume);
  if (own.frame.scale_error(area) <= kMaxError) {
    return own;
  }
  if (dem.geographic) {  // by so little that the volume's metres are still the same place
    if (const auto scaled = in_scaled_frame(dem, own, area, kMaxError)) {
      return *scaled;
    }
    if (own.frame.scale_error(area) <= kMaxErrorOfDegrees) {
      return own;
    }
  }
  const Box all = area_of(dem, own, {});
  if (const auto scaled = in_scaled_frame(dem, own, all, kMaxError)) {
    return *scaled;
  }
  const Vec3 middle = (all.min + all.max) / 2;
  return in_local_frame(dem, params, own.frame.to_lonlat(middle.x(), middle.y()));
}
}  // namespace

Layout layout_of(const Dem& dem, const altiplan::Site& site, const Params& params) {
  if (dem.local) {
    return {site.frame, dem.south_west, dem.step, dem.columns, dem.rows, false, {}};
  }
  if (site.frame.has_position()) {
    return in_frame(dem, site.frame, params, site.about);
  }
  if (site.frame_crs == "own") {
    return in_own_frame(dem);
  }
  if (site.frame_crs.empty() || site.frame_crs == "auto") {
    return in_best_frame(dem, site, params);
  }
  const gdal::Reference asked = gdal::reference(site.frame_crs);
  if (asked && !dem.geographic && gdal::api().OSRIsSame(asked.get(), dem.crs.get())) {
    return in_own_frame(dem);
  }
  return in_asked_frame(dem, params, site.frame_crs);
}

namespace {

/// Bilinear, between the posts of a part; positions that rounding puts beyond the last post belong
/// to it.
float height_at(const Posts& posts, const XY& post) {
  const Part& part = posts.part;
  const double u = std::clamp(post[0] - part.column, 0.0, double(part.columns - 1));
  const double v = std::clamp(post[1] - part.row, 0.0, double(part.rows - 1));
  const int i = std::min(int(u), part.columns - 2);
  const int j = std::min(int(v), part.rows - 2);
  const float* h = posts.heights.data() + std::size_t(j) * std::size_t(part.columns) + i;
  if (std::max({h[0], h[1], h[part.columns], h[part.columns + 1]}) >= kHighest) {
    return float(kHighest);  // closed, as is what lies between it and ground
  }
  const double s = u - i;
  const double w = v - j;
  return float((1 - w) * ((1 - s) * h[0] + s * h[1]) +
               w * ((1 - s) * h[part.columns] + s * h[part.columns + 1]));
}
}  // namespace

void bring_to_sea_level(const Dem& dem, Posts& posts) {
  constexpr int kNet = 16;  // between such posts a projection is even
  const ToWgs84 map(dem.crs);
  const Part& part = posts.part;
  const auto place = [&](int i, int j) {
    return map.lonlat({dem.south_west[0] + (part.column + i) * dem.step[0],
                       dem.south_west[1] + (part.row + j) * dem.step[1]});
  };
  for (int j = 0; j < part.rows; ++j) {
    float* heights = posts.heights.data() + std::size_t(j) * std::size_t(part.columns);
    XY first{};
    XY step{};
    for (int i = 0; i < part.columns; ++i) {
      if (i % kNet == 0) {
        first = place(i, j);
        const XY next = place(i + kNet, j);
        step = {(altiplan::longitude_near(next[0], first[0]) - first[0]) / kNet,
                (next[1] - first[1]) / kNet};
      }
      heights[i] -= float(
          altiplan::geoid_height(first[0] + (i % kNet) * step[0], first[1] + (i % kNet) * step[1]));
    }
  }
}

namespace {
/// Calls `use(i, j, position)` for each post, row by row. Positions are computed exactly every
/// `net` posts, at the last ones, and interpolated between: over so few posts a projection deviates
/// by less than 0.001 of their spacing, and it costs a microsecond per point.
template <class Exact, class Use>
void over_net(int columns, int rows, int net, const Exact& exact, const Use& use) {
  const auto between = [](const XY& a, const XY& b, double share) {
    return XY{a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
  };
  // Of the stretch from one knot to the next, which ends at the last post.
  const auto end = [net](int begin, int last) { return std::min(begin + net, last); };
  const auto share_of = [&](int at, int begin, int last) {
    return begin < last ? double(at - begin) / (end(begin, last) - begin) : 0;
  };
  const auto knot_row = [&](int j) {
    std::vector<XY> row;
    for (int i = 0; i < columns; i += net) {
      row.push_back(exact(i, j));
    }
    row.push_back(exact(columns - 1, j));
    return row;
  };
  std::vector<XY> south;
  std::vector<XY> north = knot_row(0);
  for (int j = 0; j < rows; ++j) {
    const int begin = j / net * net;
    if (j == begin) {
      south = std::move(north);
      north = knot_row(end(j, rows - 1));
    }
    const double up = share_of(j, begin, rows - 1);
    for (int i = 0; i < columns; ++i) {
      const auto k = std::size_t(i / net);
      const double share = share_of(i, int(k) * net, columns - 1);
      use(i, j,
          between(between(south[k], south[k + 1], share), between(north[k], north[k + 1], share),
                  up));
    }
  }
}

/// Raises the posts about each of the model's own below which their ground would lie: summits stay.
void raise_to(const View& view, const Layout& layout, const Posts& own, int net,
              std::vector<float>& heights) {
  const Part& part = own.part;
  const auto in_layout = [&](int i, int j) {
    const XY at = view.local(part.column + i, part.row + j);
    return XY{(at[0] - layout.origin[0]) / layout.spacing[0],
              (at[1] - layout.origin[1]) / layout.spacing[1]};
  };
  const float* post = own.heights.data();
  over_net(part.columns, part.rows, net, in_layout, [&](int, int, const XY& at) {
    const double height = *post++;
    if (!(at[0] >= 0 && at[1] >= 0 && at[0] < layout.columns - 1 && at[1] < layout.rows - 1)) {
      return;
    }
    const auto column = std::size_t(at[0]);
    const auto row = std::size_t(at[1]);
    const double east = at[0] - double(column);
    const double up = at[1] - double(row);
    float* const low = heights.data() + row * std::size_t(layout.columns) + column;
    float* const high = low + layout.columns;
    const double field = (1 - up) * ((1 - east) * low[0] + east * low[1]) +
                         up * ((1 - east) * high[0] + east * high[1]);
    const auto off = float(height - field);
    if (off > 0) {
      for (float* corner : {low, low + 1, high, high + 1}) {
        *corner = height >= kHighest ? float(kHighest) : *corner + off;
      }
    }
  });
}
}  // namespace

std::vector<float> resample(const Dem& dem, const Layout& layout, const Posts& own) {
  const View view(dem, layout.frame);
  // Near a pole, longitudes run every way.
  const double first_lat = dem.south_west[1];
  const double last_lat = first_lat + (dem.rows - 1) * dem.step[1];
  const int net = dem.geographic && std::max(-first_lat, last_lat) > 80 ? 1 : 16;
  const auto in_model = [&](int i, int j) {
    return view.post(layout.origin[0] + i * layout.spacing[0],
                     layout.origin[1] + j * layout.spacing[1]);
  };
  std::vector<float> heights;
  heights.reserve(std::size_t(layout.columns) * std::size_t(layout.rows));
  over_net(layout.columns, layout.rows, net, in_model,
           [&](int, int, const XY& post) { heights.push_back(height_at(own, post)); });
  raise_to(view, layout, own, net, heights);
  return heights;
}
}  // namespace terrain
