// SPDX-License-Identifier: Apache-2.0
#include "place.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/utm.hpp"

namespace terrain {
namespace {

using altiplan::Frame;
using altiplan::ParameterError;
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

/// The axes of a projected system, with a separate origin and in metres.
class MapProjection final : public altiplan::Projection {
 public:
  MapProjection(std::shared_ptr<const ToWgs84> map, const XY& origin, double unit_m)
      : map_(std::move(map)), origin_(origin), unit_m_(unit_m) {}
  XY to_local(double lon, double lat) const override {
    const XY p = map_->native(lon, lat);
    return {(p[0] - origin_[0]) * unit_m_, (p[1] - origin_[1]) * unit_m_};
  }
  XY to_lonlat(double x, double y) const override {
    return map_->lonlat({origin_[0] + x / unit_m_, origin_[1] + y / unit_m_});
  }

 private:
  std::shared_ptr<const ToWgs84> map_;
  XY origin_;
  double unit_m_;
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

Layout in_own_frame(const Dem& dem) {
  Frame frame;
  XY spacing;
  if (dem.geographic) {
    const XY shift = datum_shift(dem);
    const double lon = dem.south_west[0] + shift[0];
    const double lat = dem.south_west[1] + shift[1];
    const double height_deg = (dem.rows - 1) * dem.step[1];
    frame = Frame::geographic(lon, lat, lat + height_deg / 2);
    // By the spacing of one post: a model may span more than half of the Earth.
    spacing = frame.to_local(lon + dem.step[0], lat + dem.step[1]);
  } else {
    frame = Frame::projected(std::make_shared<MapProjection>(std::make_shared<ToWgs84>(dem.crs),
                                                             dem.south_west, dem.unit_m),
                             dem.crs_name);
    spacing = {dem.step[0] * dem.unit_m, dem.step[1] * dem.unit_m};
  }
  return {frame, {0, 0}, spacing, dem.columns, dem.rows, false};
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
    const XY p = map_.native(lonlat[0], lonlat[1]);
    return {(p[0] - dem_.south_west[0]) / dem_.step[0], (p[1] - dem_.south_west[1]) / dem_.step[1]};
  }
  /// Bilinear; positions that rounding puts beyond the last post belong to it. `heights` are those
  /// of the whole model.
  float height(const std::vector<float>& heights, const XY& post) const {
    const double u = std::clamp(post[0], 0.0, double(dem_.columns - 1));
    const double v = std::clamp(post[1], 0.0, double(dem_.rows - 1));
    const int i = std::min(int(u), dem_.columns - 2);
    const int j = std::min(int(v), dem_.rows - 2);
    const float* h = heights.data() + std::size_t(j) * std::size_t(dem_.columns) + i;
    const double s = u - i;
    const double w = v - j;
    return float((1 - w) * ((1 - s) * h[0] + s * h[1]) +
                 w * ((1 - s) * h[dem_.columns] + s * h[dem_.columns + 1]));
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
  print.spacing = {std::abs(view.local(last_i / 2 + 1, last_j / 2)[0] - middle[0]),
                   std::abs(view.local(last_i / 2, last_j / 2 + 1)[1] - middle[1])};
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

Layout in_frame(const Dem& dem, const Frame& frame, const Params& params) {
  const Footprint print = footprint(dem, View(dem, frame));
  const double width = print.high[0] - print.low[0];
  const double height = print.high[1] - print.low[1];
  if (!(width > 2 * print.spacing[0] && height > 2 * print.spacing[1])) {
    throw ParameterError("file", params.file.text +
                                     ": its rows are rotated too far from the axes of the "
                                     "world's frame (" +
                                     frame.crs() + ") to be resampled in it");
  }
  if (print.is_grid) {
    const XY spacing{width / (dem.columns - 1), height / (dem.rows - 1)};
    return {frame, print.low, spacing, dem.columns, dem.rows, false};
  }
  const double columns = std::floor(width / print.spacing[0]) + 1;
  const double rows = std::floor(height / print.spacing[1]) + 1;
  if (columns * rows > double(params.max_posts)) {
    throw ParameterError("max_posts", params.file.text + ": would need more than max_posts (" +
                                          std::to_string(params.max_posts) +
                                          ") in the world's frame");
  }
  return {frame, print.low, print.spacing, int(columns), int(rows), true};
}

/// The scenario's `frame: {crs: …}`, with its origin at the model's future south-west corner.
Frame asked_frame(const Dem& dem, const std::string& crs) {
  const gdal::Reference reference = gdal::reference(crs);
  if (!reference || !gdal::api().OSRIsProjected(reference.get())) {
    throw altiplan::Error(
        "frame.crs: expected auto, or EPSG: and the code of a projected coordinate system "
        "(EPSG:32616), found " +
        crs);
  }
  const double unit_m = gdal::api().OSRGetLinearUnits(reference.get(), nullptr);
  const auto map = std::make_shared<ToWgs84>(reference);
  const Frame at_zero =
      Frame::projected(std::make_shared<MapProjection>(map, XY{0, 0}, unit_m), crs);
  const Footprint print = footprint(dem, View(dem, at_zero));
  const XY origin{print.low[0] / unit_m, print.low[1] / unit_m};
  return Frame::projected(std::make_shared<MapProjection>(map, origin, unit_m), crs);
}
/// `crs: auto`: the zone of UTM that the model's middle lies in.
std::string utm_of(const Dem& dem) {
  const auto [lon, lat] = ToWgs84(dem.crs).lonlat(middle_of(dem));
  return altiplan::kit::utm_crs(lon, lat);
}

/// True for a projected model whose lengths are right in its own axes: warping would round summits.
bool is_true_to_scale(const Dem& dem) {
  constexpr double kMaxError = 0.005;
  if (dem.geographic) {
    return false;
  }
  const Layout own = in_own_frame(dem);
  const altiplan::Vec3 size((dem.columns - 1) * own.spacing[0], (dem.rows - 1) * own.spacing[1], 0);
  return own.frame.scale_error({altiplan::Vec3(0, 0, 0), size}) <= kMaxError;
}
}  // namespace

Layout layout_of(const Dem& dem, const altiplan::Site& site, const Params& params) {
  if (site.frame.has_position()) {
    return in_frame(dem, site.frame, params);
  }
  const bool is_auto = site.frame_crs == "auto";
  if (is_auto && is_true_to_scale(dem)) {
    return in_own_frame(dem);
  }
  const std::string crs = is_auto ? utm_of(dem) : site.frame_crs;
  const gdal::Reference asked = gdal::reference(crs);
  if (crs.empty() ||
      (asked && !dem.geographic && gdal::api().OSRIsSame(asked.get(), dem.crs.get()))) {
    return in_own_frame(dem);
  }
  return in_frame(dem, asked_frame(dem, crs), params);
}

/// Exact positions are computed every kNet posts and interpolated between: over so few posts a
/// projection deviates by less than 0.001 of their spacing, and it costs a microsecond per point.
std::vector<float> resample(const Dem& dem, const Layout& layout, const std::vector<float>& own) {
  const View view(dem, layout.frame);
  constexpr int kNet = 16;
  const int columns = layout.columns;
  const int rows = layout.rows;
  const int knots = (columns - 1) / kNet + 2;
  const auto knot_row = [&](int j) {
    std::vector<XY> row;
    for (int k = 0; k < knots; ++k) {
      row.push_back(view.post(layout.origin[0] + k * kNet * layout.spacing[0],
                              layout.origin[1] + j * layout.spacing[1]));
    }
    return row;
  };
  const auto between = [](const XY& a, const XY& b, double share) {
    return XY{a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
  };
  std::vector<float> heights;
  heights.reserve(std::size_t(columns) * std::size_t(rows));
  std::vector<XY> south;
  std::vector<XY> north = knot_row(0);
  for (int j = 0; j < rows; ++j) {
    if (j % kNet == 0) {
      south = std::move(north);
      north = knot_row(j + kNet);
    }
    for (int i = 0; i < columns; ++i) {
      const std::size_t k = std::size_t(i / kNet);
      const double share = double(i % kNet) / kNet;
      heights.push_back(view.height(
          own, between(between(south[k], south[k + 1], share),
                       between(north[k], north[k + 1], share), double(j % kNet) / kNet)));
    }
  }
  return heights;
}
}  // namespace terrain
