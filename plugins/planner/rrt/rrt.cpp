// SPDX-License-Identifier: Apache-2.0
// Rapidly exploring random tree with a goal heuristic, flight constraints and a dynamic tree.
//
// Citation: paper 000: Gu Zilyu, Liu Yu, Sun Wenbang, Yue Guang, Sun Shangwen: UAV Dynamic Route
//   Planning Algorithm Based on RRT. Computer Science 50(6A), 2023. The basic tree: S. M. LaValle:
//   Rapidly-Exploring Random Trees: A New Tool for Path Planning. TR 98-11, Iowa State University,
//   1998.
// Guarantees: every leg satisfies the constraints; the absence of a route is never proved. Without
//   turn limits, and with random_share > 0, a route that consists of steps is found eventually.
//   Moving obstacles that are known beforehand are kept off in time; there are no waits.
// Complexity: O(n log n) for n nodes with weight_goal 0; with both weights the choice of a node
//   grows roughly as n^0.65.
// Deviations: eqs. (2) to (5) alone would generate the same child forever, so a node grows toward
//   the goal once, and rests after max_failures; when all nodes have rested, extensions are bent to
//   satisfy the limits on turn and climb. The last leg is up to two steps long. With cut_off:
//   reconnect the tree grows along a path past the threat (rrt_repair.hpp) and reconnects what was
//   cut off. With turns, nodes are poses, legs steps along Dubins paths to a pose
//   (pose_growth.hpp).
// Symbols: q_rand a random position, q_near the chosen node, w_1 weight_random, w_2 weight_goal, p
//   random_share, L step_m.
#include <memory>

#include "altiplan/kit/dubins/steering_params.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "pose_growth.hpp"
#include "rrt_session.hpp"

namespace {

using namespace altiplan;
using rrt::CutOff;
using rrt::Settings;

struct Params : kit::SteeringParams {
  AutoNumber step_m;
  double weight_random = 1;
  double weight_goal = 1;
  double random_share = 0.5;
  double goal_bias = 0;
  bool toward_goal_once = true;
  int max_failures = 50;
  int max_iterations = 100000;
  CutOff cut_off = CutOff::reconnect;

  void describe(Fields& f) {
    f("step_m", step_m)
        .unit("m")
        .at_least(0.001)
        .doc(
            "L, length of a leg; auto: a hundredth of the volume's diagonal, within the limits "
            "on leg length");
    f("weight_random", weight_random)
        .range(0, 1000)
        .doc("w_1: the node with the minimum w_1 |q - q_rand| + w_2 |q - goal| is extended");
    f("weight_goal", weight_goal).range(0, 1000).doc("w_2; 0 with w_1 = 1 is the basic tree");
    f("random_share", random_share)
        .range(0, 1)
        .doc("p: fraction of extensions toward q_rand, the others go toward the goal; 1: basic");
    f("goal_bias", goal_bias)
        .range(0, 1)
        .was("goal_share")
        .doc("probability of sampling the goal as q_rand");
    f("toward_goal_once", toward_goal_once).doc("extend a node toward the goal only once");
    f("max_failures", max_failures)
        .range(0, 60000)
        .doc("failed extensions after which a node rests until all others rest too; 0: never");
    f("max_iterations", max_iterations).at_least(1).doc("maximum number of extensions");
    f("cut_off", cut_off,
      {{"drop", CutOff::drop}, {"reconnect", CutOff::reconnect}, {"afresh", CutOff::afresh}})
        .doc(
            "branches that a change cuts off are removed (drop), or reconnected when the tree "
            "grows near them (reconnect); afresh removes the whole tree, for comparison");
    SteeringParams::describe(f);
    f.check(weight_random > 0 || weight_goal > 0, "one of weight_random, weight_goal must be > 0");
  }

  Settings settings(const Request& request) const {
    const Vec3 size = request.volume.max - request.volume.min;
    Settings settings;
    settings.step = step_m.value.value_or(
        std::max(request.limits.min_leg, std::min(request.limits.max_leg, size.norm() / 100)));
    settings.w_random = weight_random;
    settings.w_goal = weight_goal;
    settings.goal_bias = goal_bias;
    settings.random_share = random_share;
    settings.goal_once = toward_goal_once;
    settings.max_failures = max_failures;
    settings.max_iterations = std::uint64_t(max_iterations);
    return settings;
  }
};

class Rrt final : public Planner {
 public:
  explicit Rrt(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const auto tree = trees_.take();
    tree->clear(request.trace);
    RandomStream random = request.random.sub("growth");
    const double turn_radius = params_.turn_radius(request);
    if (auto refused = kit::unsolvable(request, turn_radius)) {
      return *refused;
    }
    Settings settings = params_.settings(request);
    if (turn_radius > 0) {
      settings.step = params_.step_m.value.value_or(std::max(settings.step, turn_radius));
      return rrt::PoseGrowth(settings, turn_radius, request, *tree).run(random);
    }
    rrt::Growth growth(settings, request, *tree);
    growth.set_root(tree->add(request.start.position, rrt::kNone));
    growth.start();
    return growth.run({}, random);
  }

  std::unique_ptr<Session> do_begin(const Request& request) const override {
    if (params_.turn_radius(request) > 0 || avoids_moving(request)) {
      return Planner::do_begin(request);  // trees of poses, and in time, do not persist
    }
    return std::make_unique<rrt::TreeSession>(params_.settings(request), params_.cut_off, request);
  }

  Traits do_traits() const override {
    Traits traits;
    traits.incremental =
        params_.cut_off != CutOff::afresh && params_.steering != kit::SteeringParams::Kind::dubins;
    traits.loiters = params_.loiters();
    return traits;
  }

  Params params_;
  mutable kit::ScratchPool<rrt::Tree> trees_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "rrt", Rrt, Params,
                "RRT with a goal heuristic under flight constraints and a tree that persists "
                "between plans")
