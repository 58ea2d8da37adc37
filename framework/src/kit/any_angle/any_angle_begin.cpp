// SPDX-License-Identifier: Apache-2.0
// Initialisation of a search: its ends, its units and its first node.
#include <algorithm>
#include <numeric>

#include "altiplan/kit/any_angle/any_angle.hpp"

namespace altiplan::kit {
namespace {

/// True if anything but obstacles may refuse a leg.
bool has_limits(Request request) {
  request.vehicle.body = nullptr;
  const Limits& limits = request.limits;
  return !MoveRules::cells_decide(request) || limits.max_slope() < kPi / 2 || limits.min_leg > 0 ||
         limits.max_leg < kInfinity;
}

/// Bound of the rounding error of a path's cost, for more legs than most have: routes are measured
/// in the end.
constexpr std::uint32_t kRoundings = 1000;
}  // namespace

AnyAngleNodes AnyAngleNodes::every_cell(const VoxelGrid& occupancy) {
  AnyAngleNodes nodes{&occupancy, CornerRule::free_box, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    nodes.cell[axis].resize(std::size_t(occupancy.spec().counts[axis]));
    std::iota(nodes.cell[axis].begin(), nodes.cell[axis].end(), 0);
  }
  return nodes;
}

AnyAngleSearch::AnyAngleSearch(const Request& request, const Lattice& lattice, MoveRules& rules,
                               const AnyAngleNodes& nodes, const AnyAngleSettings& settings,
                               AnyAngleMemory& memory)
    : request_(request),
      lattice_(lattice),
      rules_(rules),
      nodes_(nodes),
      settings_(settings),
      memory_(memory),
      reached_(memory.reached),
      closed_(memory.closed),
      open_(memory.open),
      watch_(request.budget),
      numbers_(nodes.grid->spec().counts),
      has_limits_(has_limits(request)),
      cells_decide_(!has_limits_ && request.vehicle.body == nullptr),
      steps_are_free_(cells_decide_ && nodes.corner == CornerRule::free_box),
      lattice_steps_(lattice.steps()) {
  progress_ = settings.before;
  memory_.sight.prepare(rules_.shared_grid());
  if (rules_.wide_grid() != nullptr) {
    memory_.wide_sight.prepare(rules_.wide_grid());
  }
}

/// The route's start or goal at p; its number is `beyond` if it is no node.
AnyAngleSearch::End AnyAngleSearch::end_at(const Vec3& p, Node beyond) const {
  const Lattice::Link nearest = lattice_.nearest(p);
  End end{beyond, nearest.length == 0 && !rules_.grid()->blocked(nearest.cell), nearest.cell, {}, p,
          {}};
  const GridSpec& spec = lattice_.spec();
  std::array<std::array<int, 2>, 3> keys;  // of the rows next to it
  bool is_node = end.centred;
  Cell key{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = int(axis);
    const bool level = end.centred || (a == 2 && request_.level_m);
    const double at = level ? nearest.cell[axis] : (p[a] - spec.origin[a]) / spec.cell[a] - 0.5;
    end.place[axis] = unit_[axis] * at;
    const std::vector<int>& rows = nodes_.cell[axis];
    const int above = int(std::lower_bound(rows.begin(), rows.end(), at) - rows.begin());
    const bool on_row = above < int(rows.size()) && rows[std::size_t(above)] == at;
    is_node = is_node && on_row;
    key[axis] = above;
    keys[axis] = {above - 1, on_row ? above + 1 : above};
  }
  if (is_node && !nodes_.grid->blocked(key)) {
    end.node = numbers_.index(key);
    return end;
  }
  for (int k = keys[2][0]; k <= keys[2][1]; ++k) {
    for (int j = keys[1][0]; j <= keys[1][1]; ++j) {
      for (int i = keys[0][0]; i <= keys[0][1]; ++i) {
        if (nodes_.grid->spec().holds({i, j, k}) && !nodes_.grid->blocked(i, j, k)) {
          end.links.push_back(numbers_.index({i, j, k}));
        }
      }
    }
  }
  return end;
}

void AnyAngleSearch::begin(double longest_m) {
  per_metre_ = kMax / longest_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    unit_[axis] = lattice_.spec().cell[int(axis)] * per_metre_;
  }
  const double allowed_m = std::max(request_.limits.max_route_length, 0.0) + kLengthTolerance;
  longest_ = allowed_m < longest_m ? std::uint32_t(allowed_m * per_metre_) + kRoundings : kNone;
  const Node count = Node(numbers_.size());
  memory_.reset(*nodes_.grid);
  goal_ = end_at(request_.goal.position, count);
  start_ = end_at(request_.start.position, count + 1);
  min_link_ = kNone;
  max_link_ = 0;
  for (const Node link : goal_.links) {
    min_link_ = std::min(min_link_, link);
    max_link_ = std::max(max_link_, link);
  }
  open_.clear();
  fallback_ = kNone;
  nearest_ = kNone;
  progress_.too_long = false;
  take(start_.node, start_.node, 0, heuristic(start_.node));
}
}  // namespace altiplan::kit
