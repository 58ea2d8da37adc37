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

/// The true world in time, and what the vehicle knows of it. A layer is known as it is when the
/// known world holds the same environment; where it does not, the difference becomes known when it
/// comes within sensing range.
class FlightWorld {
 public:
  FlightWorld(const FlightSetup& setup);

  const World& truth() const { return truth_; }
  const std::shared_ptr<const World>& known() const { return known_; }

  /// An event other than a moved goal. Throws Error where it names what is not there.
  void apply(const FlightEvent& event);
  /// What has become known since the last call.
  std::vector<Change> sense(const Vec3& p, double time_s);
  /// Known moving obstacles as a pilot is shown them. Valid until the next call.
  const std::vector<SensedObstacle>& sensed(const Vec3& p, double time_s);

  /// Layers that became known, or changed, since the route was planned.
  const std::set<std::string>& fresh() const { return fresh_; }
  void route_is_new() { fresh_.clear(); }

  /// What the leg touches in the true world: an id, or null.
  const std::string* contact(const Vec3& a, double t0, const Vec3& b, double t1,
                             double radius) const;
  /// Least distance between the leg and anything in the true world, if it is below `least`:
  /// signed as leg_clearance is, and so minus the depth inside of something.
  double separation_below(double least, const Vec3& a, double t0, const Vec3& b, double t1) const;
  /// A leg that was flown, from where the one before ended.
  void flown(const Vec3& a, double t0, const Vec3& b, double t1);
  /// Of all that was flown, in the true world as it was then; infinite where nothing was near.
  NearestLeg separation();

 private:
  /// Measures the legs flown in the layers as they are: all at once, since most need no exact
  /// figure.
  void measure_flown();
  void move(const FlightEvent& event);
  // `old`: the layer as it was known, or null.
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
  Route flown_;  ///< the last of them, in the layers as they are, not yet measured against these
};
}  // namespace altiplan::host
