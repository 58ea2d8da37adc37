// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/est/ProjEST.h>
#include <ompl/geometric/planners/fmt/BFMT.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/AITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/pdst/PDST.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/BiTRRT.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/LazyRRT.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTXstatic.h>
#include <ompl/geometric/planners/rrt/RRTsharp.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/geometric/planners/rrt/SORRTstar.h>
#include <ompl/geometric/planners/rrt/TRRT.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <ompl/geometric/planners/stride/STRIDE.h>

#include <memory>

namespace altiplan::ompl_planner {
namespace ob = ompl::base;
namespace og = ompl::geometric;

/// PRM and PRM*. OMPL's own versions search for a path in a second thread, and switch from growing
/// the roadmap to expanding it by the clock: the same seed would not give the same route. Here
/// these phases alternate in counted turns.
template <bool kStar>
class RoadMap final : public og::PRM {
 public:
  explicit RoadMap(const ob::SpaceInformationPtr& info) : PRM(info, kStar) {}

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& spent) override {
    checkValidity();
    startM_ = {addMilestone(si_->cloneState(pis_.nextStart()))};
    goalM_ = {addMilestone(si_->cloneState(pis_.nextGoal()))};
    bestCost_ = opt_->infiniteCost();
    ob::PathPtr path;
    bool satisfied = false;
    for (bool grow = true; !satisfied && !spent; grow = !grow) {
      int left = grow ? 2 * kTurn : kTurn;
      const ob::PlannerTerminationCondition turn_ends([&] { return left-- <= 0 || spent(); });
      grow ? growRoadmap(turn_ends) : expandRoadmap(turn_ends);
      satisfied = maybeConstructSolution(startM_, goalM_, path);
    }
    if (!path) {
      return ob::PlannerStatus::TIMEOUT;
    }
    pdef_->addSolutionPath(path);
    return ob::PlannerStatus::EXACT_SOLUTION;
  }

 private:
  static constexpr int kTurn = 20;  ///< OMPL's termination queries per turn
};

using MakePlanner = ob::PlannerPtr (*)(const ob::SpaceInformationPtr&);

template <class Planner>
ob::PlannerPtr make_planner(const ob::SpaceInformationPtr& info) {
  return std::make_shared<Planner>(info);
}
}  // namespace altiplan::ompl_planner
