// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/lattice.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "altiplan/error.hpp"

namespace altiplan::kit {
namespace {

/// Tolerance for "this centre is still inside", in cells: bounds the rounding, and is within the
/// judge's tolerance.
double rounding(double edge) { return std::min(1e-9, kLengthTolerance / 2 / edge); }

/// Where centres may lie: the volume, and the altitude bands over sea.
Box room(const Request& request) {
  Box box = request.volume;
  for (const AltitudeBand& band : request.limits.altitude) {
    if (band.datum == AltitudeBand::Datum::sea) {
      box.min.z() = std::max(box.min.z(), band.min);
      box.max.z() = std::min(box.max.z(), band.max);
    }
  }
  return box;
}

void expect_fitting(const Vec3& cell, const Box& box) {
  const Vec3 size = box.max - box.min;
  if (size.head<2>().maxCoeff() > 0 && cell.x() > size.x() && cell.y() > size.y()) {
    const auto whole = [](double value) {
      char text[32];
      std::snprintf(text, sizeof text, "%.9g", value);
      return std::string(text);
    };
    throw ParameterError("cell_m", "a cell of " + whole(cell.x()) + " x " + whole(cell.y()) +
                                       " m is larger than the volume of " + whole(size.x()) +
                                       " x " + whole(size.y()) + " m");
  }
}

/// Steps far beyond the volume would be of no use, and lengths lose all digits.
void expect_useful(const Vec3& cell, const Box& box) {
  const double maximum = 1e6 * std::max(1.0, (box.max - box.min).maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] > maximum) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "a cell of %.6g m on axis %c is over a million times larger than the volume",
                    cell[axis], "xyz"[axis]);
      throw ParameterError("cell_m", text);
    }
  }
}

void expect_few(const std::array<double, 3>& counts, const LatticeMemory& memory) {
  constexpr double kMaxAlongAxis = 1e9;  // indices are ints
  const double total = counts[0] * counts[1] * counts[2];
  const double bytes = total * double(memory.bytes_per_cell);
  const bool fits = bytes <= double(memory.max_bytes) && total <= 4e9;
  if (!fits || std::max({counts[0], counts[1], counts[2]}) > kMaxAlongAxis) {
    const double mb = 1.0 / (1024 * 1024);
    const auto whole = [](double value) { return std::to_string(std::int64_t(value)); };
    const double allowed_mb = double(memory.max_bytes) * mb;
    const std::string allowed = memory.max_bytes == ~std::size_t{0} ? ""
                                : allowed_mb < 1                    ? "less than 1 MB and "
                                                 : whole(allowed_mb) + " MB and ";
    const std::string cells =
        total < 1e18 ? whole(counts[0]) + " x " + whole(counts[1]) + " x " + whole(counts[2])
                     : std::string("more than 1e18");
    if (fits) {
      throw ParameterError("cell_m", "the lattice would have " + cells +
                                         " cells; allowed are 1e9 along an axis: choose larger "
                                         "cells or a smaller volume");
    }
    const std::string needed = total < 1e18 ? whole(std::ceil(bytes * mb)) : "far too many";
    throw ParameterError("cell_m", "the lattice would have " + cells + " cells, which need " +
                                       needed + " MB; allowed are " + allowed +
                                       "4e9 cells: choose larger cells or a smaller volume");
  }
}
}  // namespace

Lattice::Lattice(const Request& request, const Vec3& cell_m, Neighbourhood neighbourhood,
                 const LatticeMemory& memory)
    : level_m_(request.level_m), neighbourhood_(neighbourhood) {
  const Box box = room(request);
  const std::optional<GridSpec> native = request.world->native_grid();
  spec_.cell = native ? native->cell : cell_m;
  const Vec3 anchor = native ? native->centre({0, 0, 0}) : request.start.position;
  std::array<double, 3> counts{1, 1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = spec_.cell[axis];
    double first = std::ceil((box.min[axis] - anchor[axis]) / edge - rounding(edge));
    double last = std::floor((box.max[axis] - anchor[axis]) / edge + rounding(edge));
    if (axis == 2 && level_m_) {
      first = last = native ? std::floor((*level_m_ - anchor.z()) / edge + 0.5) : 0;
    }
    if (!(last >= first)) {
      throw ParameterError("cell_m", "no cell of " + std::to_string(edge) +
                                         " m has its centre within the volume on axis " +
                                         "xyz"[axis]);
    }
    spec_.origin[axis] = anchor[axis] + (first - 0.5) * edge;
    counts[std::size_t(axis)] = last - first + 1;
  }
  if (!native && !level_m_) {
    expect_fitting(spec_.cell, box);
  }
  if (!native) {
    expect_useful(spec_.cell, box);
  }
  expect_few(counts, memory);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    spec_.counts[axis] = int(counts[axis]);
  }
  numbers_ = CellIndex(spec_.counts);
  std::array<double, 8> along{};  // by the axes, as bits, of a step
  for (int set = 0; set < 8; ++set) {
    along[std::size_t(set)] = step(direction(set & 1, set >> 1 & 1, set >> 2 & 1)).norm();
  }
  for (int d = kHere; d < kDirections; ++d) {
    const Cell o = offset(d);
    const double length = along[std::size_t((o[0] & 1) | (o[1] & 1) << 1 | (o[2] & 1) << 2)];
    lengths_[std::size_t(d)] = lengths_[std::size_t(opposite(d))] = length;
    strides_[std::size_t(d)] = numbers_.stride(d);
    strides_[std::size_t(opposite(d))] = -numbers_.stride(d);
  }
  steps_ = neighbourhood_ == Neighbourhood::all ? kAlongAxes[0] | kAlongAxes[1] | kAlongAxes[2]
                                                : kAlongAxes[0];
  steps_ &= level_m_ ? kLevelDirections : ~DirectionMask{0};
}

DirectionMask Lattice::inside(const Cell& c) const {
  // Directions with a component of -1 along each axis; those with +1 are the same bits, shifted.
  constexpr auto kLowAlong = [](std::size_t axis) {
    return directions_where([axis](const Cell& o) { return o[axis] == -1; });
  };
  constexpr std::array<DirectionMask, 3> kLow = {kLowAlong(0), kLowAlong(1), kLowAlong(2)};
  constexpr std::array<int, 3> kShift = {2, 6, 18};
  DirectionMask outside = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    outside |= c[axis] == 0 ? kLow[axis] : 0;
    outside |= c[axis] == spec_.counts[axis] - 1 ? kLow[axis] << kShift[axis] : 0;
  }
  return ~outside & ((DirectionMask{1} << kDirections) - 1);
}

double Lattice::distance(const Cell& a, const Cell& b) const {
  const auto apart = [&](std::size_t axis) { return double(std::abs(a[axis] - b[axis])); };
  const std::array<double, 3> n = {apart(0), apart(1), apart(2)};
  if (neighbourhood_ == Neighbourhood::faces) {
    return n[0] * spec_.cell.x() + n[1] * spec_.cell.y() + n[2] * spec_.cell.z();
  }
  std::size_t maximum = 0;
  std::size_t middle = 1;
  std::size_t minimum = 2;
  if (n[maximum] < n[middle]) {
    std::swap(maximum, middle);
  }
  if (n[middle] < n[minimum]) {
    std::swap(middle, minimum);
  }
  if (n[maximum] < n[middle]) {
    std::swap(maximum, middle);
  }
  const auto along = [&](std::size_t set) {  // axes as bits: any direction along them
    return lengths_[std::size_t(direction(int(set & 1), int(set >> 1 & 1), int(set >> 2 & 1)))];
  };
  const std::size_t two = (std::size_t{1} << maximum) | (std::size_t{1} << middle);
  return n[minimum] * along(7) + (n[middle] - n[minimum]) * along(two) +
         (n[maximum] - n[middle]) * along(std::size_t{1} << maximum);
}

Lattice::Link Lattice::nearest(const Vec3& p) const {
  Cell c{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const double at = std::floor((p[axis] - spec_.origin[axis]) / spec_.cell[axis]);
    c[a] = int(std::clamp(at, 0.0, spec_.counts[a] - 1.0));  // level flight: the only layer
  }
  Vec3 way = position(c) - p;
  way.z() = level_m_ ? 0 : way.z();
  const bool centred = (way.cwiseAbs().array() <= kLengthTolerance / 2).all();
  return {c, centred ? 0 : way.norm()};
}

std::vector<Lattice::Link> Lattice::links(const Vec3& p, int edges) const {
  if (const Link own = nearest(p); own.length == 0) {
    return {own};
  }
  Cell low{};
  Cell high{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    if (axis == 2 && level_m_) {
      low[a] = high[a] = 0;
      continue;
    }
    const double at = (p[axis] - spec_.origin[axis]) / spec_.cell[axis] - 0.5;
    // Level with a centre: the cells on both sides of it.
    const bool level = std::abs(at - std::round(at)) * spec_.cell[axis] <= kLengthTolerance / 2;
    const double clamped = std::clamp(at, -1.0 - edges, double(spec_.counts[a] + edges));
    low[a] = level ? int(std::round(clamped)) - edges : int(std::floor(clamped)) + 1 - edges;
    high[a] = low[a] + 2 * edges - (level ? 0 : 1);
  }
  std::vector<Link> found;
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        const Cell c = {i, j, k};
        if (spec_.holds(c)) {
          found.push_back({c, (position(c) - p).norm()});
        }
      }
    }
  }
  return found;
}

std::optional<PlanResult> beyond_budget(const Lattice& lattice, std::size_t bytes_per_cell,
                                        const Budget& budget) {
  const std::size_t bytes = lattice.size() * bytes_per_cell;
  if (bytes <= budget.max_memory_bytes) {
    return std::nullopt;
  }
  const auto mb = [](std::size_t count) { return std::to_string(count >> 20); };
  PlanResult result;
  result.status = PlanStatus::timed_out;
  result.budget_hit = true;
  result.message = "the lattice has " + std::to_string(lattice.size()) + " cells, which need " +
                   mb(bytes + (1 << 20) - 1) + " MiB; the budget is " +
                   mb(budget.max_memory_bytes) + " MiB";
  result.counters = {{"expanded", 0}};
  return result;
}
}  // namespace altiplan::kit
