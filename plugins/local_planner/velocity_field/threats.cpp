// SPDX-License-Identifier: Apache-2.0
#include "threats.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "altiplan/error.hpp"

namespace velocity_field {
using namespace altiplan;

Threats::Threats(std::vector<Disc> discs, double reach) : discs_(std::move(discs)), reach_(reach) {
  if (!discs_.empty()) {
    choose_cells();
    list_discs();
  }
}

void Threats::choose_cells() {
  Vec2 high = discs_.front().centre;
  low_ = high;
  double squares = 0;
  for (const Disc& disc : discs_) {
    const double grown = disc.radius + reach_;
    low_ = low_.cwiseMin(Vec2(disc.centre.array() - grown));
    high = high.cwiseMax(Vec2(disc.centre.array() + grown));
    squares += grown * grown;
  }
  // Half the mean reach (root mean square, so that the number of discs bounds the length of the
  // lists), unless that gives more than a few cells per disc.
  const double count = double(discs_.size());
  const Vec2 size = high - low_;
  const double max_cells = 4 * count + 60;
  side_ = std::max({std::sqrt(squares / count) / 2, std::sqrt(size.x() * size.y() / max_cells),
                    size.maxCoeff() / max_cells});
  columns_ = int(size.x() / side_) + 1;
  rows_ = int(size.y() / side_) + 1;
}

std::pair<int, int> Threats::span_of(const Disc& disc, double by, int axis) const {
  const int count = axis == 0 ? columns_ : rows_;
  const double middle = disc.centre[axis] - low_[axis];
  const double grown = disc.radius + by;
  return {std::clamp(int((middle - grown) / side_), 0, count - 1),
          std::clamp(int((middle + grown) / side_), 0, count - 1)};
}

template <class Call>
bool Threats::any_cell(const Disc& disc, double by, const Call& call) const {
  // Slightly more, so that rounding omits no touched cell.
  const double grown = (disc.radius + by) * (1 + 1e-9) + 1e-6;
  const auto [column0, column1] = span_of(disc, by, 0);
  const auto [row0, row1] = span_of(disc, by, 1);
  for (int row = row0; row <= row1; ++row) {
    for (int column = column0; column <= column1; ++column) {
      const Vec2 low = low_ + side_ * Vec2(column, row);
      const Vec2 nearest = disc.centre.cwiseMax(low).cwiseMin(Vec2(low.array() + side_));
      if ((nearest - disc.centre).squaredNorm() <= grown * grown) {
        if (call(std::size_t(row) * std::size_t(columns_) + std::size_t(column))) {
          return true;
        }
      }
    }
  }
  return false;
}

void Threats::list_discs() {
  cells_from_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  for (const Disc& disc : discs_) {
    any_cell(disc, reach_, [&](std::size_t cell) {
      ++cells_from_[cell + 1];
      return false;
    });
  }
  std::partial_sum(cells_from_.begin(), cells_from_.end(), cells_from_.begin());
  cells_.resize(cells_from_.back());
  std::vector<std::uint32_t> next(cells_from_.begin(), cells_from_.end() - 1);
  for (std::uint32_t disc = 0; disc < discs_.size(); ++disc) {
    any_cell(discs_[disc], reach_, [&](std::size_t cell) {
      cells_[next[cell]++] = disc;
      return false;
    });
  }
}

bool Threats::has_partner(std::uint32_t disc) const {
  // Any disc that overlaps it reaches into a cell that it touches.
  return any_cell(discs_[disc], 0, [&](std::size_t cell) {
    return std::any_of(cells_.begin() + cells_from_[cell], cells_.begin() + cells_from_[cell + 1],
                       [&](std::uint32_t other) { return other != disc && overlap(disc, other); });
  });
}

std::span<const std::uint32_t> Threats::near(const Vec2& p) const {
  const Vec2 at = (p - low_) / side_;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < columns_ && at.y() < rows_)) {
    return {};
  }
  const std::size_t cell = std::size_t(at.y()) * std::size_t(columns_) + std::size_t(at.x());
  return {cells_.data() + cells_from_[cell], cells_.data() + cells_from_[cell + 1]};
}

ThreatFeed::ThreatFeed(const Request& request, double reach)
    : room_(std::max(request.limits.min_clearance, request.vehicle.reach_m())),
      reach_(reach),
      goal_(request.goal.position) {
  load(*request.world);
}

bool ThreatFeed::update(const Observation& seen) {
  bool news = !seen.changes.empty();
  if (seen.goal.position != goal_) {
    goal_ = seen.goal.position;
    news = true;
  }
  if (seen.world != world_ || seen.world->revision() != revision_ || news) {
    if (is_as_before(*seen.world)) {
      world_ = seen.world;
      revision_ = seen.world->revision();
    } else {
      load(*seen.world);
      news = true;
    }
  }
  return news;
}

bool ThreatFeed::is_as_before(const World& world) const {
  return std::equal(world.layers().begin(), world.layers().end(), layers_.begin(), layers_.end(),
                    [](const Layer& layer, const auto& old) { return layer.environment == old; });
}

void ThreatFeed::load(const World& world) {
  world_ = &world;
  revision_ = world.revision();
  layers_.clear();
  for (const Layer& layer : world.layers()) {
    layers_.push_back(layer.environment);
  }
  std::vector<Disc> discs;
  for (const Threat& threat : world.threats()) {
    if (!is_finite(threat.centre) || !(threat.radius >= 0 && threat.radius < kInfinity)) {
      throw Error("velocity_field: the threat '" + threat.id +
                  "' is not a disc; expected a finite centre, and a finite radius of at least 0");
    }
    discs.push_back({threat.centre.head<2>(), threat.radius + room_});
  }
  threats_ = Threats(std::move(discs), reach_);
}
}  // namespace velocity_field
