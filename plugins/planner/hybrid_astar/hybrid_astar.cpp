// SPDX-License-Identifier: Apache-2.0
// Hybrid A*: a search over continuous poses, one for each cell of position, height and heading.
//
// Citation: D. Dolgov, S. Thrun, M. Montemerlo, J. Diebel: Path Planning for Autonomous Vehicles in
//   Unknown Semi-structured Environments. International Journal of Robotics Research 29(5), 2010,
//   pp. 485-501. doi:10.1177/0278364909359210
// Guarantees: every leg satisfies every constraint, and legs join tangentially. Neither complete
//   nor optimal: a cell keeps one pose.
// Complexity: O(n log n) for n poses, at most cells times headings; O(n) memory.
// Deviations: in space, with the Dubins airplane's paths as analytic expansions and, without wind,
//   as one heuristic; the other one is the shortest path over the columns in which the vehicle may
//   be at some height. A path to the goal that is free ends the search only when no pose promises a
//   shorter one. No gradient descent follows.
// Symbols: g, h, f = g + weight_h h in metres through the air.
#include "altiplan/params.hpp"
#include "altiplan/plugin.hpp"
#include "search.hpp"

namespace {

using namespace altiplan;

struct Params {
  AutoNumber radius_m;
  AutoNumber cell_m;
  AutoNumber cell_height_m;
  int headings = 16;
  double weight_h = 1.2;
  int max_memory_mb = 2048;

  void describe(Fields& f) {
    f("radius_m", radius_m)
        .unit("m")
        .greater_than(0)
        .doc(
            "radius of turns; auto: the smallest that vehicle and constraints allow, else one "
            "cell");
    f("cell_m", cell_m)
        .unit("m")
        .greater_than(0)
        .doc(
            "horizontal cell edge length; auto: half the radius, or 1/200 of the volume without "
            "a limit on turns");
    f("cell_height_m", cell_height_m)
        .unit("m")
        .greater_than(0)
        .doc("height of a cell; auto: half the climb of a leg at the limit");
    f("headings", headings).range(4, 128).doc("headings distinguished in a cell");
    f("weight_h", weight_h)
        .range(1, 100)
        .doc("weight of h: more finds a route sooner, up to that factor longer");
    f("max_memory_mb", max_memory_mb).unit("MB").at_least(1).doc("memory limit of the search");
  }
};

class HybridAstar final : public Planner {
 public:
  explicit HybridAstar(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const hybrid_astar::Settings settings = settings_for(request);
    return hybrid_astar::Search(request, settings).run();
  }

  hybrid_astar::Settings settings_for(const Request& request) const {
    const Vec3 extent = request.volume.max - request.volume.min;
    const double minimum = std::max(request.limits.min_turn_radius, 0.0);
    const double open = std::max({extent.x(), extent.y(), 1.0}) / 200;
    hybrid_astar::Settings settings;
    settings.cell_m =
        params_.cell_m.value.value_or(params_.radius_m.value ? *params_.radius_m.value / 2
                                      : minimum > 0          ? minimum / 2
                                                             : open);
    settings.radius =
        std::max(minimum, params_.radius_m.value.value_or(minimum > 0 ? minimum : settings.cell_m));
    const double slope = std::tan(std::min(request.limits.max_slope(), radians(45)));
    settings.cell_height =
        params_.cell_height_m.value.value_or(std::max(settings.cell_m * slope / 2, 1e-3));
    settings.headings = params_.headings;
    settings.weight_h = params_.weight_h;
    settings.max_bytes =
        std::min(std::size_t(params_.max_memory_mb) * 1024 * 1024, request.budget.max_memory_bytes);
    return settings;
  }

  Traits do_traits() const override {
    Traits traits;
    traits.loiters = true;
    traits.objectives = true;
    return traits;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "hybrid_astar", HybridAstar, Params,
                "Hybrid A*: curved legs between poses, searched by position, height and heading")
