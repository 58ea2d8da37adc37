// SPDX-License-Identifier: Apache-2.0
#include "ompl_star.hpp"

#include <ompl/base/PlannerData.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>

#include "altiplan/error.hpp"

namespace altiplan::bench {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Space = ob::DubinsStateSpace;

bool is_free(const DiscProblem& problem, const ob::State* state) {
  const auto* at = state->as<Space::StateType>();
  return std::none_of(problem.discs.begin(), problem.discs.end(), [&](const Disc& disc) {
    const double x = at->getX() - disc.x;
    const double y = at->getY() - disc.y;
    return x * x + y * y < disc.radius * disc.radius;
  });
}

ob::ScopedState<Space> state_of(const std::shared_ptr<Space>& space, const Pose& pose) {
  ob::ScopedState<Space> state(space);
  state->setXY(pose.position.x(), pose.position.y());
  state->setYaw(pose.heading);
  return state;
}

OmplStarResult solve(const DiscProblem& problem, double range, double goal_bias, double seconds) {
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  const auto space = std::make_shared<Space>(problem.turn_radius);
  ob::RealVectorBounds bounds(2);
  bounds.setLow(-problem.half_edge);
  bounds.setHigh(problem.half_edge);
  space->setBounds(bounds);
  const auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker([&](const ob::State* state) {
    return info->satisfiesBounds(state) && is_free(problem, state);
  });
  info->setup();
  const auto definition = std::make_shared<ob::ProblemDefinition>(info);
  definition->setStartAndGoalStates(state_of(space, problem.start), state_of(space, problem.goal));
  definition->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(info));
  og::RRTstar planner(info);
  planner.setRange(range);
  planner.setGoalBias(goal_bias);
  planner.setProblemDefinition(definition);
  planner.setup();
  const ob::PlannerStatus status = planner.solve(ob::timedPlannerTerminationCondition(seconds));
  ob::PlannerData data(info);
  planner.getPlannerData(data);
  OmplStarResult result;
  result.nodes = data.numVertices();
  result.solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  result.length = result.solved ? definition->getSolutionPath()->length()
                                : std::numeric_limits<double>::infinity();
  return result;
}
}  // namespace

OmplStarResult ompl_dubins_star(const DiscProblem& problem, double range, double goal_bias,
                                double seconds) {
  OmplStarResult result;
  for (int tries = 0; tries < 5 && result.nodes == 0; ++tries) {
    const ompl::RNG next_seed;
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
      throw Error("no pipe for the process of OMPL's planner");
    }
    const pid_t child = fork();
    if (child == 0) {
      const OmplStarResult its = solve(problem, range, goal_bias, seconds);
      _exit(write(ends[1], &its, sizeof its) == sizeof its ? 0 : 1);
    }
    close(ends[1]);
    if (child < 0 || read(ends[0], &result, sizeof result) != sizeof result) {
      result = {};
    }
    close(ends[0]);
    waitpid(child, nullptr, 0);
  }
  return result;
}
}  // namespace altiplan::bench
