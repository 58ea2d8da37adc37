// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "altiplan/request.hpp"
#include "framework/shape_oracle.hpp"
#include "reference/graph.hpp"

// What the README of planner astar promises, written down a second time: which points are joined by
// which legs, and which legs keep the rules. No code of the kit, the judge or the world is used.
namespace altiplan::reference {

/// Level or slanting ground, solid below: z = height + slope x · x + slope y · y.
struct Plane {
  double height = 0;
  std::array<double, 2> slope{0, 0};

  double above(const Vec3& p) const { return p.z() - height - slope[0] * p.x() - slope[1] * p.y(); }
  double steepness() const { return std::hypot(1, slope[0], slope[1]); }
};

/// The obstacles as the oracle knows them.
struct Scene {
  std::vector<oracle::Solid> solids;
  std::optional<Plane> ground;
};

/// Legs whose verdict hangs on rounding make a world unfit for a comparison.
constexpr double kDoubt = 1e-5;

/// The rules for a leg, except those on turns.
class LegRules {
 public:
  LegRules(const Request& request, const Scene& scene) : request_(request), scene_(scene) {
    needed_ = std::max(request.limits.min_clearance, request.vehicle.radius_m);
  }

  bool leg_free(const Vec3& a, const Vec3& b) const {
    return step_free(a, b) && clear_of_solids(a, b);
  }
  /// The same for what is held to the solids by cells.
  bool step_free(const Vec3& a, const Vec3& b) const {
    return keeps_size(a, b) && place_free(a, b);
  }
  bool point_free(const Vec3& p) const { return place_free(p, p) && clear_of_solids(p, p); }
  /// Whether a verdict so far was too close to call.
  bool in_doubt() const { return in_doubt_; }

  double ground_gap(const Vec3& a, const Vec3& b) const {
    return std::min(scene_.ground->above(a), scene_.ground->above(b));
  }

 private:
  /// value >= limit, noting what is too close to call. Values built from equal cells often meet a
  /// limit: those are no doubt, the judge's tolerance lets them pass.
  bool at_least(double value, double limit, double tolerance = 1e-6) const {
    const double over = value - limit;
    in_doubt_ = in_doubt_ || (std::abs(over) < 10 * tolerance && std::abs(over) > tolerance / 10);
    return over >= -tolerance;
  }

  bool keeps_size(const Vec3& a, const Vec3& b) const {
    const Vec3 d = b - a;
    const Limits& limits = request_.limits;
    const double climb = std::atan2(std::abs(d.z()), std::sqrt(d.x() * d.x() + d.y() * d.y()));
    return at_least(std::sqrt(d.dot(d)), limits.min_leg) &&
           at_least(limits.max_leg, std::sqrt(d.dot(d))) && at_least(limits.max_climb, climb, 1e-8);
  }

  bool place_free(const Vec3& a, const Vec3& b) const {
    for (const Vec3& p : {a, b}) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!at_least(p[axis], request_.volume.min[axis]) ||
            !at_least(request_.volume.max[axis], p[axis])) {
          return false;
        }
      }
      if (request_.level_m && std::abs(p.z() - *request_.level_m) > 1e-6) {
        return false;
      }
    }
    return keeps_heights(a, b);
  }

  bool keeps_heights(const Vec3& a, const Vec3& b) const {
    for (const AltitudeBand& band : request_.limits.altitude) {
      const bool sea = band.datum == AltitudeBand::Datum::sea;
      const auto height = [&](const Vec3& p) { return sea ? p.z() : scene_.ground->above(p); };
      if (!at_least(std::min(height(a), height(b)), band.min) ||
          !at_least(band.max, std::max(height(a), height(b)))) {
        return false;
      }
    }
    if (!scene_.ground) {
      return true;
    }
    const double gap = ground_gap(a, b);
    return at_least(gap / scene_.ground->steepness(), needed_) &&
           (!request_.limits.min_ground_clearance ||
            at_least(gap, *request_.limits.min_ground_clearance));
  }

  bool clear_of_solids(const Vec3& a, const Vec3& b) const {
    const Vec3 middle = (a + b) / 2;
    const double half = (b - a).norm() / 2;
    for (const oracle::Solid& solid : scene_.solids) {
      double rough = kInfinity;
      for (std::size_t piece = 0; piece < oracle::pieces(solid); ++piece) {
        rough = std::min(rough, oracle::outside(solid, piece, middle));
      }
      if (rough > half + needed_ + kDoubt) {
        continue;
      }
      const double distance = oracle::leg_distance(solid, a, b);
      // At no distance the leg goes through: one that merely touches has no room in random worlds.
      in_doubt_ = in_doubt_ || (distance > 0 && std::abs(distance - needed_) < kDoubt);
      if (distance == 0 || distance < needed_) {
        return false;
      }
    }
    return true;
  }

  const Request& request_;
  const Scene& scene_;
  double needed_;
  mutable bool in_doubt_ = false;
};

/// Distance between an upright box and a solid that is no prism.
inline double box_distance(const Box& box, const oracle::Solid& solid) {
  const auto to_interval = [&](int axis, double low, double high) {
    return std::max({0.0, box.min[axis] - high, low - box.max[axis]});
  };
  if (const auto* s = std::get_if<Sphere>(&solid.shape)) {
    Vec3 gap;
    for (int axis = 0; axis < 3; ++axis) {
      gap[axis] = to_interval(axis, s->centre[axis], s->centre[axis]);
    }
    return std::max(0.0, gap.norm() - s->radius);
  }
  if (const auto* c = std::get_if<Cylinder>(&solid.shape)) {
    const double off = std::hypot(to_interval(0, c->x, c->x), to_interval(1, c->y, c->y));
    return std::hypot(std::max(0.0, off - c->radius), to_interval(2, c->floor, c->ceiling));
  }
  const Box& other = std::get<BoxShape>(solid.shape).box;
  Vec3 gap;
  for (int axis = 0; axis < 3; ++axis) {
    gap[axis] = to_interval(axis, other.min[axis], other.max[axis]);
  }
  return gap.norm();
}

/// The parameters of astar that its lattice depends on.
struct LatticeOptions {
  Vec3 cell{1, 1, 1};
  int neighbours = 26;
  bool free_box = false;
  bool cells = false;          ///< moves: cells
  std::optional<Vec3> anchor;  ///< centre of a cell where a layer has cells; else the start's
  /// With moves by cells: whether the cell with this centre is closed; left out, where a solid,
  /// grown by the clearance, overlaps it.
  std::function<bool(const Vec3&)> closed;
};

/// The lattice drawn out as a graph of legs that keep the rules.
struct LatticeOracle {
  LatticeOracle(const Request& request, const Scene& scene, LatticeOptions given)
      : options(std::move(given)), rules(request, scene), request_(request), scene_(scene) {
    const Vec3 anchor = options.anchor.value_or(request.start.position);
    Box room = request.volume;
    for (const AltitudeBand& band : request.limits.altitude) {
      if (band.datum == AltitudeBand::Datum::sea) {
        room.min.z() = std::max(room.min.z(), band.min);
        room.max.z() = std::min(room.max.z(), band.max);
      }
    }
    const int reach = 14;  // worlds of at most 12 cells an axis, a bit more beside the start
    const int reach_z = request.level_m ? 0 : reach;
    for (int k = -reach_z; k <= reach_z; ++k) {
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          Vec3 p = anchor + options.cell.cwiseProduct(Vec3(i, j, k));
          if (request.level_m) {
            p.z() = *request.level_m;
          }
          if (room.contains(p, 1e-9 * options.cell.maxCoeff())) {
            number_[{i, j, k}] = graph.add(p);
          }
        }
      }
    }
    cells = graph.at.size();
    join_cells();
    start = graph.add(request.start.position);
    goal = graph.add(request.goal.position);
    link(start, true);
    link(goal, false);
  }

  /// The least length that astar may give: to the goal, or else to a cell within its tolerance.
  double shortest(const std::vector<double>& best) const {
    const double longest = request_.limits.max_route_length + 1e-6;
    if (best[goal] < kInfinity && best[goal] <= longest) {
      return best[goal];
    }
    double least = kInfinity;
    for (std::size_t c = 0; c < cells; ++c) {
      if ((graph.at[c] - request_.goal.position).norm() <= request_.goal.tolerance_m + 1e-6) {
        least = std::min(least, best[c]);
      }
    }
    return least <= longest ? least : kInfinity;
  }

  LatticeOptions options;
  LegRules rules;
  Graph graph;
  std::size_t cells = 0;  ///< nodes before this are cells
  std::size_t start = 0;
  std::size_t goal = 0;

 private:
  bool closed(const Vec3& centre) const {
    if (options.closed) {
      return options.closed(centre);
    }
    const double needed = std::max(request_.limits.min_clearance, request_.vehicle.radius_m);
    const Box box{centre - options.cell / 2, centre + options.cell / 2};
    for (const oracle::Solid& solid : scene_.solids) {
      const double distance = box_distance(box, solid);
      if (distance == 0 || distance < needed) {
        return true;
      }
    }
    return false;
  }

  void join_cells() {
    std::map<Cell, bool> is_closed;
    for (const auto& [c, n] : number_) {
      is_closed[c] = options.cells && closed(graph.at[n]);
      open_.push_back(false);
    }
    for (const auto& [c, n] : number_) {
      open_[n] = !is_closed[c];
    }
    for (const auto& [a, from] : number_) {
      for (const auto& [d, unused] : around()) {
        const Cell b = {a[0] + d[0], a[1] + d[1], a[2] + d[2]};
        const auto to = number_.find(b);
        if (to == number_.end() || !box_open(a, d, is_closed)) {
          continue;
        }
        const Vec3& here = graph.at[from];
        const Vec3& there = graph.at[to->second];
        if (options.cells ? rules.step_free(here, there) : rules.leg_free(here, there)) {
          graph.join(from, to->second);
        }
      }
    }
  }

  std::map<Cell, bool> around() const {
    std::map<Cell, bool> directions;
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const int moved = std::abs(i) + std::abs(j) + std::abs(k);
          if (moved > 0 && (options.neighbours == 26 || moved == 1) &&
              !(request_.level_m && k != 0)) {
            directions[{i, j, k}] = true;
          }
        }
      }
    }
    return directions;
  }

  /// The two cells of a step, or all of the box that they span, are open.
  bool box_open(const Cell& a, const Cell& d, const std::map<Cell, bool>& is_closed) const {
    for (int part = 0; part < 8; ++part) {
      const bool an_end = part == 0 || part == 7;
      if (!an_end && !options.free_box) {
        continue;
      }
      const Cell c = {a[0] + (part & 1) * d[0], a[1] + (part >> 1 & 1) * d[1],
                      a[2] + (part >> 2 & 1) * d[2]};
      const auto found = is_closed.find(c);
      if (found == is_closed.end() || found->second) {
        return false;
      }
    }
    return true;
  }

  /// Joins a point to its own cell where it is the centre, else to the cells at most one edge away.
  void link(std::size_t point, bool outward) {
    const Vec3 p = graph.at[point];
    const auto offset = [&](std::size_t c) {
      Vec3 d = graph.at[c] - p;
      d.z() = request_.level_m ? 0 : d.z();
      return d;
    };
    std::vector<std::size_t> joined;
    for (std::size_t c = 0; c < cells; ++c) {
      if (offset(c).cwiseAbs().maxCoeff() <= 5e-7) {
        joined = {c};
        graph.at[point] = graph.at[c];  // one place, so that the link has no length
        break;
      }
      if ((offset(c).array().abs() <= options.cell.array() + 5e-7).all()) {
        joined.push_back(c);
      }
    }
    for (const std::size_t c : joined) {
      const bool same = graph.at[c] == graph.at[point];
      if (open_[c] && (same || rules.leg_free(graph.at[c], p))) {
        outward ? graph.join(point, c) : graph.join(c, point);
      }
    }
  }

  const Request& request_;
  const Scene& scene_;
  std::map<Cell, std::size_t> number_;
  std::vector<bool> open_;
};
}  // namespace altiplan::reference
