// SPDX-License-Identifier: Apache-2.0
// Informed RRT*: RRT* that, once it has a route, samples only where a shorter one may lie.
//
// Citation: J. D. Gammell, S. S. Srinivasa, T. D. Barfoot: Informed RRT*: Optimal Sampling-based
//   Path Planning Focused via Direct Sampling of an Admissible Ellipsoidal Heuristic. IEEE/RSJ
//   International Conference on Intelligent Robots and Systems, 2014, pp. 2997-3004.
//   doi:10.1109/IROS.2014.6942976
// Guarantees: those of planner rrt_star.
// Complexity: that of rrt_star.
// Deviations: those of rrt_star; where the volume is smaller than the ellipsoid, samples are drawn
//   from the volume and those outside the ellipsoid rejected; nodes outside are removed when the
//   route has become shorter by 1 %.
// Symbols: those of rrt_star; the foci are start and goal, the sum of distances the best length
//   (with the goal's tolerance).
#include "altiplan/kit/sampling/star_params.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

using namespace altiplan;

class InformedRrtStar final : public Planner {
 public:
  explicit InformedRrtStar(const kit::StarParams& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const auto memory = memory_.take();
    kit::StarSettings settings = params_.settings(request);
    settings.bounded = settings.informed = true;
    return kit::star_search(request, settings, *memory);
  }
  Traits do_traits() const override { return params_.traits(); }

  kit::StarParams params_;
  mutable kit::ScratchPool<kit::StarMemory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "informed_rrt_star", InformedRrtStar, kit::StarParams,
                "Informed RRT*: RRT* that samples only where a shorter route may lie")
