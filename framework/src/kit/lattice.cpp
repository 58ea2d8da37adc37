// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice.hpp"

#include <algorithm>
#include <string>

#include "altiplan/error.hpp"

namespace altiplan::kit {
namespace {

/// Slack for "this centre is still inside", in cells: what rounding can do.
constexpr double kRounding = 1e-9;

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

std::array<DirectionMask, kDirections> spanned_boxes() {
  std::array<DirectionMask, kDirections> boxes{};
  for (int d = 0; d < kDirections; ++d) {
    const Cell to = offset(d);
    for (int other = 0; other < kDirections; ++other) {
      const Cell o = offset(other);
      bool within = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        within = within && (o[axis] == 0 || o[axis] == to[axis]);
      }
      if (within) {
        boxes[std::size_t(d)] |= DirectionMask{1} << other;
      }
    }
  }
  return boxes;
}
}  // namespace

Lattice::Lattice(const Request& request, const Vec3& cell_m, Neighbourhood neighbourhood,
                 const LatticeMemory& memory)
    : level_m_(request.level_m), neighbourhood_(neighbourhood) {
  const Box box = room(request);
  const std::optional<GridSpec> native = request.world->native_grid();
  spec_.cell = native ? native->cell : cell_m;
  const Vec3 anchor = native ? native->centre({0, 0, 0}) : request.start.position;
  double total = 1;
  std::array<double, 3> counts{1, 1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = spec_.cell[axis];
    double first = std::ceil((box.min[axis] - anchor[axis]) / edge - kRounding);
    double last = std::floor((box.max[axis] - anchor[axis]) / edge + kRounding);
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
    total *= counts[std::size_t(axis)];
  }
  const double bytes = total * double(memory.bytes_per_cell);
  if (!(bytes <= double(memory.max_bytes)) || total > 4e9) {
    const double mb = 1.0 / (1024 * 1024);
    const auto whole = [](double value) { return std::to_string(std::int64_t(value)); };
    const double allowed_mb = std::min(double(memory.max_bytes) * mb, 1e15);
    const std::string allowed = allowed_mb < 1 ? "less than 1" : whole(allowed_mb);
    throw ParameterError(
        "cell_m",
        "the lattice would have " +
            (total < 1e18 ? whole(counts[0]) + " x " + whole(counts[1]) + " x " + whole(counts[2])
                          : std::string("more than 1e18")) +
            " cells, which need " +
            (total < 1e18 ? whole(std::ceil(bytes * mb)) : std::string("far too many")) +
            " MB; allowed are " + allowed +
            " MB and 4e9 cells: choose larger cells or a smaller volume");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    spec_.counts[axis] = int(counts[axis]);
  }
  for (int d = 0; d < kDirections; ++d) {
    const Cell o = offset(d);
    lengths_[std::size_t(d)] = step(d).norm();
    strides_[std::size_t(d)] =
        (std::int64_t(o[2]) * spec_.counts[1] + o[1]) * spec_.counts[0] + o[0];
    const int moved = (o[0] != 0) + (o[1] != 0) + (o[2] != 0);
    const bool wanted = neighbourhood_ == Neighbourhood::all ? moved > 0 : moved == 1;
    if (wanted && (o[2] == 0 || !level_m_)) {
      steps_ |= DirectionMask{1} << d;
    }
  }
}

Cell Lattice::cell(std::uint32_t index) const {
  const auto nx = std::uint32_t(spec_.counts[0]);
  const auto ny = std::uint32_t(spec_.counts[1]);
  return {int(index % nx), int(index / nx % ny), int(index / nx / ny)};
}

DirectionMask Lattice::inside(const Cell& c) const {
  // Directions with a component of -1 along each axis; those with +1 are the same bits, shifted.
  constexpr std::array<DirectionMask, 3> kLow = {0x1249249, 0x01C0E07, 0x00001FF};
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
  std::size_t most = 0;
  std::size_t middle = 1;
  std::size_t least = 2;
  if (n[most] < n[middle]) {
    std::swap(most, middle);
  }
  if (n[middle] < n[least]) {
    std::swap(middle, least);
  }
  if (n[most] < n[middle]) {
    std::swap(most, middle);
  }
  const auto along = [&](std::size_t set) {  // axes as bits: any direction along them
    return lengths_[std::size_t(direction(int(set & 1), int(set >> 1 & 1), int(set >> 2 & 1)))];
  };
  const std::size_t two = (std::size_t{1} << most) | (std::size_t{1} << middle);
  return n[least] * along(7) + (n[middle] - n[least]) * along(two) +
         (n[most] - n[middle]) * along(std::size_t{1} << most);
}

std::vector<Lattice::Link> Lattice::links(const Vec3& p) const {
  Cell low{};
  Cell high{};
  bool centred = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    if (axis == 2 && level_m_) {
      low[a] = high[a] = 0;
      continue;
    }
    const double at = (p[axis] - spec_.origin[axis]) / spec_.cell[axis] - 0.5;
    // Within the judge's tolerance of a centre, the point is that centre.
    const bool on_centre = std::abs(at - std::round(at)) * spec_.cell[axis] <= kLengthTolerance / 2;
    const double clamped = std::clamp(at, -2.0, spec_.counts[a] + 1.0);
    low[a] = on_centre ? int(std::round(clamped)) - 1 : int(std::floor(clamped));
    high[a] = on_centre ? low[a] + 2 : low[a] + 1;
    centred = centred && on_centre;
  }
  if (centred) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = high[axis] = (low[axis] + high[axis]) / 2;
    }
  }
  std::vector<Link> found;
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        const Cell c = {i, j, k};
        if (spec_.holds(c)) {
          found.push_back({c, centred ? 0 : (position(c) - p).norm()});
        }
      }
    }
  }
  return found;
}

DirectionMask blocked_around(const VoxelGrid& grid, const Cell& c) {
  const auto bit = std::size_t(c[0]);  // of cell i - 1 in its row: rows begin with cell -1
  const std::size_t word = bit / 64;
  const unsigned shift = bit % 64;
  DirectionMask mask = 0;
  int at = 0;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy, at += 3) {
      const std::uint64_t* row = grid.row_words(c[1] + dy, c[2] + dz);
      std::uint64_t window = row[word] >> shift;
      if (shift > 61) {  // the three cells straddle two words
        window |= row[word + 1] << (64 - shift);
      }
      mask |= DirectionMask(window & 7) << at;
    }
  }
  return mask;
}

DirectionMask free_steps(DirectionMask blocked, CornerRule rule) {
  static const std::array<DirectionMask, kDirections> kBoxes = spanned_boxes();
  if ((blocked >> kHere & 1) != 0) {
    return 0;
  }
  DirectionMask open = ~blocked & ((DirectionMask{1} << kDirections) - 1);
  open &= ~(DirectionMask{1} << kHere);
  if (rule == CornerRule::free_box && blocked != 0) {
    for (std::size_t d = 0; d < kDirections; ++d) {
      if ((blocked & kBoxes[d]) != 0) {
        open &= ~(DirectionMask{1} << d);
      }
    }
  }
  return open;
}
}  // namespace altiplan::kit
