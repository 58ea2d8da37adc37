// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/leg_rules.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {
namespace {

/// At this depth within a blocked cell a leg is blocked whatever the tolerance.
constexpr double kSurelyInside = 2 * kLengthTolerance;

std::shared_ptr<const World> open_world() {
  static const auto kOpen = std::make_shared<const World>();
  return kOpen;
}
}  // namespace

LegRules::LegRules(const Request& request)
    : request_(request),
      looks_back_(request.limits.turns() || request.judges_pairs()),
      rest_(request) {
  if (const auto spec = cells_that_decide()) {
    grid_ = request.world->voxels(*spec, request.budget);
    per_cell_ = spec->cell.cwiseInverse();
    rest_.world = open_world();
    const Limits& limits = request.limits;
    cells_alone_ = !looks_back_ && limits.altitude.empty() && !limits.min_ground_clearance &&
                   limits.min_leg <= 0 && limits.max_leg == kInfinity &&
                   limits.max_slope() >= kPi / 2 && request.wind.is_calm() && !request.level_m;
  } else {
    rest_.limits.min_leg = 0;
    rest_.constraints.clear();
  }
}

/// The grid whose cells make up all layers, if nothing but its cells blocks.
std::optional<GridSpec> LegRules::cells_that_decide() const {
  const World& world = *request_.world;
  if (world.layers().empty() || world.has_ground() || request_.vehicle.body != nullptr ||
      std::max(request_.limits.min_clearance, request_.vehicle.radius_m) > 0) {
    return std::nullopt;
  }
  const std::optional<GridSpec> spec = world.layers().front().environment->info().native_grid;
  const bool one_grid =
      spec && spec->rule == GridSpec::Rule::native && spec->inflation == 0 &&
      std::all_of(world.layers().begin() + 1, world.layers().end(), [&](const Layer& layer) {
        return layer.environment->info().native_grid == spec;
      });
  return one_grid ? spec : std::nullopt;
}

bool LegRules::ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
  ++checked_;
  if (leg_kept(before, a, b)) {
    return true;
  }
  refused_[refused_count_++ % kRemembered] = {before, a, b};
  return false;
}

bool LegRules::ok(const std::optional<Approach>& before, const Leg& leg) {
  if (!leg.turns()) {
    return ok(before, leg.from, leg.to);
  }
  ++checked_;
  if (leg_ok(before, leg, request_)) {
    return true;
  }
  refused_turns_.resize(kRemembered);
  refused_turns_[refused_turn_count_++ % kRemembered] = {before, leg};
  return false;
}

bool LegRules::leg_kept(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) const {
  if (grid_ == nullptr) {
    return leg_ok(before, a, b, request_);
  }
  switch (by_cells(a, b)) {
    case Answer::free:
      return cells_alone_ ? request_.volume.contains(a, kLengthTolerance) &&
                                request_.volume.contains(b, kLengthTolerance)
                          : leg_ok(before, a, b, rest_);
    case Answer::blocked:
      return false;
    default:
      return leg_ok(before, a, b, request_);
  }
}

bool LegRules::follows(const Approach& before, const Vec3& a, const Vec3& b) {
  if (!looks_back_) {
    return true;
  }
  if (turn_ok(before, a, b, request_) &&
      std::all_of(request_.constraints.begin(), request_.constraints.end(),
                  [&](const NamedConstraint& named) {
                    return named.admits({before.from, a, b, request_.world.get()});
                  }) &&
      body_ok(before, Leg::straight(a, b), request_)) {
    return true;
  }
  refused_[refused_count_++ % kRemembered] = {before, a, b};
  return false;
}

bool LegRules::point_ok(const Vec3& p) const {
  if (grid_ != nullptr) {
    const Vec3 at = (p - grid_->spec().origin).cwiseProduct(per_cell_);
    return !in_grid(at) || !surely_blocked(at);
  }
  return leg_ok(std::nullopt, p, p, rest_);
}

/// A leg in cells of the grid, from its lower corner.
struct LegRules::CellLeg {
  Vec3 from;
  Vec3 way;
};

bool LegRules::in_grid(const Vec3& p) const {
  const Cell& counts = grid_->spec().counts;
  return p.x() >= 0 && p.y() >= 0 && p.z() >= 0 && p.x() < counts[0] && p.y() < counts[1] &&
         p.z() < counts[2];
}

/// Answer by the cells; unsure where the leg runs along faces of blocked ones, or leaves the grid.
LegRules::Answer LegRules::by_cells(const Vec3& a, const Vec3& b) const {
  const GridSpec& spec = grid_->spec();
  const Vec3 from = (a - spec.origin).cwiseProduct(per_cell_);
  const Vec3 to = (b - spec.origin).cwiseProduct(per_cell_);
  if (!in_grid(from) || !in_grid(to)) {
    return Answer::unsure;
  }
  // Most blocked legs are blocked at their end or at their midpoint.
  if (surely_blocked(to) || surely_blocked((from + to) / 2)) {
    return Answer::blocked;
  }
  const CellLeg leg{from, to - from};
  const Answer answer = by_layers(leg);
  return answer == Answer::unsure ? walk(leg) : answer;
}

/// True if a point of the grid, in cells, lies so deep in a blocked one that no tolerance matters.
bool LegRules::surely_blocked(const Vec3& p) const {
  const int i = int(p.x());
  const int j = int(p.y());
  const int k = int(p.z());
  if (!grid_->blocked(i, j, k)) {
    return false;
  }
  const Vec3 part = p - Vec3(i, j, k);
  return part.cwiseMin(Vec3::Ones() - part).cwiseProduct(grid_->spec().cell).minCoeff() >
         kSurelyInside;
}

/// Tests the cells that the leg intersects, and a few beside it, one layer at a time along its
/// longest axis: within a layer, the other axes cross at most one face each.
LegRules::Answer LegRules::by_layers(const CellLeg& leg) const {
  int axis = 0;
  leg.way.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const std::int64_t strides[3] = {1, std::int64_t(grid_->row_bits()),
                                   std::int64_t(grid_->level_bits())};
  const std::uint64_t* words = grid_->words().data();
  const auto blocked = [&](std::int64_t bit) { return words[bit / 64] >> (bit % 64); };
  const int first = int(leg.from[axis]);
  const int last = int(leg.from[axis] + leg.way[axis]);
  const int layers = std::abs(last - first);
  const std::int64_t step = last < first ? -strides[axis] : strides[axis];
  const double per_layer = layers == 0 ? 0 : 1 / std::abs(leg.way[axis]);
  double t = layers == 0
                 ? 1
                 : (last > first ? first + 1 - leg.from[axis] : leg.from[axis] - first) * per_layer;
  std::int64_t layer = std::int64_t(grid_->bit(0, 0, 0)) + first * strides[axis];
  std::int64_t at_u = int(leg.from[u]) * strides[u];
  std::int64_t at_v = int(leg.from[v]) * strides[v];
  double now = 0;
  for (int n = 0;; ++n) {
    const double until = n == layers ? 1.0 : std::min(t, 1.0);
    const std::int64_t end_u = int(leg.from[u] + until * leg.way[u]) * strides[u];
    const std::int64_t end_v = int(leg.from[v] + until * leg.way[v]) * strides[v];
    if (((blocked(layer + at_u + at_v) | blocked(layer + end_u + end_v) |
          blocked(layer + at_u + end_v) | blocked(layer + end_u + at_v)) &
         1) != 0) {
      return surely_blocked(leg.from + (now + until) / 2 * leg.way) ? Answer::blocked
                                                                    : Answer::unsure;
    }
    if (n == layers) {
      return Answer::free;
    }
    now = until;
    at_u = end_u;
    at_v = end_v;
    layer += step;
    t += per_layer;
  }
}

/// Tests the cells that the leg crosses, in order, until one is blocked: certain if the leg's
/// midpoint in that cell lies inside.
LegRules::Answer LegRules::walk(const CellLeg& leg) const {
  const std::uint64_t* words = grid_->words().data();
  const std::int64_t strides[3] = {1, std::int64_t(grid_->row_bits()),
                                   std::int64_t(grid_->level_bits())};
  std::int64_t step[3];
  double next[3];  // times at which the next face of an axis is crossed, and between two of them
  double between[3];
  std::int64_t bit = std::int64_t(grid_->bit(0, 0, 0));
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = leg.from[axis];
    const int first = int(from);
    const int last = int(from + leg.way[axis]);
    bit += first * strides[axis];
    crossings += std::abs(last - first);
    step[axis] = last > first ? strides[axis] : -strides[axis];
    between[axis] = first == last ? kInfinity : 1 / std::abs(leg.way[axis]);
    next[axis] = first == last ? kInfinity
                               : (last > first ? first + 1 - from : from - first) * between[axis];
  }
  double now = 0;
  for (;; --crossings) {
    int axis = next[1] < next[0] ? 1 : 0;
    axis = next[2] < next[axis] ? 2 : axis;
    const double until = crossings > 0 ? std::min(next[axis], 1.0) : 1.0;
    if ((words[bit / 64] >> (bit % 64) & 1) != 0) {
      return surely_blocked(leg.from + (now + until) / 2 * leg.way) ? Answer::blocked
                                                                    : Answer::unsure;
    }
    if (crossings == 0) {
      return Answer::free;
    }
    bit += step[axis];
    next[axis] += between[axis];
    now = until;
  }
}

/// The constraint or the layer that refuses the leg, by few queries of the world.
std::string LegRules::refused_by(const RefusedTurn& leg, const Request& open) const {
  const auto first = [&](const Request& request) {
    const auto found = leg_violations(leg.before, leg.leg, request, 0);
    return found.empty() ? std::string() : found.front().constraint;
  };
  const std::string limit = first(open);
  if (!limit.empty()) {
    return limit;
  }
  const double needed = std::max(request_.limits.min_clearance, request_.vehicle.radius_m);
  const Polyline chords = leg.leg.chords(kChordTolerance);
  for (std::size_t i = 0; i + 1 < chords.size(); ++i) {
    if (const Layer* layer = request_.world->blocked_by(chords[i], chords[i + 1], needed)) {
      return "'" + layer->id + "'";
    }
  }
  return first(request_);
}

std::string LegRules::refusals() const {
  Request open = request_;
  open.world = open_world();
  std::map<std::string, int> counts;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(refused_count_, kRemembered); ++i) {
    const Refused& leg = refused_[i];
    ++counts[refused_by({leg.before, Leg::straight(leg.a, leg.b)}, open)];
  }
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(refused_turn_count_, kRemembered); ++i) {
    ++counts[refused_by(refused_turns_[i], open)];
  }
  std::vector<std::pair<std::string, int>> rules(counts.begin(), counts.end());
  std::stable_sort(rules.begin(), rules.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [rule, count] : rules) {
    text += (text.empty() ? "" : ", ") + rule + " (" + std::to_string(count) + ")";
  }
  return text;
}
}  // namespace altiplan::kit
