// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan {

/// Horizontal wind that is constant within the cells of a grid. Beyond it, that of the nearest
/// cell.
class ALTIPLAN_API WindGrid {
 public:
  /// Columns and rows of cells of a size, from the corner in the south-west; velocities, m/s east
  /// and north, in rows from the south, each from the west.
  WindGrid(std::array<double, 2> south_west, std::array<double, 2> step, std::array<int, 2> counts,
           std::vector<std::array<float, 2>> velocities);

  Vec3 at(const Vec3& p) const;
  double max_speed() const { return max_speed_; }
  /// Borders between cells strictly between two coordinates of an axis (0: x, 1: y), ascending.
  std::vector<double> borders(std::size_t axis, double from, double to) const;

 private:
  std::array<double, 2> south_west_;
  std::array<double, 2> step_;
  std::array<int, 2> counts_;
  std::vector<std::array<float, 2>> velocities_;
  double max_speed_ = 0;
};

/// Seconds: sums of durations meet a change of the wind but for rounding.
inline constexpr double kTimeTolerance = 1e-6;

/// Horizontal wind, constant within layers of height, and there within the cells of a grid, if any;
/// other layers may take their place at times. Queries of places alone tell of the layers before
/// the first change.
struct ALTIPLAN_API Wind {
  struct Layer {
    double above_m = -kInfinity;  ///< lower border, metres above sea level
    Vec3 velocity{0, 0, 0};       ///< of the air, m/s, horizontal; of no meaning beside a grid
    std::shared_ptr<const WindGrid> grid{};
    double max_speed() const;
  };
  /// The layers from a time on, in seconds, that of request.start.
  struct Change {
    double from_s = 0;
    std::vector<Layer> layers;
  };
  std::vector<Layer> layers;      ///< by ascending border; below the first border there is no wind
  std::vector<Change> changes{};  ///< by ascending time

  bool is_calm() const { return layers.empty() && changes.empty(); }
  /// The wind at a time, as one that does not change; within the tolerance before a change, that
  /// after it.
  Wind in_force(double time_s) const;
  /// When that wind ends; infinite without a change later.
  double in_force_until(double time_s) const;
  /// Velocity of the air at a place.
  Vec3 at(const Vec3& p) const;
  /// The greatest speed at any place and time.
  double max_speed() const;
  /// Fractions of a straight leg at which it crosses a border, ascending, without 0 and 1.
  std::vector<double> crossings(const Vec3& from, const Vec3& to) const;
  /// True if no border passes through the inside of a box.
  bool is_uniform(const Box& box) const;
};

/// Ground speed, m/s, of a vehicle that holds a horizontal course (any length) by crabbing into the
/// wind; none if it cannot make good that course.
ALTIPLAN_API std::optional<double> ground_speed(const Vec3& course, double airspeed,
                                                const Vec3& wind);

/// Heading through the air, radians, that holds that course; none if it cannot.
ALTIPLAN_API std::optional<double> heading_on(const Vec3& course, double airspeed,
                                              const Vec3& wind);

/// Seconds of a straight leg at an airspeed, which is horizontal; infinite if the wind does not let
/// the vehicle hold the course. A leg without a heading takes the time of its length.
ALTIPLAN_API double flight_time(const Vec3& from, const Vec3& to, double airspeed,
                                const Wind& wind);
}  // namespace altiplan
