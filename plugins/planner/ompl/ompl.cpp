// SPDX-License-Identifier: Apache-2.0
// The geometric planners of OMPL in our world.
//
// Citation: I. A. Sucan, M. Moll, L. E. Kavraki: The Open Motion Planning Library. IEEE Robotics &
//   Automation Magazine 19(4), 2012, 72-82, doi:10.1109/MRA.2012.2205651. Each planner's own paper
//   is named on OMPL's pages.
// Guarantees: a returned route satisfies every constraint. Constraints on two consecutive legs
//   (turns, the heading at the start) are satisfied only by chance: OMPL checks single legs.
// Complexity: that of the selected planner.
// Deviations: PRM and PRM* alternate between extending the roadmap and searching for a path, rather
//   than using a second thread (ompl_planners.hpp). Motions are checked exactly, not sampled. No
//   simplification: that is a smoother's work.
// Symbols: as in OMPL; a state is a point, a motion a leg.
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <charconv>
#include <chrono>
#include <mutex>
#include <thread>

#include "altiplan/error.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "ompl_planners.hpp"
#include "ompl_world.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::ompl_planner;

/// Exclusive access to OMPL: its seeds of new random number generators and its console belong to
/// the whole process.
class Turn {
 public:
  /// Waits until no other plan has it, or the budget of queries is spent.
  explicit Turn(Questions& questions) {
    while (!mine_.try_lock() && !questions.spent()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (mine_) {
      ompl::msg::noOutputHandler();
    }
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() {
    if (mine_) {
      ompl::msg::restorePreviousOutputHandler();
    }
  }
  explicit operator bool() const { return bool(mine_); }

 private:
  static inline std::mutex one_at_a_time;
  std::unique_lock<std::mutex> mine_{one_at_a_time, std::defer_lock};
};

struct Params {
  MakePlanner planner = make_planner<og::RRTConnect>;
  AutoNumber range_m;
  Value parameters;
  std::int64_t max_iterations = 100'000;

  Params() { parameters.kind = Value::Kind::map; }
  void describe(Fields& f) {
    f("planner", planner,
      {{"ABITstar", make_planner<og::ABITstar>},
       {"AITstar", make_planner<og::AITstar>},
       {"BFMT", make_planner<og::BFMT>},
       {"BITstar", make_planner<og::BITstar>},
       {"BKPIECE1", make_planner<og::BKPIECE1>},
       {"BiEST", make_planner<og::BiEST>},
       {"BiTRRT", make_planner<og::BiTRRT>},
       {"EST", make_planner<og::EST>},
       {"FMT", make_planner<og::FMT>},
       {"InformedRRTstar", make_planner<og::InformedRRTstar>},
       {"KPIECE1", make_planner<og::KPIECE1>},
       {"LBKPIECE1", make_planner<og::LBKPIECE1>},
       {"LazyPRM", make_planner<og::LazyPRM>},
       {"LazyRRT", make_planner<og::LazyRRT>},
       {"PDST", make_planner<og::PDST>},
       {"PRM", make_planner<RoadMap<false>>},
       {"PRMstar", make_planner<RoadMap<true>>},
       {"ProjEST", make_planner<og::ProjEST>},
       {"RRT", make_planner<og::RRT>},
       {"RRTConnect", make_planner<og::RRTConnect>},
       {"RRTXstatic", make_planner<og::RRTXstatic>},
       {"RRTsharp", make_planner<og::RRTsharp>},
       {"RRTstar", make_planner<og::RRTstar>},
       {"SBL", make_planner<og::SBL>},
       {"SORRTstar", make_planner<og::SORRTstar>},
       {"STRIDE", make_planner<og::STRIDE>},
       {"TRRT", make_planner<og::TRRT>}})
        .doc("OMPL's name of the planner");
    f("range_m", range_m)
        .unit("m")
        .greater_than(0)
        .doc("maximum extension of the planner's tree, its parameter range; auto: OMPL's default");
    f("parameters", parameters)
        .doc("the planner's other parameters: a map from their OMPL names to values");
    f("max_iterations", max_iterations)
        .at_least(1)
        .doc(
            "maximum number of queries by the planner; one that keeps improving its route stops "
            "there");
    const std::string wrong = f.reading() ? problem() : "";
    f.check(wrong.empty(), wrong);
  }

  /// Sets the parameters on a planner; returns what is wrong with them, or "".
  std::string apply(ob::Planner& to) const {
    if (range_m.value) {
      char text[32];  // not printf: a locale may write decimals with a comma
      const char* end = std::to_chars(text, text + sizeof text, *range_m.value).ptr;
      if (!set(to, "range", std::string(text, std::size_t(end - text)))) {
        return "range_m: " + to.getName() + " has no range";
      }
    }
    for (const Value::Entry& entry : parameters.entries) {
      const std::string name = "parameters." + entry.key + ": ";
      const std::string& text = entry.value.text;
      if (!to.params().hasParam(entry.key)) {
        return name + to.getName() + " has no such parameter, it has " + names(to);
      }
      // OMPL represents booleans as 1 and 0.
      const bool scalar = entry.value.kind == Value::Kind::scalar;
      const std::string read = text == "true" ? "1" : text == "false" ? "0" : text;
      if (!scalar || !set(to, entry.key, read)) {
        return name + "OMPL does not accept " + entry.value.what();
      }
    }
    return "";
  }

 private:
  std::string problem() const {
    if (parameters.kind != Value::Kind::map) {
      return "parameters: expected a map, found " + parameters.what();
    }
    const Budget unlimited;
    Questions none(unlimited, 1);
    const Turn turn(none);
    const auto info =
        std::make_shared<ob::SpaceInformation>(std::make_shared<ob::RealVectorStateSpace>(2));
    return apply(*planner(info));
  }
  static bool set(ob::Planner& of, const std::string& key, const std::string& text) {
    try {
      return of.params().hasParam(key) && of.params().setParam(key, text);
    } catch (const std::exception&) {
      return false;
    }
  }
  static std::string names(ob::Planner& of) {
    std::vector<std::string> all;
    of.params().getParamNames(all);
    std::string text;
    for (const std::string& name : all) {
      text += (text.empty() ? "" : ", ") + name;
    }
    return text.empty() ? "none" : text;
  }
};

class Ompl final : public Planner {
 public:
  explicit Ompl(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const Axes axes(request);
    if (axes.count() < 2) {
      PlanResult result;
      result.status = PlanStatus::invalid_problem;
      result.message =
          "OMPL plans in 2-D or 3-D, but this volume extends along fewer than two "
          "axes";
      return result;
    }
    Questions questions(request.budget, std::uint64_t(params_.max_iterations));
    const Turn turn(questions);
    if (!turn) {
      return without_route(questions, "another plan used OMPL until the time limit");
    }
    RandomStream seeds = request.random.sub("ompl");
    ompl::RNG::setSeed(std::uint_fast32_t(seeds.integer(1, 1'000'000'000)));
    const ob::SpaceInformationPtr info = world(request, axes, questions);
    const auto problem = std::make_shared<ob::ProblemDefinition>(info);
    ob::ScopedState<> start(info);
    ob::ScopedState<> goal(info);
    axes.write(request.start.position, start.get());
    axes.write(request.goal.position, goal.get());
    problem->setStartAndGoalStates(start, goal,
                                   std::max(request.goal.tolerance_m, kLengthTolerance));
    const ob::PlannerPtr planner = params_.planner(info);
    params_.apply(*planner);
    planner->setProblemDefinition(problem);
    planner->setup();
    planner->solve(ob::PlannerTerminationCondition([&] { return !questions.take(); }));
    if (!problem->hasExactSolution()) {
      return without_route(questions, planner->getName() + " found no route after " +
                                          std::to_string(questions.asked()) + " queries");
    }
    return judged(route_of(*problem, axes, request), request, questions, planner->getName());
  }

  static ob::SpaceInformationPtr world(const Request& request, const Axes& axes,
                                       Questions& questions) {
    const auto space = std::make_shared<Space>(axes.count());
    space->setBounds(axes.bounds(request));
    const auto info = std::make_shared<ob::SpaceInformation>(space);
    info->setStateValidityChecker(std::make_shared<FreeStates>(info, axes, request, questions));
    info->setMotionValidator(std::make_shared<FreeLegs>(info, axes, request, questions));
    info->setup();
    return info;
  }

  static Polyline route_of(const ob::ProblemDefinition& problem, const Axes& axes,
                           const Request& request) {
    const auto& path = dynamic_cast<og::PathGeometric&>(*problem.getSolutionPath());
    Polyline route;
    for (std::size_t i = 0; i < path.getStateCount(); ++i) {
      route.push_back(axes.point(path.getState(unsigned(i))));
    }
    route.front() = request.start.position;
    if ((route.back() - request.goal.position).norm() <= 2 * kLengthTolerance) {
      route.back() = request.goal.position;  // an axis without extent holds start and goal
    }
    return without_repeats(route);
  }

  /// Constraints on two consecutive legs and on whole routes are checked last.
  static PlanResult judged(Polyline route, const Request& request, const Questions& questions,
                           const std::string& planner) {
    const std::vector<Violation> broken = check(route, request).violations;
    if (!broken.empty()) {
      return without_route(questions, "the route found by " + planner +
                                          " violates a constraint that OMPL cannot check, " +
                                          broken.front().constraint + " at waypoint " +
                                          std::to_string(broken.front().at) + ": " +
                                          broken.front().message);
    }
    PlanResult result;
    result.status = PlanStatus::solved;
    result.budget_hit = questions.budget_spent();
    result.message = planner + ": " + std::to_string(route.size()) + " waypoints after " +
                     std::to_string(questions.asked()) + " queries";
    result.counters = questions.counters();
    result.route = std::move(route);
    return result;
  }

  static PlanResult without_route(const Questions& questions, const std::string& message) {
    PlanResult result;
    result.status = questions.cancelled()      ? PlanStatus::cancelled
                    : questions.budget_spent() ? PlanStatus::timed_out
                                               : PlanStatus::no_route;
    result.budget_hit = result.status == PlanStatus::timed_out;
    result.counters = questions.counters();
    result.message = message;
    return result;
  }

  Traits do_traits() const override { return {}; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "ompl", Ompl, Params,
                "a geometric planner of the Open Motion Planning Library, selected by name")
