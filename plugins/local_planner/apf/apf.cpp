// SPDX-License-Identifier: Apache-2.0
//
// Potential field in flight: paper 002, section 2.2 (fusion of A* and the artificial potential
// field, four repairs), after Khatib, "Real-time obstacle avoidance for manipulators and mobile
// robots", IJRR 5(1), 1986, doi:10.1177/027836498600500106.
//
// Guarantees: none of arrival (a field has local minima; they are detected and reported). A step
//   satisfies every constraint of check.hpp wherever a heading of the fan does.
// Complexity: one query of the surroundings and at least one leg check per step.
// Deviations: 1. distances are to the obstacle's edge minus the required clearance (to the centre
//   it flies into large obstacles). 2. The target is pulled in to `target_m`: with a far goal the
//   published gains cannot hold an obstacle off. 3. Ground has a separate influence distance, since
//   it lies below the whole flight. 4. For moving obstacles the closest approach counts. 5. Where
//   the field's step violates a constraint, the fan's nearest heading that satisfies all is flown;
//   the turn limit yields to safety (counted), and a step that it shortens keeps a quarter of its
//   length.
// Symbols: k_a, k_r gains, d distance to an edge, d_0 influence, b1 bearing to the obstacle,
//   b2 bearing to the target, alpha_2 turn limit, L1 and L2 steps.
#include "altiplan/local_planner.hpp"
#include "altiplan/plugin.hpp"
#include "field_pilot.hpp"

namespace {
using namespace altiplan;

class Apf final : public LocalPlanner {
 public:
  explicit Apf(const apf::Params& params) : params_(params) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return std::make_unique<apf::FieldPilot>(params_, request);
  }

  apf::Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "apf", Apf, apf::Params,
                "artificial potential field with four repairs, in 3-D")
