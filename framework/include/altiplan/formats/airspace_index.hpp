// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "altiplan/formats/airspace.hpp"

namespace altiplan::formats {

/// Which zones hold a place at a time. Immutable and thread-safe.
class ALTIPLAN_API AirspaceIndex {
 public:
  struct Place {
    double lon = 0;  ///< degrees
    double lat = 0;
    double z_m = 0;  ///< above sea level
    /// Height of the ground there; unknown: zones are closed at all heights that depend on it.
    std::optional<double> ground_m;
  };

  /// `qnh_hpa`: of flight levels.
  explicit AirspaceIndex(std::vector<Zone> zones, double qnh_hpa = 1013.25);
  ~AirspaceIndex();
  AirspaceIndex(AirspaceIndex&&) noexcept;
  AirspaceIndex& operator=(AirspaceIndex&&) noexcept;

  const std::vector<Zone>& zones() const { return zones_; }
  /// Calls visit(zone) for each zone that holds the place, limits included, and is active at some
  /// time of [from, until], until it returns false.
  void visit(const Place& place, double from, double until,
             const std::function<bool(const Zone&)>& visit) const;
  /// The first of them that is at least as strict, or null.
  const Zone* find(const Place& place, double time, Restriction strict = Restriction::inform) const;

 private:
  struct Impl;
  std::vector<Zone> zones_;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan::formats
