// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/population/population.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "../crew.hpp"
#include "altiplan/check.hpp"
#include "altiplan/kit/sampling/leg_rules.hpp"

namespace altiplan::kit {
namespace {

/// Evaluations between two looks at the clock and the stop token.
constexpr std::size_t kPart = 256;
/// Pieces into which a refused leg is cut, to tell how much of it is refused.
constexpr int kPieces = 4;
/// Violation of a route of which each leg is feasible, but not the whole.
constexpr double kOfWhole = 1e-3;
}  // namespace

void PopulationParams::describe(Fields& f) {
  RouteSpaceParams::describe(f);
  f("evaluations", evaluations)
      .range(1, 1'000'000'000)
      .doc("number of routes that are evaluated, if the budget allows");
  f("rule", rule, {{"judge", Rule::judge}, {"objective", Rule::objective}})
      .doc(
          "what makes a route infeasible: the judge's constraints, or only an infinite cost, as in "
          "papers, whose routes the judge may then reject");
}

/// Evaluates on several threads.
class Population::Evaluator {
 public:
  explicit Evaluator(const Population& of)
      : of_(of),
        request_(of.request_),
        params_(of.params_),
        crew_(std::size_t(std::max(request_.threads, 1))) {
    for (int n = 0; n < std::max(request_.threads, 1); ++n) {
      rules_.push_back(std::make_unique<LegRules>(request_));
    }
  }

  void evaluate(std::span<Member* const> part) {
    std::atomic<std::size_t> next{0};
    crew_.all_do([&](std::size_t thread) {
      for (std::size_t n = next++; n < part.size(); n = next++) {
        part[n]->score = score_of(part[n]->x, *rules_[thread]);
      }
    });
  }

 private:
  Score score_of(const Position& x, LegRules& rules) const {
    const Route route = of_.route_of(x);
    Score score;
    score.violation = legs_violation(route, rules) + length_violation(route);
    score.terms = request_.objective ? request_.objective->costs(route, request_)
                                     : std::vector<double>{length(route)};
    score.cost = std::accumulate(score.terms.begin(), score.terms.end(), 0.0);
    if (!std::isfinite(score.cost) && score.violation == 0) {
      score.violation = kOfWhole;
    }
    return score;
  }

  double length_violation(const Route& route) const {
    const double beyond = length(route) - request_.limits.max_route_length - kLengthTolerance;
    return params_.rule == Rule::judge && beyond > 0 ? beyond / request_.limits.max_route_length
                                                     : 0;
  }

  /// Number of refused legs, each weighed by the share of its pieces that are refused.
  double legs_violation(const Route& route, LegRules& rules) const {
    double sum = 0;
    std::optional<Approach> before = request_.before_start(route.front());
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      const Leg leg = route.leg(i);
      if (!is_ok(before, leg, rules)) {
        int refused = 0;
        for (int k = 0; k < kPieces; ++k) {
          refused += is_ok(std::nullopt, leg.piece(double(k) / kPieces, (k + 1.0) / kPieces), rules)
                         ? 0
                         : 1;
        }
        sum += std::max(refused, 1) / double(kPieces);
      }
      before = onward(before, leg);
    }
    return sum;
  }

  bool is_ok(const std::optional<Approach>& before, const Leg& leg, LegRules& rules) const {
    return (!request_.objective || std::isfinite(cost_of(leg, request_))) &&
           (params_.rule == Rule::objective || rules.ok(before, leg.from, leg.to));
  }

  const Population& of_;
  const Request& request_;
  const PopulationParams& params_;
  std::vector<std::unique_ptr<LegRules>> rules_;
  Crew crew_;
};

Population::Population(const Request& request, const PopulationParams& params)
    : request_(request),
      params_(params),
      space_(request, params),
      evaluator_(std::make_unique<Evaluator>(*this)) {}

Population::~Population() = default;

/// Points of no distance have no heading to turn from: they are left out, but where the cost of the
/// waypoints is all that counts, as in papers.
Route Population::route_of(const Position& x) const {
  Polyline points = space_.route(x);
  return params_.rule == Rule::judge ? without_repeats(points) : std::move(points);
}

std::vector<Member> Population::draw(std::size_t count) const {
  RandomStream random = request_.random.sub("draw");
  std::vector<Member> members(count);
  for (Member& member : members) {
    member.x.resize(dimensions());
    std::generate(member.x.begin(), member.x.end(), [&] { return random.uniform(); });
  }
  return members;
}

bool Population::evaluate_all(const std::vector<Member*>& batch) {
  for (Member* member : batch) {
    member->score = {};
  }
  bool goes_on = true;
  for (std::size_t n = 0; n < batch.size() && goes_on; n += kPart) {
    goes_on = evaluate_part(std::span(batch).subspan(n, std::min(kPart, batch.size() - n)));
  }
  note_batch(batch);
  return goes_on && evaluations_left() > 0;
}

/// False if the evaluations, or the budget, did not suffice for all.
bool Population::evaluate_part(std::span<Member* const> part) {
  const Budget& budget = request_.budget;
  cancelled_ = budget.stop.stop_requested();
  if (cancelled_ || (budget.deadline && Budget::Clock::now() >= *budget.deadline)) {
    budget_hit_ = true;
    return false;
  }
  const std::uint64_t left =
      std::min(std::uint64_t(params_.evaluations), budget.max_iterations) - evaluated_;
  budget_hit_ = left < part.size() && budget.max_iterations < std::uint64_t(params_.evaluations);
  const std::size_t count = std::size_t(std::min<std::uint64_t>(left, part.size()));
  evaluator_->evaluate(part.first(count));
  evaluated_ += count;
  budget.show_expanded(evaluated_, 0);
  for (Member* member : part.first(count)) {
    keep_best(*member);
  }
  return count == part.size();
}

/// The judge sees each route before it is the best: constraints that look at a whole route are in
/// no leg's violation.
void Population::keep_best(Member& member) {
  if (!better(member.score, best_.score)) {
    return;
  }
  if (member.score.is_feasible() && params_.rule == Rule::judge &&
      !check(route_of(member.x), request_).ok()) {
    member.score.violation = kOfWhole;
    if (!better(member.score, best_.score)) {
      return;
    }
  }
  best_ = member;
  if (best_.score.is_feasible()) {
    request_.budget.show_best(best_.score.cost);
  }
}

void Population::note_batch(const std::vector<Member*>& batch) {
  ++batches_;
  request_.budget.show_iteration(std::uint64_t(batches_));
  if (request_.trace == nullptr) {
    return;
  }
  TraceEvent event{TraceEvent::Kind::iteration, batches_, -1, request_.goal.position,
                   best_.score.is_feasible() ? best_.score.cost : kInfinity};
  event.alive = 0;
  for (const Member* member : batch) {
    if (member->score.is_feasible()) {
      ++event.alive;
      event.mean += member->score.cost;
    }
  }
  event.mean = event.alive > 0 ? event.mean / double(event.alive) : kInfinity;
  request_.trace->add(event);
}

PlanResult Population::result() const {
  PlanResult result;
  result.counters = {{"expanded", std::int64_t(evaluated_)}, {"iterations", batches_}};
  result.budget_hit = budget_hit_;
  if (best_.score.is_feasible()) {
    result.status = PlanStatus::solved;
    result.route = route_of(best_.x);
    return result;
  }
  result.status = cancelled_    ? PlanStatus::cancelled
                  : budget_hit_ ? PlanStatus::timed_out
                                : PlanStatus::no_route;
  result.message = "none of " + std::to_string(evaluated_) + " routes of " +
                   std::to_string(params_.waypoints) + " waypoints is feasible";
  return result;
}

PlanResult PopulationPlanner::do_plan(const Request& request) const {
  Population population(request, params_);
  search(population);
  return population.result();
}

Traits PopulationPlanner::do_traits() const {
  Traits traits;
  traits.anytime = true;
  traits.objectives = true;
  traits.whole_routes = true;
  return traits;
}
}  // namespace altiplan::kit
