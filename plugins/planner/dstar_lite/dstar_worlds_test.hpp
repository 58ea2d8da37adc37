// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

inline std::int64_t expanded(const PlanResult& result) {
  for (const Counter& c : result.counters) {
    if (c.name == "expanded") {
      return c.value;
    }
  }
  return -1;
}

/// A world of cells that change, and a session that is notified.
class Flown {
 public:
  Flown(const std::string& with, const VoxelGrid& cells, const Cell& start, const Cell& goal,
        bool level = false)
      : planner_(make_planner("dstar_lite", with)), cells_(cells) {
    request_ =
        request_in(world_of(std::make_shared<kit::CellLayer>(cells), "cells"),
                   cells.spec().centre(start), cells.spec().centre(goal), cells.spec().box());
    if (level) {
      request_.level_m = request_.start.position.z();
    }
  }
  void begin() { session_ = planner_->begin(request_); }

  Request& request() { return request_; }
  const VoxelGrid& cells() const { return cells_; }
  const PlanResult& result() const { return session_->result(); }
  const Planner& planner() const { return *planner_; }

  void flip(const Cell& c) {
    cells_.set(c, !cells_.blocked(c));
    changed_ = changed_.united(cells_.spec().cell_box(c));
  }
  PlanResult update() {
    std::vector<Change> changes;
    if (!changed_.is_empty()) {
      changes.push_back({Change::Kind::set_cells, "cells", changed_});
      request_.world = std::make_shared<const World>(request_.world->with_replaced(
          {"cells", "cells", std::make_shared<kit::CellLayer>(cells_), true}));
      changed_ = Box::empty();
    }
    return session_->update(request_.start, request_.goal, request_.world, changes,
                            request_.budget);
  }
  /// Flies along a fraction of the route's legs, to a point between two waypoints.
  void move_on(double share) {
    const Route& route = result().route;
    if (route.size() >= 2) {
      const double at = share * double(route.size() - 1);
      const auto leg = std::min(std::size_t(at), route.size() - 2);
      request_.start.position = route[leg] + (at - double(leg)) * (route[leg + 1] - route[leg]);
      if (request_.level_m) {
        request_.start.position.z() = *request_.level_m;
      }
    }
  }

 private:
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Session> session_;
  VoxelGrid cells_;
  Request request_;
  Box changed_ = Box::empty();
};

inline GridSpec spec_of(const Cell& counts, const Vec3& cell) {
  GridSpec spec;
  spec.counts = counts;
  spec.cell = cell;
  spec.rule = GridSpec::Rule::native;
  return spec;
}

inline Cell random_cell(const GridSpec& spec, SplitMix64& random) {
  Cell c{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    c[axis] = random.integer(0, spec.counts[axis] - 1);
  }
  return c;
}

inline VoxelGrid random_cells(const GridSpec& spec, double density, SplitMix64& random) {
  VoxelGrid cells(spec);
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      for (int i = 0; i < spec.counts[0]; ++i) {
        cells.set({i, j, k}, random.uniform() < density);
      }
    }
  }
  return cells;
}

/// A city of paper 003, 80 x 80 x 100 cells of 10 m, and a request across it.
inline Request city_request(const char* kind, int seed) {
  const GridSpec spec = spec_of({80, 80, 100}, Vec3::Constant(10));
  const bool simple = std::string(kind) == "simple";
  static const World kEmpty;
  Site site;
  site.before = &kEmpty;
  site.start = spec.centre(simple ? Cell{1, 1, 1} : Cell{1, 2, 4});
  site.goal = spec.centre(simple ? Cell{67, 64, 99} : Cell{67, 64, 4});
  const std::string with =
      std::string("{generate: ") + kind + ", seed: " + std::to_string(seed) + "}";
  return request_in(world_of(make_environment("city", with, site), "city"), *site.start, *site.goal,
                    spec.box());
}
}  // namespace altiplan::testing
