// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/kit/population/route_space.hpp"
#include "altiplan/planner.hpp"

/// \file Common parts of planners that improve a population of whole routes: encoding, evaluation,
/// comparison, budget. docs/interfaces/kit.md has a planner with them.
namespace altiplan::kit {

/// Whose word makes a route infeasible.
enum class Rule { judge, objective };

struct ALTIPLAN_API PopulationParams : RouteSpaceParams {
  int evaluations = 5'000;
  Rule rule = Rule::judge;

  void describe(Fields& f);
};

/// What an individual is worth.
struct Score {
  double violation = kInfinity;  ///< 0: feasible; infinite: not evaluated
  double cost = kInfinity;
  std::vector<double> terms{};  ///< of the objective; without one the length

  bool is_feasible() const { return violation == 0; }
};

/// The rules of feasibility: a feasible route is better than one that is not, of two feasible ones
/// the one that costs less, else the one that violates less. K. Deb: An efficient constraint
/// handling method for genetic algorithms. Computer Methods in Applied Mechanics and Engineering
/// 186, 2000, doi:10.1016/S0045-7825(99)00389-8.
inline bool better(const Score& a, const Score& b) {
  return a.is_feasible() && b.is_feasible() ? a.cost < b.cost : a.violation < b.violation;
}

struct Member {
  Position x;  ///< in [0, 1]; one number for each dimension
  Score score{};
};

/// The individuals of one plan, and the best of all that were evaluated. An iteration of the budget
/// is an evaluation. The result does not depend on the number of threads: a batch is evaluated in
/// parallel, and compared in order.
class ALTIPLAN_API Population {
 public:
  /// Both must outlive this object.
  Population(const Request& request, const PopulationParams& params);
  ~Population();
  Population(const Population&) = delete;
  Population& operator=(const Population&) = delete;

  std::size_t dimensions() const { return space_.dimensions(); }
  /// Numbers for one use ("mutation"); streams of different uses are independent.
  RandomStream random(std::string_view use) const { return request_.random.sub(use); }
  /// Members at random, not evaluated.
  std::vector<Member> draw(std::size_t count) const;

  /// Scores a batch of members, or of what derives from them. False if that was the last: of the
  /// evaluations or of the request's budget; members beyond them are worse than all others.
  template <class Individual>
  bool evaluate(std::vector<Individual>& batch) {
    std::vector<Member*> members;
    members.reserve(batch.size());
    for (Individual& one : batch) {
      members.push_back(&one);
    }
    return evaluate_all(members);
  }
  const Member& best() const { return best_; }
  int evaluations_left() const { return params_.evaluations - int(evaluated_); }

  PlanResult result() const;

 private:
  class Evaluator;
  bool evaluate_all(const std::vector<Member*>& batch);
  bool evaluate_part(std::span<Member* const> part);
  void keep_best(Member& member);
  Route route_of(const Position& x) const;
  void note_batch(const std::vector<Member*>& batch);

  const Request& request_;
  const PopulationParams& params_;
  RouteSpace space_;
  std::unique_ptr<Evaluator> evaluator_;
  Member best_;
  std::uint64_t evaluated_ = 0;
  std::int64_t batches_ = 0;
  bool budget_hit_ = false;
  bool cancelled_ = false;
};

/// A planner that searches by a population.
class ALTIPLAN_API PopulationPlanner : public Planner {
 protected:
  /// `params` must outlive the planner.
  explicit PopulationPlanner(const PopulationParams& params) : params_(params) {}

 private:
  /// Evaluates batches until the population says that the last one was.
  virtual void search(Population& population) const = 0;
  PlanResult do_plan(const Request& request) const final;
  Traits do_traits() const final;

  const PopulationParams& params_;
};
}  // namespace altiplan::kit
