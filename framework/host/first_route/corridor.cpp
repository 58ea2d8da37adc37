// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/corridor.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "altiplan/world.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

/// Scale error above which lengths count as wrong, as build_mission has it.
constexpr double kMaxScaleError = 0.005;

/// Of the points' distance, metres, and turn radii.
struct Margin {
  double share;
  double metres;
  double radii;

  double of(double length_m, double turn_radius_m) const {
    return std::max({share * length_m, metres, radii * turn_radius_m});
  }
};
constexpr Margin kMargins[Corridor::kWidths] = {{0.15, 1000, 6}, {0.5, 4000, 15}, {2, 20000, 50}};

double rounded(double value, double unit) { return std::round(value / unit) * unit; }
}  // namespace

Corridor::Corridor(const RouteWish& wish, Registry& registry)
    : registry_(registry),
      tiles_(read_tiles(wish, registry)),
      wished_(wish.points),
      turn_radius_m_(wish.turn_radius_m.value_or(0)) {
  for (const WishedPoint& point : wished_) {
    expect_covered(tiles_, point);
  }
  const WishedPoint& from = wished_.front();
  std::stable_partition(tiles_.begin(), tiles_.end(),
                        [&](const Tile& tile) { return tile.holds(from.lon, from.lat); });
  drop_distant();
  choose_frame();
  for (const WishedPoint& point : wished_) {
    const auto [x, y] = frame_.to_local(point.lon, point.lat);
    points_.emplace_back(x, y, 0);
    length_m_ += points_.size() > 1 ? (points_.back() - points_[points_.size() - 2]).norm() : 0;
  }
  if (length_m_ < 1) {
    throw Error(wished_.back().option + ": expected a way of 1 m or more from " + from.option +
                ", found " + with_digits(length_m_, 2) + " m");
  }
}

void Corridor::drop_distant() {
  const Frame flat = Frame::local({wished_.front().lon, wished_.front().lat});
  Box reached = Box::empty();
  double length = 0;
  Vec3 before(0, 0, 0);
  for (const WishedPoint& point : wished_) {
    const auto [x, y] = flat.to_local(point.lon, point.lat);
    length += (Vec3(x, y, 0) - before).norm();
    before = {x, y, 0};
    reached = reached.with(before);
  }
  const Vec3 centre = (reached.min + reached.max) / 2;
  const auto [lon, lat] = flat.to_lonlat(centre.x(), centre.y());
  middle_ = {rounded(lon, 1e-3), std::clamp(rounded(lat, 1e-3), -90.0, 90.0)};
  reached = reached.grown(kMargins[kWidths - 1].of(length, turn_radius_m_));
  host::drop_distant(tiles_, flat, reached);
}

/// A geographic model is scaled for the latitude of the flight, and a projected one keeps its own
/// axes, unless lengths are wrong in them: then it is resampled, which rounds summits.
void Corridor::choose_frame() {
  const auto is_geographic = [](const Tile& tile) { return tile.is_geographic(); };
  const bool are_geographic = std::all_of(tiles_.begin(), tiles_.end(), is_geographic);
  const std::string origin =
      "origin_lonlat: [" + with_digits(middle_[0], 7) + ", " + with_digits(middle_[1], 7) + "]}";
  frame_ =
      are_geographic ? Frame::geographic(middle_[0], middle_[1], middle_[1]) : tiles_.front().frame;
  frame_line_ = are_geographic ? "frame: {" + origin : "";
  Box box = Box::empty();
  double length = 0;
  Vec3 before(0, 0, 0);
  for (const WishedPoint& point : wished_) {
    const auto [x, y] = frame_.to_local(point.lon, point.lat);
    length += box.is_empty() ? 0 : (Vec3(x, y, 0) - before).norm();
    before = {x, y, 0};
    box = box.with(before);
  }
  // A scenario whose model is in its own axes is built only if they are right in all of its volume.
  const int width = are_geographic ? 0 : kWidths - 1;
  box = box.grown(kMargins[width].of(length, turn_radius_m_));
  if (!are_geographic) {
    box = box.intersected(tiles_.front().bounds);
  }
  box.min.z() = box.max.z() = 0;
  if (!(frame_.scale_error(box) <= kMaxScaleError)) {
    frame_ = Frame::local(middle_);
    frame_line_ = "frame: {crs: local, " + origin;
    is_resampled_ = true;
  }
}

std::string Corridor::frame_in_words() const {
  return frame_.crs() + (is_resampled_ ? ", resampled from " + tiles_.front().frame.crs() : "");
}

/// What the model covers there.
Box Corridor::in_frame(const Tile& tile) const {
  if (frame_.crs() != tile.frame.crs() || is_resampled_) {
    const auto [known, is_new] = covered_.try_emplace(tile.file);
    if (is_new) {
      const World empty;
      Site site;
      site.frame = frame_;
      site.before = &empty;
      known->second = build_model(tile, site, registry_)->bounds();
    }
    return known->second;
  }
  const Box degrees = tile.frame.degrees(tile.bounds);
  const bool spans_half = degrees.max.x() - degrees.min.x() > 180;
  const auto at = [&](const Vec3& own) {
    const auto [lon, lat] = tile.frame.to_lonlat(own.x(), own.y());
    const auto [x, y] = frame_.to_local(lon, lat);
    return Vec3(x, y, 0);
  };
  const Vec3 low = at(tile.bounds.min);
  const Vec3 high = at(tile.bounds.max);
  return {{spans_half ? -kInfinity : low.x(), low.y(), -kInfinity},
          {spans_half ? kInfinity : high.x(), high.y(), kInfinity}};
}

std::vector<Tile> Corridor::tiles(const Box& box) const {
  std::vector<Tile> within;
  std::copy_if(tiles_.begin(), tiles_.end(), std::back_inserter(within), [&](const Tile& tile) {
    const Box own = in_frame(tile);
    return own.min.x() < box.max.x() && own.max.x() > box.min.x() && own.min.y() < box.max.y() &&
           own.max.y() > box.min.y();
  });
  return within;
}

Box Corridor::all_tiles() const {
  Box all = Box::empty();
  for (const Tile& tile : tiles_) {
    const Box own = in_frame(tile);
    all.min = all.min.cwiseMin(own.min);
    all.max = all.max.cwiseMax(own.max);
  }
  return all;
}

bool Corridor::is_all(const Box& box) const {
  const Box all = all_tiles();
  constexpr double kRounding = 0.2;
  return (box.min - all.min).head<2>().maxCoeff() < kRounding &&
         (all.max - box.max).head<2>().maxCoeff() < kRounding;
}

Box Corridor::box(int width) const {
  Box box = Box::empty();
  for (const Vec3& p : points_) {
    box = box.with(p);
  }
  box = box.grown(kMargins[width].of(length_m_, turn_radius_m_));
  const Box all = all_tiles();
  for (int axis = 0; axis < 2; ++axis) {
    // Rounded, so that the scenario has the same numbers.
    box.min[axis] = std::ceil(std::max(box.min[axis], all.min[axis]) * 10) / 10;
    box.max[axis] = std::floor(std::min(box.max[axis], all.max[axis]) * 10) / 10;
  }
  for (const Vec3& p : points_) {  // on the very edge
    box.min.head<2>() = box.min.head<2>().cwiseMin(p.head<2>());
    box.max.head<2>() = box.max.head<2>().cwiseMax(p.head<2>());
  }
  box.min.z() = -1000;
  box.max.z() = 10000;
  const auto [low, high] = ground(box);
  box.min.z() = std::floor(low);
  box.max.z() = std::ceil(high);
  return box;
}

Corridor::Voids Corridor::voids_below(const Polyline& route) const {
  Voids voids;
  const World empty;
  Site site;
  site.frame = frame_;
  site.before = &empty;
  site.volume = Box::empty();
  for (const Vec3& p : route) {
    site.volume = site.volume.with(p);
  }
  site.volume = site.volume.grown(spacing_m());
  for (const Tile& tile : tiles(site.volume)) {
    if (!tile.has_voids()) {
      continue;
    }
    // Ground that depends on how voids are filled lies over or beside one.
    const auto filled = build_model(tile, site, registry_);
    const auto sunk = build_model(tile, site, registry_, "fill_m, fill_m: -1000");
    const auto is_guess = [&](const Vec3& p) {
      return filled->ground()->height(p.x(), p.y()) != sunk->ground()->height(p.x(), p.y());
    };
    for (std::size_t n = 0; n + 1 < route.size(); ++n) {
      const Vec3 leg = route[n + 1] - route[n];
      const int parts = std::max(1, int(std::ceil(2 * leg.head<2>().norm() / tile.spacing_m)));
      for (int i = 0; i < parts; ++i) {
        voids.length_m += is_guess(route[n] + (i + 0.5) / parts * leg) ? leg.norm() / parts : 0;
      }
    }
    voids.at_start = voids.at_start || is_guess(route.front());
    voids.at_goal = voids.at_goal || is_guess(route.back());
  }
  return voids;
}

std::array<double, 2> Corridor::ground(const Box& box) const {
  std::array<double, 2> range{kInfinity, -kInfinity};
  const World empty;
  Site site;
  site.volume = box;
  site.frame = frame_;
  site.before = &empty;
  for (const Tile& tile : tiles(box)) {
    const auto layer = build_model(tile, site, registry_);
    const HeightField& field = *layer->ground()->height_field();
    const auto index = [&](double at, int axis, int posts) {
      return int(std::clamp((at - field.origin()[axis]) / field.spacing()[axis], 0.0, posts - 1.0));
    };
    const int last_i = index(box.max.x() + field.spacing()[0], 0, field.columns());
    const int last_j = index(box.max.y() + field.spacing()[1], 1, field.rows());
    for (int j = index(box.min.y(), 1, field.rows()); j <= last_j; ++j) {
      for (int i = index(box.min.x(), 0, field.columns()); i <= last_i; ++i) {
        range[0] = std::min(range[0], double(field.post(i, j)));
        range[1] = std::max(range[1], double(field.post(i, j)));
      }
    }
  }
  return range;
}
}  // namespace altiplan::host
