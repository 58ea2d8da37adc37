// SPDX-License-Identifier: Apache-2.0
#include "ompl_planners.hpp"

#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/kit/sampling/leg_rules.hpp"
#include "measuring.hpp"

// NOLINTBEGIN(readability-identifier-naming): names of OMPL
namespace altiplan::bench {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Space = ob::RealVectorStateSpace;

Vec3 place(const ob::State* state) {
  const double* p = state->as<Space::StateType>()->values;
  return {p[0], p[1], p[2]};
}

class FreeCell : public ob::StateValidityChecker {
 public:
  FreeCell(const ob::SpaceInformationPtr& info, const VoxelGrid& grid)
      : StateValidityChecker(info), grid_(grid) {}
  bool isValid(const ob::State* state) const override {
    return !grid_.blocked(grid_.spec().cell_of(place(state)));
  }

 private:
  const VoxelGrid& grid_;
};

class FreeLeg : public ob::MotionValidator {
 public:
  FreeLeg(const ob::SpaceInformationPtr& info, const Request& request)
      : MotionValidator(info), rules_(request) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return rules_.ok(std::nullopt, place(a), place(b));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last) const override {
    last.second = 0;
    return checkMotion(a, b);
  }

 private:
  mutable kit::LegRules rules_;
};

template <class Planner>
ob::PlannerPtr planner_of(const ob::SpaceInformationPtr& info, double range) {
  auto planner = std::make_shared<Planner>(info);
  if constexpr (requires { planner->setRange(range); }) {
    if (range > 0) {
      planner->setRange(range);
    }
  }
  return planner;
}

ob::PlannerPtr planner_of(const std::string& name, const ob::SpaceInformationPtr& info,
                          double range) {
  return name == "RRTConnect"        ? planner_of<og::RRTConnect>(info, range)
         : name == "RRTstar"         ? planner_of<og::RRTstar>(info, range)
         : name == "InformedRRTstar" ? planner_of<og::InformedRRTstar>(info, range)
         : name == "BITstar"         ? planner_of<og::BITstar>(info, range)
                                     : throw Error("no planner of OMPL's is called " + name);
}
}  // namespace

struct OmplPlanner::Impl {
  std::shared_ptr<Space> space = std::make_shared<Space>(3);
  ob::SpaceInformationPtr info = std::make_shared<ob::SpaceInformation>(space);
  ob::PlannerPtr planner;
};

OmplPlanner::OmplPlanner(const std::string& planner, const Request& request, OmplCheck check,
                         double range)
    : impl_(std::make_unique<Impl>()) {
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  const Environment& layer = *request.world->layers().front().environment;
  const VoxelGrid& grid = static_cast<const kit::CellLayer&>(layer).cells();
  const Box box = grid.spec().box();
  ob::RealVectorBounds bounds(3);
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.setLow(axis, box.min[axis]);
    bounds.setHigh(axis, box.max[axis]);
  }
  impl_->space->setBounds(bounds);
  const ob::SpaceInformationPtr& info = impl_->info;
  info->setStateValidityChecker(std::make_shared<FreeCell>(info, grid));
  info->setStateValidityCheckingResolution(grid.spec().cell.minCoeff() /
                                           (box.max - box.min).norm());
  if (check == OmplCheck::legs) {
    info->setMotionValidator(std::make_shared<FreeLeg>(info, request));
  }
  info->setup();
  impl_->planner = planner_of(planner, info, range);
}

OmplPlanner::~OmplPlanner() = default;
OmplPlanner::OmplPlanner(OmplPlanner&&) noexcept = default;

OmplResult OmplPlanner::solve(const Request& request, double seconds, bool measure) {
  const auto problem = std::make_shared<ob::ProblemDefinition>(impl_->info);
  ob::ScopedState<Space> start(impl_->space);
  ob::ScopedState<Space> goal(impl_->space);
  for (unsigned axis = 0; axis < 3; ++axis) {
    start[axis] = request.start.position[int(axis)];
    goal[axis] = request.goal.position[int(axis)];
  }
  problem->setStartAndGoalStates(start, goal);
  problem->setOptimizationObjective(
      std::make_shared<ob::PathLengthOptimizationObjective>(impl_->info));
  impl_->planner->clear();
  impl_->planner->setProblemDefinition(problem);
  impl_->planner->setup();
  const double before = wall_s();
  const ob::PlannerStatus status =
      impl_->planner->solve(ob::timedPlannerTerminationCondition(seconds));
  OmplResult result;
  result.seconds = wall_s() - before;
  result.solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  if (measure) {
    ob::PlannerData data(impl_->info);
    impl_->planner->getPlannerData(data);
    result.nodes = data.numVertices();
    result.length = result.solved ? problem->getSolutionPath()->length() : kInfinity;
  }
  return result;
}
}  // namespace altiplan::bench
// NOLINTEND(readability-identifier-naming)
