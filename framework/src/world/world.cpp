// SPDX-License-Identifier: Apache-2.0
#include "altiplan/world.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "altiplan/request.hpp"
#include "cells_touching.hpp"
#include "layer_answer.hpp"
#include "layer_index.hpp"

namespace altiplan {
/// Grids of this snapshot, and those of an earlier one with the layers that they contain.
struct World::Cache {
  struct Earlier {
    std::shared_ptr<const VoxelGrid> grid;
    std::vector<Layer> layers;
  };
  /// One grid per spec. They are built without the lock, since layers may take long, throw, or ask
  /// the world; of two built at once the first is kept.
  template <class Grid>
  class Grids {
   public:
    template <class Build>
    std::shared_ptr<const Grid> get(const GridSpec& spec, const Build& build) {
      auto grid = keep(spec, nullptr);
      return grid ? grid : keep(spec, build());
    }
    std::vector<std::shared_ptr<const Grid>> all() {
      const std::lock_guard lock(mutex_);
      return grids_;
    }

   private:
    /// The grid of the spec; else `built`, which is kept unless it is null.
    std::shared_ptr<const Grid> keep(const GridSpec& spec, std::shared_ptr<const Grid> built) {
      const std::lock_guard lock(mutex_);
      for (const auto& grid : grids_) {
        if (grid->spec() == spec) {
          return grid;
        }
      }
      if (built) {
        grids_.push_back(built);
      }
      return built;
    }

    std::mutex mutex_;
    std::vector<std::shared_ptr<const Grid>> grids_;
  };
  Grids<VoxelGrid> grids;
  Grids<DistanceField> distances;
  std::vector<Earlier> earlier;
  /// Null for few layers, which are asked one after the other.
  const LayerIndex* index(const std::vector<Layer>& layers) {
    constexpr std::size_t kFew = 16;
    if (layers.size() <= kFew) {
      return nullptr;
    }
    std::call_once(is_indexed_, [&] { index_.emplace(layers); });
    return &*index_;
  }

 private:
  std::once_flag is_indexed_;
  std::optional<LayerIndex> index_;
};

World::World() : cache_(std::make_shared<Cache>()) {}

const Layer* World::find(std::string_view id) const {
  const auto found = std::find_if(layers_.begin(), layers_.end(),
                                  [&](const Layer& layer) { return layer.id == id; });
  return found == layers_.end() ? nullptr : &*found;
}

World World::next(World world) {
  ++world.revision_;
  const std::shared_ptr<Cache> before = std::move(world.cache_);
  world.cache_ = std::make_shared<Cache>();
  world.cache_->earlier = before->earlier;
  for (const auto& grid : before->grids.all()) {
    std::erase_if(world.cache_->earlier, [&](const Cache::Earlier& earlier) {
      return earlier.grid->spec() == grid->spec();
    });
    world.cache_->earlier.push_back({grid, world.layers_});
  }
  return world;
}

void World::find_grounds() {
  grounds_.clear();
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    note_ground(n);
  }
}

void World::note_ground(std::size_t layer) {
  if (const Ground* ground =
          answer_of(layers_[layer], [](const Environment& asked) { return asked.ground(); })) {
    grounds_.emplace_back(layer, ground);
  }
}

World World::with_frame(Frame frame) const {
  World world(*this);
  world.frame_ = std::move(frame);
  return world;
}

World World::with(Layer layer) const& { return World(*this).with(std::move(layer)); }

World World::with(Layer layer) && {
  if (find(layer.id) != nullptr) {
    throw Error("the world has a layer '" + layer.id + "' already");
  }
  World world = next(std::move(*this));
  world.layers_.push_back(std::move(layer));
  world.note_ground(world.layers_.size() - 1);
  return world;
}

World World::with_replaced(Layer layer) const {
  World world = next(*this);
  for (Layer& old : world.layers_) {
    if (old.id == layer.id) {
      old = std::move(layer);
      world.find_grounds();
      return world;
    }
  }
  throw Error("the world has no layer '" + layer.id + "'");
}

World World::without(std::string_view id) const {
  World world = next(*this);
  std::erase_if(world.layers_, [&](const Layer& layer) { return layer.id == id; });
  world.find_grounds();
  return world;
}

World World::with_moving(std::vector<MovingObstacle> moving) const {
  World world(*this);  // moving obstacles are never rasterized: the grids stay valid
  world.revision_ = revision_ + 1;
  world.moving_ = std::move(moving);
  return world;
}

namespace {
Box bounds_of(const Layer& layer) {
  return answer_of(layer, [](const Environment& asked) { return asked.bounds(); });
}
}  // namespace

Box World::bounds() const {
  Box all = Box::empty();
  for (const Layer& layer : layers_) {
    const Box box = bounds_of(layer);
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isfinite(box.min[axis]) && std::isfinite(box.max[axis])) {
        all.min[axis] = std::min(all.min[axis], box.min[axis]);
        all.max[axis] = std::max(all.max[axis], box.max[axis]);
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (all.min[axis] > all.max[axis]) {
      all.min[axis] = -kInfinity;
      all.max[axis] = kInfinity;
    }
  }
  return all;
}

double World::clearance(const Vec3& p) const {
  const auto clearance_of = [&](const Layer& layer) {
    return answer_of(layer, [&](const Environment& asked) { return asked.clearance(p); });
  };
  const LayerIndex* index = is_finite(p) ? cache_->index(layers_) : nullptr;
  if (index != nullptr) {
    return index->min_clearance(
        p, [&](int layer) { return clearance_of(layers_[std::size_t(layer)]); });
  }
  double min_clearance = kInfinity;
  for (const Layer& layer : layers_) {
    min_clearance = std::min(min_clearance, clearance_of(layer));
  }
  return min_clearance;
}

const Layer* World::blocked_by(const Vec3& a, const Vec3& b, double r) const {
  const LayerIndex* index = is_finite(a) && is_finite(b) ? cache_->index(layers_) : nullptr;
  if (index != nullptr) {
    for (const int near : index->within(a, b, r)) {
      const Layer& layer = layers_[std::size_t(near)];
      if (answer_of(layer, [&](const Environment& asked) { return asked.blocked(a, b, r); })) {
        return &layer;
      }
    }
    return nullptr;
  }
  for (const Layer& layer : layers_) {
    if (answer_of(layer, [&](const Environment& asked) { return asked.blocked(a, b, r); })) {
      return &layer;
    }
  }
  return nullptr;
}

void World::near(const Vec3& p, double reach, double ground_reach,
                 const std::function<void(const Layer&, const Nearby&)>& sink) const {
  const auto ask = [&](const Layer& layer) {
    answer_of(layer, [&](const Environment& asked) {
      const double within = asked.ground() != nullptr ? ground_reach : reach;
      asked.near(p, within, [&](const Nearby& nearby) { sink(layer, nearby); });
    });
  };
  const LayerIndex* index = is_finite(p) ? cache_->index(layers_) : nullptr;
  if (index != nullptr) {
    for (const int layer : index->within(p, p, reach)) {
      ask(layers_[std::size_t(layer)]);
    }
    return;
  }
  std::for_each(layers_.begin(), layers_.end(), ask);
}

std::vector<Threat> World::threats() const {
  std::vector<Threat> all;
  for (const Layer& layer : layers_) {
    const std::vector<Threat>& its = layer.environment->info().threats;
    all.insert(all.end(), its.begin(), its.end());
  }
  return all;
}

double World::over_approximation() const {
  double greatest = 0;
  for (const Layer& layer : layers_) {
    greatest = std::max(greatest, layer.environment->over_approximation());
  }
  return greatest;
}

std::optional<GridSpec> World::native_grid() const {
  for (const Layer& layer : layers_) {
    if (const auto& spec = layer.environment->info().native_grid) {
      return spec;
    }
  }
  return std::nullopt;
}

namespace {

bool shows(const std::vector<Layer>& layers, const Layer& layer) {
  return std::any_of(layers.begin(), layers.end(),
                     [&](const Layer& other) { return other.environment == layer.environment; });
}

/// The earlier grid brought up to date: added layers are merged into it; the box of a removed layer
/// is rasterized again from all layers.
std::shared_ptr<VoxelGrid> patched(const VoxelGrid& earlier, const std::vector<Layer>& then,
                                   const std::vector<Layer>& now,
                                   const std::function<void()>& watch) {
  auto grid = std::make_shared<VoxelGrid>(earlier);
  grid->watch(watch);
  const GridSpec& spec = grid->spec();
  Box gone = Box::empty();
  for (const Layer& layer : then) {
    if (!shows(now, layer)) {
      gone = gone.united(bounds_of(layer).grown(spec.inflation));
    }
  }
  if (!gone.is_empty()) {
    VoxelGrid fresh(spec);
    fresh.watch(watch);
    for (const Layer& layer : now) {
      if (bounds_of(layer).grown(spec.inflation + spec.cell.norm()).overlaps(gone)) {
        answer_of(layer, [&](const Environment& asked) { asked.rasterize(fresh); });
      }
    }
    const auto [low, high] = cells_touching(spec, gone);
    grid->copy(fresh, low, high);
  }
  for (const Layer& layer : now) {
    if (!shows(then, layer)) {
      answer_of(layer, [&](const Environment& asked) { asked.rasterize(*grid); });
    }
  }
  return grid;
}
}  // namespace

std::shared_ptr<const VoxelGrid> World::voxels(const GridSpec& spec) const {
  return voxels(spec, Budget());
}

std::shared_ptr<const VoxelGrid> World::voxels(const GridSpec& spec, const Budget& budget) const {
  return cache_->grids.get(spec, [&] {
    BudgetWatch time(budget);
    const std::function<void()> watch = [&time] {
      if (time.spent(0)) {
        throw BudgetSpent("the occupancy grid was still being built", time.cancelled());
      }
    };
    std::shared_ptr<VoxelGrid> grid;
    for (const Cache::Earlier& earlier : cache_->earlier) {
      if (earlier.grid->spec() == spec) {
        grid = patched(*earlier.grid, earlier.layers, layers_, watch);
      }
    }
    if (grid == nullptr) {
      grid = std::make_shared<VoxelGrid>(spec);
      grid->watch(watch);
      for (const Layer& layer : layers_) {
        answer_of(layer, [&](const Environment& asked) { asked.rasterize(*grid); });
      }
    }
    grid->watch(nullptr);
    return grid;
  });
}

std::shared_ptr<const DistanceField> World::distances(const GridSpec& spec) const {
  return cache_->distances.get(
      spec, [&] { return std::make_shared<const DistanceField>(*voxels(spec)); });
}
}  // namespace altiplan
