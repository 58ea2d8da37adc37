// SPDX-License-Identifier: Apache-2.0
//
// Velocity vector field: Li Chuntao, Yi Xiaoqin, Hu Mu, "Real-time path planning of UAV based on
// velocity vector field", Journal of Nanjing University of Aeronautics & Astronautics 44(3), 2012,
// 340-346 (paper 001).
//
// Guarantees of `paper`: the step is v Delta T, and no turn is tighter than R_min. None of arrival,
//   and none of keeping out of threats, whatever the paper says of completeness.
//   `robust`: the same, and no threat is entered after a safe start while none moves onto the
//   vehicle or its stored way out (README.md).
// Complexity: in a step, the threats whose rings the vehicle is in and the overlapping pairs among
//   them; before the first step and after a change of the world, O(n) cells and the pairs.
// Deviations: 1. eq. (5) is read as L = Delta R / sqrt(beta / alpha - 1). 2. The wedge of a trap is
//   on the far side of its chord: on the near side, as drawn, it never arrives. 3. A virtual target
//   is given up on leaving that wedge, or near it, not as soon as the trap is left. 4. Threats
//   grow by the clearance asked for; moving obstacles push as threats where they are. 5. Beyond the
//   paper, and only on request: ground (terrain_flight.hpp).
// Symbols: omega pull, alpha and beta push at the ring's and the threat's edge, epsilon guidance,
//   Delta R ring, T target, L1 from it to a threat's centre, L2 from there to the virtual target.
#include "altiplan/local_planner.hpp"
#include "altiplan/plugin.hpp"
#include "paper_pilot.hpp"
#include "robust_pilot.hpp"

namespace {
using namespace altiplan;

class VelocityField final : public LocalPlanner {
 public:
  explicit VelocityField(const velocity_field::Params& params) : params_(params) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    if (params_.variant == velocity_field::Variant::robust) {
      return std::make_unique<velocity_field::RobustPilot>(params_, request);
    }
    return std::make_unique<velocity_field::PaperPilot>(params_, request);
  }
  Traits do_traits() const override {
    Traits traits;
    traits.spatial = false;  // a threat is a disc at every height, over ground too
    traits.avoids_obstacles = false;
    return traits;
  }

  velocity_field::Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "velocity_field", VelocityField, velocity_field::Params,
                "Velocity vector field around discs in level flight, with virtual targets")
