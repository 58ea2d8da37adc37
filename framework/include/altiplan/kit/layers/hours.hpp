// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "altiplan/world.hpp"

namespace altiplan::kit {

/// Second interface of a layer of which parts are closed at times alone, in seconds after the
/// scenario's start, ends included. The layer itself, whose queries know no time, is closed where
/// a part may be closed during a flight.
class ALTIPLAN_API Hours {
 public:
  using Times = std::vector<std::array<double, 2>>;
  struct Part {
    std::shared_ptr<const Environment> layer;
    Times closed;  ///< ascending
  };

  virtual ~Hours();
  const std::vector<Part>& parts() const { return do_parts(); }
  /// The layer without its parts that are open from one time to the other; one interval that is
  /// empty (from > until) leaves what is closed at all times.
  std::shared_ptr<const Environment> between(double from, double until) const {
    return do_between(from, until);
  }

  /// Seconds after the start until which all that is closed is known; infinite: at any time.
  double known_until_s() const { return do_known_until_s(); }

  static bool meet(const Times& closed, double from, double until);

 private:
  virtual const std::vector<Part>& do_parts() const = 0;
  virtual std::shared_ptr<const Environment> do_between(double from, double until) const = 0;
  /// Default: infinite.
  virtual double do_known_until_s() const;
};

/// True if a layer has parts that are closed at times.
ALTIPLAN_API bool has_hours(const World& world);
/// Seconds after the start until which what is closed is known of all layers.
ALTIPLAN_API double known_until_s(const World& world);
/// The world with each such layer as it is between two times; with infinite ones, closed.
ALTIPLAN_API World between(const World& world, double from, double until);
}  // namespace altiplan::kit
