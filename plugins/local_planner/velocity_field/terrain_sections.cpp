// SPDX-License-Identifier: Apache-2.0
#include "terrain_sections.hpp"

#include <algorithm>

#include "altiplan/error.hpp"

namespace velocity_field {
using namespace altiplan;

namespace {
/// A walk over the eight neighbours is at most that much longer than the straight line.
constexpr double kWalk = 1.0823922;
/// What reading between centres may miss, in cells times slope: the top of the cell that p is in by
/// 0.8, the straight line's rise by 0.7.
constexpr double kBetween = 1.5;
constexpr double kMaxCells = 16e6;
/// Of closed ground, before its surroundings say more.
constexpr float kLowest = -1e9F;
/// So near to the middle of a disc, of its radius, the field takes a place that is in deep.
constexpr double kDeepest = 0.1;
}  // namespace

TerrainSections::TerrainSections(const World& world, const GroundRules& rules)
    : low_(rules.box.min.head<2>()), cell_(rules.cell), bay_(rules.bay) {
  const Vec3 size = rules.box.max - rules.box.min;
  if (!((size.x() / cell_ + 1) * (size.y() / cell_ + 1) <= kMaxCells)) {
    throw Error(
        "velocity_field: section_cell_m makes more than 16,000,000 cells of the volume; "
        "expected larger cells");
  }
  columns_ = std::max(1, int(std::ceil(size.x() / cell_)));
  rows_ = std::max(1, int(std::ceil(size.y() / cell_)));
  safe_.resize(std::size_t(columns_) * std::size_t(rows_));
  closed_.resize(safe_.size());
  tops_.resize(safe_.size());
  const double more = rules.reserve + kBetween * rules.slope * cell_;
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      tops_[at(i, j)] = float(top(world, rules, centre(i, j)));
      const double height = tops_[at(i, j)] + more;
      closed_[at(i, j)] = height > rules.ceiling;
      safe_[at(i, j)] = closed_[at(i, j)] ? kLowest : float(height - rules.reserve);
    }
  }
  if (rules.slope > 0) {
    spread(rules.slope);
  }
}

double TerrainSections::top(const World& world, const GroundRules& rules, const Vec2& p) const {
  const Vec3 half(cell_ / 2 + rules.radius, cell_ / 2 + rules.radius, 0);
  const Box box{Vec3(p.x(), p.y(), 0) - half, Vec3(p.x(), p.y(), 0) + half};
  double highest = -kInfinity;
  for (const Layer& layer : world.layers()) {
    const Ground* ground = layer.environment->ground();
    if (ground == nullptr) {
      continue;
    }
    const std::optional<double> height = ground->height(p.x(), p.y());
    const double slope = ground->slope(box);
    if (!height || !(slope < kInfinity)) {
      return kInfinity;
    }
    highest = std::max(highest, *height + slope * cell_ * std::sqrt(0.5) +
                                    std::max(rules.above, rules.radius * std::hypot(1, slope)));
  }
  return highest;
}

template <class HandOn>
void TerrainSections::sweep(const HandOn& hand_on) const {
  const auto from = [&](int i, int j, int di, int dj) {
    if (i + di >= 0 && i + di < columns_ && j + dj >= 0 && j + dj < rows_) {
      hand_on(at(i, j), at(i + di, j + dj));
    }
  };
  const auto from_behind = [&](int i, int j, int side) {
    from(i, j, -side, 0);
    from(i, j, -side, -side);
    from(i, j, 0, -side);
    from(i, j, side, -side);
  };
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      from_behind(i, j, 1);
    }
    for (int i = columns_ - 1; i >= 0; --i) {
      from(i, j, 1, 0);
    }
  }
  for (int j = rows_ - 1; j >= 0; --j) {
    for (int i = columns_ - 1; i >= 0; --i) {
      from_behind(i, j, -1);
    }
    for (int i = 0; i < columns_; ++i) {
      from(i, j, -1, 0);
    }
  }
}

void TerrainSections::spread(double slope) {
  const float beside = float(slope / kWalk * cell_);
  const float across = float(beside * std::sqrt(2.0));
  sweep([&](std::size_t to, std::size_t from) {
    const std::size_t apart = std::max(to, from) - std::min(to, from);
    const bool straight = apart == 1 || apart == std::size_t(columns_);
    safe_[to] = std::max(safe_[to], safe_[from] - (straight ? beside : across));
  });
}

double TerrainSections::between(const std::vector<float>& values, const Vec2& p) const {
  const Vec2 place = (p - low_).array() / cell_ - 0.5;
  const int i = std::clamp(int(std::floor(place.x())), 0, std::max(columns_ - 2, 0));
  const int j = std::clamp(int(std::floor(place.y())), 0, std::max(rows_ - 2, 0));
  const double u = std::clamp(place.x() - i, 0.0, 1.0);
  const double v = std::clamp(place.y() - j, 0.0, 1.0);
  const int i1 = std::min(i + 1, columns_ - 1);
  const int j1 = std::min(j + 1, rows_ - 1);
  return (1 - v) * ((1 - u) * values[at(i, j)] + u * values[at(i1, j)]) +
         v * ((1 - u) * values[at(i, j1)] + u * values[at(i1, j1)]);
}

double TerrainSections::safe_height(const Vec2& p) const { return between(safe_, p); }

bool TerrainSections::is_above(const Vec3& a, const Vec3& b) const {
  // Places a quarter of a cell apart, and for each the cells that the leg touches until the next.
  const int count = 1 + int(4 * (b - a).head<2>().norm() / cell_);
  const double fall = std::abs(b.z() - a.z()) / count;
  for (int n = 0; n <= count; ++n) {
    const Vec3 p = a + double(n) / count * (b - a);
    for (const double x : {-0.25, 0.25}) {
      for (const double y : {-0.25, 0.25}) {
        const Vec2 place = (p.head<2>() - low_) / cell_ + Vec2(x, y);
        const int i = std::clamp(int(std::floor(place.x())), 0, columns_ - 1);
        const int j = std::clamp(int(std::floor(place.y())), 0, rows_ - 1);
        if (p.z() - fall < tops_[at(i, j)]) {
          return false;
        }
      }
    }
  }
  return true;
}

template <class Far>
std::vector<float> TerrainSections::distances(const Far& far) const {
  // Each cell learns the nearest one that its neighbours know of.
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> nearest(safe_.size());
  for (std::uint32_t n = 0; n < nearest.size(); ++n) {
    nearest[n] = far(n) ? kNone : n;
  }
  const auto columns = std::size_t(columns_);
  const auto apart = [&](std::size_t a, std::size_t b) {
    const std::size_t row_a = a / columns;
    const std::size_t row_b = b / columns;
    const double x = double(a % columns) - double(b % columns);
    const double y = double(row_a) - double(row_b);
    return x * x + y * y;
  };
  // Where there is none, as far as the grid is wide.
  std::vector<float> squares(safe_.size(), float(apart(0, safe_.size() - 1) + 1));
  for (std::size_t n = 0; n < nearest.size(); ++n) {
    squares[n] = nearest[n] == kNone ? squares[n] : 0;
  }
  sweep([&](std::size_t to, std::size_t from) {
    if (nearest[from] != kNone && squares[to] > 0) {
      const float square = float(apart(to, nearest[from]));
      if (square < squares[to]) {
        squares[to] = square;
        nearest[to] = nearest[from];
      }
    }
  });
  for (float& value : squares) {
    value = float(cell_) * std::sqrt(value);
  }
  return squares;
}

std::vector<float> TerrainSections::gaps(double level) const {
  // Grown by the bay and shrunk again, a section has its bays filled.
  const float bay = float(bay_);
  const std::vector<float> off =
      distances([&](std::size_t n) { return closed_[n] == 0 && !(safe_[n] > level); });
  const std::vector<float> grown = distances([&](std::size_t n) { return off[n] <= bay; });
  const auto in = [&](std::size_t n) { return off[n] == 0 || grown[n] > bay; };
  const std::vector<float> depth = distances(in);
  std::vector<float> gaps = distances([&](std::size_t n) { return !in(n); });
  const float half = float(cell_ / 2);
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    gaps[n] = depth[n] > 0 ? half - depth[n] : gaps[n] - half;
  }
  return gaps;
}

std::optional<Disc> TerrainSections::disc(const std::vector<float>& gaps, const Vec2& p,
                                          double radius, double reach) const {
  const double gap = between(gaps, p);
  if (gap > reach) {
    return std::nullopt;
  }
  const Vec2 east(cell_, 0);
  const Vec2 north(0, cell_);
  const Vec2 rise(between(gaps, p + east) - between(gaps, p - east),
                  between(gaps, p + north) - between(gaps, p - north));
  const double size = rise.norm();
  const Vec2 out = size > 0 ? Vec2(rise / size) : Vec2(1, 0);
  return Disc{p - std::max(radius + gap, kDeepest * radius) * out, radius};
}
}  // namespace velocity_field
