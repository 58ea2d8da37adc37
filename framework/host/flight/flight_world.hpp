// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "altiplan/nearest_place.hpp"
#include "host/flight/flight.hpp"

namespace altiplan::host {

/// The true world over time, and the vehicle's knowledge of it. A layer is fully known if the known
/// world holds the same environment; otherwise the difference becomes known within sensing range.
class FlightWorld {
 public:
  FlightWorld(const FlightSetup& setup);

  const World& truth() const { return truth_; }
  const std::shared_ptr<const World>& known() const { return known_; }

  /// Applies an event that changes the world. Throws Error if its layer or obstacle does not
  /// exist.
  void apply(const FlightEvent& event);
  /// The changes that became known since the last call.
  std::vector<Change> sense(const Vec3& p, double time_s);
  /// Known moving obstacles as passed to a pilot. Valid until the next call.
  const std::vector<SensedObstacle>& sensed(const Vec3& p, double time_s);

  /// Layers that became known, or changed, since the route was planned.
  const std::set<std::string>& fresh() const { return fresh_; }
  void route_is_new() { fresh_.clear(); }

  /// Id of the obstacle that the vehicle touches on a leg in the true world, or null: moving
  /// obstacles by the sphere around its body. `request` is that of the true world.
  const std::string* contact(const std::optional<Approach>& before, const Vec3& a, double t0,
                             const Vec3& b, double t1, const Request& request) const;
  /// Minimum distance between the leg and anything in the true world, if below `min_distance`;
  /// signed as in leg_clearance: minus the depth inside an obstacle.
  double separation_below(double min_distance, const Vec3& a, double t0, const Vec3& b,
                          double t1) const;
  /// Records a flown leg, which begins at the end of the previous one.
  void flown(const Vec3& a, double t0, const Vec3& b, double t1);
  /// Separation over the whole track, in the true world of that time; infinite if nothing was near.
  NearestLeg separation();

 private:
  /// Measures the recorded legs in the current layers: all at once, since most need no exact
  /// figure.
  void measure_flown();
  void move(const FlightEvent& event);
  // `old`: the layer as known before, or null.
  bool sees_difference(const Layer& layer, const Layer* old, const Vec3& p) const;
  Change learn(Layer layer, const Layer* old);
  bool sees(const Environment& environment, const Vec3& p) const {
    return environment.clearance(p) <= sensing_m_;
  }
  void sense_moving(const Vec3& p, double time_s);

  World truth_;
  std::shared_ptr<const World> known_;
  double sensing_m_;
  std::set<std::string> fresh_;
  std::set<std::string> told_;               ///< ids whose last change need not be sensed
  std::map<std::string, Change> set_cells_;  ///< by layer: where its cells differ, until known
  std::vector<SensedObstacle> sensed_;
  NearestLeg separation_{0, kInfinity};
  std::size_t legs_ = 0;
  Polyline flown_;  ///< the latest legs, in the current layers, not yet measured
};
}  // namespace altiplan::host
