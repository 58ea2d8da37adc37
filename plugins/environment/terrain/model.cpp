// SPDX-License-Identifier: Apache-2.0
#include "model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "join.hpp"
#include "mosaic.hpp"

namespace terrain {
namespace {

using altiplan::Box;
using altiplan::HeightField;
using altiplan::kInfinity;
using altiplan::Vec3;

bool is_bounded(const Box& volume) {
  return std::isfinite(volume.min.x() + volume.min.y() + volume.max.x() + volume.max.y());
}

/// Expected extent of queries around the volume: hardly ever farther than a position in it is above
/// the ground.
double margin(const Box& volume, double radius, const Layout& layout) {
  constexpr int kMinPosts = 128;
  const Vec3 size = volume.max - volume.min;
  const double above = std::clamp(volume.max.z() - kLowest, 0.0, kHighest - kLowest);
  return radius + std::min(above, std::max({size.x(), size.y(), kMinPosts * layout.spacing[0],
                                            kMinPosts * layout.spacing[1]}));
}

/// First post and number of posts of the blocks that intersect the range.
std::array<int, 2> blocks_about(double low, double high, double origin, double spacing, int posts) {
  constexpr int kBlock = HeightField::kBlock;
  const int last_block = (posts - 2) / kBlock;
  const auto block = [&](double at) {
    return std::clamp(std::floor((at - origin) / (spacing * kBlock)), 0.0, double(last_block));
  };
  const int first = int(block(low)) * kBlock;
  const int last = std::min((int(block(high)) + 1) * kBlock, posts - 1);
  return {first, last - first + 1};
}

/// The posts around the volume; all if that saves little. Of a model that is too large to be read
/// whole those around a judged mission.
Part part_about(const Params& params, const Dem& dem, const Layout& layout,
                const altiplan::Site& site) {
  constexpr std::int64_t kFew = 4'000'000;  // read almost instantly
  const std::int64_t all = std::int64_t(dem.columns) * dem.rows;
  const bool is_too_large = all > params.max_posts && !site.about.empty();
  const Box volume = is_too_large
                         ? reach_of(layout.frame, site.about, kReach)
                         : site.volume.grown(margin(site.volume, site.vehicle.radius_m, layout));
  if (layout.resampled) {
    return layout.needed;
  }
  if (all <= kFew || !is_bounded(volume) ||
      (site.before != nullptr &&
       may_join(layout.origin, layout.spacing, layout.columns, layout.rows, *site.before))) {
    return dem.whole();
  }
  const auto [column, columns] = blocks_about(volume.min.x(), volume.max.x(), layout.origin[0],
                                              layout.spacing[0], layout.columns);
  const auto [row, rows] = blocks_about(volume.min.y(), volume.max.y(), layout.origin[1],
                                        layout.spacing[1], layout.rows);
  return std::int64_t(columns) * rows <= all / 2 || is_too_large ? Part{column, row, columns, rows}
                                                                 : dem.whole();
}

using XY = std::array<double, 2>;

/// Horizontally between the first and the last post of a grid, shrunk by that many posts.
Box between(const XY& origin, const XY& spacing, int columns, int rows, int within) {
  const auto at = [&](std::size_t axis, int n) { return origin[axis] + n * spacing[axis]; };
  return {{at(0, within), at(1, within), -kInfinity},
          {at(0, columns - 1 - within), at(1, rows - 1 - within), kInfinity}};
}

/// Region where the field gives the same results as the whole: a post's spacing within it, and
/// beyond the sides that it shares with the whole.
Box covered_by(const HeightField& field, const Layout& layout) {
  Box box = between(field.origin(), field.spacing(), field.columns(), field.rows(), 1);
  const Part& part = field.part();
  for (const auto& [axis, first, posts, all] :
       {std::tuple(0, part.column, part.columns, layout.columns),
        std::tuple(1, part.row, part.rows, layout.rows)}) {
    box.min[axis] = first == 0 ? -kInfinity : box.min[axis];
    box.max[axis] = first + posts >= all ? kInfinity : box.max[axis];
  }
  return box;
}
}  // namespace

Model::Model(const Params& params, const altiplan::Site& site)
    : params_(params),
      dem_((params.tiles.empty() ? read_dem : read_mosaic)(
          params, is_bounded(site.volume) || !site.about.empty())),
      layout_(layout_of(dem_, site, params)),
      field_(read(part_about(params_, dem_, layout_, site))),
      covered_(covered_by(field_, layout_)) {
  if (std::isinf(to_edge({0, 0, 0}))) {  // it is the whole
    dem_.numbers = {};
    dem_.tiles.clear();
    dem_.dataset.reset();
    dem_.band = nullptr;
    joined_ = site.before != nullptr && join(field_, *site.before);
    bounds_ = between(field_.origin(), field_.spacing(), field_.columns(), field_.rows(), 0);
  } else {
    bounds_ = between(layout_.origin, layout_.spacing, layout_.columns, layout_.rows, 0);
  }
}

HeightField Model::read(const Part& part) {
  Posts posts = read_posts(params_, dem_, part);
  voids_ = posts.voids;
  if (!layout_.resampled) {
    return {layout_.origin, layout_.spacing, posts.part, std::move(posts.heights)};
  }
  return {layout_.origin, layout_.spacing, layout_.columns, layout_.rows,
          resample(dem_, layout_, posts)};
}

HeightField Model::read_whole() const {
  if (std::int64_t(dem_.columns) * dem_.rows > params_.max_posts) {
    refuse(params_,
           "a query goes beyond the part around the volume that was read, and the whole model has "
           "more than max_posts (" +
               std::to_string(params_.max_posts) + ")",
           "max_posts");
  }
  Posts posts = read_posts(params_, dem_, dem_.whole());
  return {layout_.origin, layout_.spacing, posts.part, std::move(posts.heights)};
}

const HeightField& Model::whole() const {
  std::call_once(once_, [this] {
    try {
      whole_ = std::make_unique<const HeightField>(read_whole());
    } catch (const altiplan::ParameterError& error) {
      // The caller is not at fault for a parameter.
      throw altiplan::Error(error.what());
    }
  });
  return *whole_;
}

double Model::to_edge(const Vec3& p) const {
  const Vec3 off = (covered_.min - p).cwiseMax(p - covered_.max);
  const double within = -off.head<2>().maxCoeff();
  return within >= 0 ? within : off.head<2>().cwiseMax(0.0).norm();
}
}  // namespace terrain
