// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/ground_steps.hpp"

#include <algorithm>
#include <cmath>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "altiplan/height_field.hpp"

namespace altiplan::kit {
namespace {

/// Highest ground of the layer below a box; infinite where part of it has none, or unknown.
double highest(const Ground& ground, const Box& box) {
  if (const HeightField* field = ground.height_field()) {
    return field->max_height(box.min.x(), box.min.y(), box.max.x(), box.max.y());
  }
  const Vec3 middle = (box.min + box.max) / 2;
  const auto height = ground.height(middle.x(), middle.y());
  const double run = (box.max - middle).head<2>().norm();
  return height ? *height + ground.slope(box) * run : kInfinity;
}
}  // namespace

GroundSteps::GroundSteps(const Lattice& lattice, const GroundRules& rules)
    : lattice_(lattice),
      rules_(rules),
      world_(rules.world()),
      columns_east_(std::size_t(lattice.spec().counts[0])),
      z0_(lattice.position({0, 0, 0}).z()),
      height_(lattice.spec().cell.z()),
      levels_(lattice.spec().counts[2]),
      has_ceiling_(rules.ceiling() < kInfinity) {
  const std::size_t columns = columns_east_ * std::size_t(lattice.spec().counts[1]);
  columns_.resize(columns);
  highest_.resize(columns);
  open_from_.reset(columns);
}

DirectionMask GroundSteps::above(const Level* levels, int level) {
#ifdef __SSE2__
  const __m128i here = _mm_set1_epi16(static_cast<short>(level));
  const auto eight = [&](int at) {
    return _mm_cmpgt_epi16(_mm_load_si128(reinterpret_cast<const __m128i*>(levels + at)), here);
  };
  const auto sixteen = [&](int at) {
    return DirectionMask(_mm_movemask_epi8(_mm_packs_epi16(eight(at), eight(at + 8))));
  };
  return sixteen(0) | sixteen(16) << 16;
#else
  DirectionMask mask = 0;
  for (int d = 0; d < kDirections; ++d) {
    mask |= DirectionMask(levels[d] > level) << d;
  }
  return mask;
#endif
}

void GroundSteps::count(std::size_t column, int level, DirectionMask refused) {
  const auto& lowest = columns_.at(column).lowest;
  for (; refused != 0; refused &= refused - 1) {
    const Level minimum = lowest[std::size_t(__builtin_ctz(refused))];
    ++(minimum >= kNever - 1 ? refused_.no_ground
       : level < minimum     ? refused_.too_low
                             : refused_.too_high);
  }
}

void GroundSteps::learn(int east, int north, int d) {
  const Vec3 a = lattice_.position({east, north, 0});
  const Vec3 b = a + lattice_.step(d);
  const auto raised = [&](const Vec3& p, int level) {
    return Vec3(p.x(), p.y(), p.z() + level * height_);
  };
  // Of a level that bounds the permitted ones, rounding aside.
  const auto level_at = [&](double level) { return int(std::clamp(level, 0.0, double(levels_))); };
  constexpr double kRounding = 1e-6;  // of a level
  int lowest = kNever;
  int highest = levels_;
  if (world_.ground_below(a, b)) {
    // The ground below its ends leaves the step one lowest level at most, and a query that may end
    // as soon as the whole leg is known to keep that one is several times faster than the exact
    // height of the leg above the ground.
    const Cell o = offset(d);
    const double gap_at_ends =
        std::min(a.z() - ground_at(east, north), b.z() - ground_at(east + o[0], north + o[1]));
    lowest = level_at(std::ceil((rules_.needed_gap() - gap_at_ends) / height_ - kRounding));
    const double enough = rules_.certain_gap() + 2 * kRounding * height_;
    int certain = lowest;
    double gap = gap_at_ends;
    if (lowest < levels_ &&
        (gap = world_.ground_gap(raised(a, lowest), raised(b, lowest), enough)) < enough) {
      gap -= lowest * height_;
      lowest = level_at(std::ceil((rules_.needed_gap() - gap) / height_ - kRounding));
      certain = level_at(std::ceil((rules_.certain_gap() - gap) / height_ + kRounding));
    }
    while (lowest < certain) {
      const int middle = (lowest + certain) / 2;
      const bool keeps =
          rules_.floors(raised(a, middle), raised(b, middle)) == GroundRules::Refusal::none;
      (keeps ? certain : lowest) = keeps ? middle : middle + 1;
    }
  }
  if (has_ceiling_) {
    const double beyond = (rules_.ceiling() - world_.ground_gap_max(a, b)) / height_;
    highest = int(std::clamp(std::floor(beyond + kRounding), -1.0, double(levels_)));
    while (highest >= 0 && !rules_.below_ceilings(raised(a, highest), raised(b, highest))) {
      --highest;
    }
  }
  set(east, north, d, lowest, highest);
  const Cell o = offset(d);  // the same leg, flown the other way
  const Cell& counts = lattice_.spec().counts;
  if (east + o[0] >= 0 && east + o[0] < counts[0] && north + o[1] >= 0 &&
      north + o[1] < counts[1]) {
    set(east + o[0], north + o[1], opposite(d), lowest + o[2], highest + o[2]);
  }
}

double GroundSteps::ground_at(int east, int north) {
  float& ground = columns_.at(column_at(east, north)).ground;
  if (std::isnan(ground)) {
    const Vec3 p = lattice_.position({east, north, 0});
    ground = std::nextafter(float(p.z() - world_.ground_gap(p, p)), -INFINITY);
  }
  return ground;
}

void GroundSteps::set(int east, int north, int d, int lowest, int highest) {
  const std::size_t at = column_at(east, north);
  Column& column = columns_.at(at);
  column.lowest[std::size_t(d)] = Level(lowest);
  if (has_ceiling_) {
    highest_.at(at)[std::size_t(d)] = Level(highest);
  }
  column.known |= DirectionMask{1} << d;
}

int GroundSteps::level_above_all(int east, int north) const {
  const Vec3 here = lattice_.position({east, north, 0});
  const Vec3 reach(lattice_.spec().cell.x(), lattice_.spec().cell.y(), kInfinity);
  const Box box{here - reach, here + reach};
  double top = world_.has_ground() ? kInfinity : -kInfinity;
  for (const Layer& layer : world_.layers()) {
    const Ground* ground = layer.environment->ground();
    if (ground != nullptr && layer.environment->bounds().overlaps(box)) {
      top = std::max(top == kInfinity ? -kInfinity : top, highest(*ground, box));
    }
  }
  const double needed = top + rules_.certain_gap() + kLengthTolerance;
  if (rules_.ceiling() < kInfinity || !(needed < kInfinity)) {
    return kNever;
  }
  if (z0_ >= needed) {
    return 0;
  }
  return levels_ == 1
             ? kNever
             : int(std::clamp(std::ceil((needed - z0_) / height_) + 1, 0.0, double(kNever)));
}
}  // namespace altiplan::kit
