// SPDX-License-Identifier: Apache-2.0
// Rapidly exploring random tree with a goal heuristic, flight constraints and a dynamic tree.
//
// Citation: paper 000: Gu Zilyu, Liu Yu, Sun Wenbang, Yue Guang, Sun Shangwen: UAV Dynamic Route
//   Planning Algorithm Based on RRT. Computer Science 50(6A), 2023. The basic tree: S. M. LaValle:
//   Rapidly-Exploring Random Trees: A New Tool for Path Planning. TR 98-11, Iowa State University,
//   1998.
// Guarantees: every leg keeps the rules; no route is ever proved absent. Without limits on turns,
//   and with random_share > 0, a route that steps can make is found sooner or later.
// Complexity: O(n log n) for n nodes with weight_goal 0; with both weights the choice of a node
//   grows about as n^0.65.
// Deviations: eqs. (2) to (5) alone make the same child for ever, so a node grows toward the goal
//   once, and rests after max_failures; when all have rested, extensions are bent to the limits
//   on turn and climb. The last leg is up to two steps long. With cut_off: reconnect the tree
//   grows along a way past the threat (rrt_repair.hpp), and takes back what was cut off.
// Symbols: q_rand a random place, q_near the chosen node, w_1 weight_random, w_2 weight_goal,
//   p random_share, L step_m.
#include <memory>

#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "rrt_session.hpp"

namespace {

using namespace altiplan;
using rrt::CutOff;
using rrt::Settings;

struct Params {
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
            "L, length of a leg; auto: a hundredth of the volume's diagonal, within the limits on "
            "legs");
    f("weight_random", weight_random)
        .range(0, 1000)
        .doc("w_1: the node with the least w_1 |q - q_rand| + w_2 |q - goal| is extended");
    f("weight_goal", weight_goal).range(0, 1000).doc("w_2; 0 with w_1 = 1 is the basic tree");
    f("random_share", random_share)
        .range(0, 1)
        .doc("p: share of extensions toward q_rand, the others go toward the goal; 1: basic");
    f("goal_bias", goal_bias).range(0, 1).doc("share of the samples q_rand that are the goal");
    f("toward_goal_once", toward_goal_once)
        .doc("whether a node is extended toward the goal only once");
    f("max_failures", max_failures)
        .range(0, 60000)
        .doc("failed extensions after which a node rests until all others do; 0: never");
    f("max_iterations", max_iterations).at_least(1).doc("extensions tried before it gives up");
    f("cut_off", cut_off,
      {{"drop", CutOff::drop}, {"reconnect", CutOff::reconnect}, {"afresh", CutOff::afresh}})
        .doc(
            "what becomes of branches that a change cuts off: they are forgotten (drop), or taken "
            "back where the tree comes by (reconnect); afresh forgets the whole tree, to compare");
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
    rrt::Growth growth(params_.settings(request), request, *tree);
    growth.set_root(tree->add(request.start.position, rrt::kNone));
    growth.start();
    RandomStream random = request.random.sub("growth");
    return growth.run({}, random);
  }

  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return std::make_unique<rrt::TreeSession>(params_.settings(request), params_.cut_off, request);
  }

  Traits do_traits() const override {
    Traits traits;
    traits.incremental = params_.cut_off != CutOff::afresh;
    return traits;
  }

  Params params_;
  mutable kit::ScratchPool<rrt::Tree> trees_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "rrt", Rrt, Params,
                "RRT with a goal heuristic under flight constraints, and a tree that lives on")
