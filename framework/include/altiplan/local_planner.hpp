// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan {

/// A moving obstacle as reported by the sensor.
struct SensedObstacle {
  std::string_view id;
  Vec3 position{0, 0, 0};        ///< centre
  double radius = 0;             ///< of the bounding sphere
  std::optional<Vec3> velocity;  ///< if observed, m/s
};

/// Input of a pilot before each step.
struct Observation {
  State state;  ///< actual state, which may differ from the end of the last step
  Vec3 local_target{0, 0, 0};
  Goal goal;
  std::span<const Vec3> rest;  ///< remaining route points, the goal's last; may be empty
  const World* world = nullptr;
  std::span<const Change> changes;  ///< since the last step
  std::span<const SensedObstacle> moving;
  double max_dt_s = 1;  ///< maximum duration of the step
};

struct PilotStep {
  enum class Outcome { flying, arrived, stuck };
  State next;
  Outcome outcome = Outcome::flying;
  std::string_view why;  ///< valid until the next step
};

/// Flies from observation to observation; holds the state of one flight.
/// Contract: 1. continues from the observed state. 2. 0 < next.time - state.time <= max_dt, and the
/// speed is at most the vehicle's. 3. No allocation in a step. 4. Equal observations in equal
/// order give equal steps.
class ALTIPLAN_API Pilot {
 public:
  virtual ~Pilot();
  PilotStep step(const Observation& seen);
  /// Obstacles farther away than this do not influence it; the host hands over within it.
  double reach_m() const;
  Counters counters() const { return do_counters(); }

 private:
  virtual PilotStep do_step(const Observation& seen) = 0;
  virtual double do_reach_m() const = 0;
  virtual Counters do_counters() const;
};

/// Creates pilots. In a `plan` step the host rolls one out until it arrives, is stuck, or the
/// budget ends; in a `fly` step it commands near anything that the route did not account for. One
/// step of a pilot is one iteration.
class ALTIPLAN_API LocalPlanner {
 public:
  virtual ~LocalPlanner();
  std::unique_ptr<Pilot> begin(const Request& request) const;
  Traits traits() const { return do_traits(); }

 private:
  virtual std::unique_ptr<Pilot> do_begin(const Request& request) const = 0;
  virtual Traits do_traits() const;
};
}  // namespace altiplan
