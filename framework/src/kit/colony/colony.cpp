// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/colony/colony.hpp"

#include <algorithm>
#include <cmath>

#include "../crew.hpp"
#include "altiplan/check.hpp"

namespace altiplan::kit {
namespace {

/// Routes per iteration in a trace: enough to show what the colony does; all of them would make
/// files of hundreds of megabytes.
constexpr std::size_t kTracedAnts = 10;
}  // namespace

void ColonyParams::describe(Fields& f) {
  describe_cell(f);
  f("ants", ants).range(1, 1'000'000).doc("number of ants in the colony");
  f("iterations", iterations)
      .range(1, 1'000'000)
      .doc(
          "number of iterations, in each of which every ant walks once; all are run if the budget "
          "allows");
  f("deposit_q", deposit_q)
      .range(1e-9, 1e9)
      .doc(
          "Q of eq. (2): an ant deposits Q divided by the metres of its route, or by its cost in "
          "metres that cost the same on the first routes");
  f("initial_pheromone", initial_pheromone).range(1e-9, 1e9).doc("initial tau everywhere");
  f("alpha", alpha).range(0, 20).doc("exponent of the pheromone in eq. (1)");
  f("beta", beta).range(0, 20).doc("exponent of the heuristic in eq. (1)");
  f("evaporation", evaporation)
      .range(0, 1)
      .doc("rho of eq. (4): fraction of the pheromone that evaporates in each iteration");
  f("max_length_m", max_length_m)
      .unit("m")
      .greater_than(0)
      .doc("maximum length of an ant's walk; auto: three times the volume's length and width");
  describe_memory(f);
}

Colony::Colony(const Request& request, const ColonyParams& params, const Lattice& lattice)
    : request_(request),
      params_(params),
      lattice_(lattice),
      grid_(occupancy(request, lattice)),
      cells_decide_(MoveRules::cells_decide(request) && request.limits.min_leg == 0 &&
                    request.limits.max_leg == kInfinity &&
                    request.wind.max_speed() < request.air_speed()) {
  const Vec3 size = lattice.spec().box().max - lattice.spec().box().min;
  longest_ = std::min(params.max_length_m.value.value_or(3 * (size.x() + size.y())),
                      request.limits.max_route_length);
  join_ends();
}

Colony::~Colony() = default;

void Colony::join_ends() {
  const auto nearest_free = [&](const Vec3& end, const auto& leg_kept) {
    std::optional<Lattice::Link> nearest;
    for (const Lattice::Link& link : lattice_.links(end)) {
      if (!grid_->blocked(link.cell) && (!nearest || link.length < nearest->length) &&
          (link.length == 0 || leg_kept(lattice_.position(link.cell)))) {
        nearest = link;
      }
    }
    return nearest;
  };
  const Vec3& start = request_.start.position;
  const Vec3& goal = request_.goal.position;
  const auto from = nearest_free(
      start, [&](const Vec3& p) { return leg_ok(request_.before_start(), start, p, request_); });
  const auto to =
      nearest_free(goal, [&](const Vec3& p) { return leg_ok(std::nullopt, p, goal, request_); });
  if (from) {
    start_ = lattice_.index(from->cell);
    start_link_ = from->length;
  }
  if (to) {
    goal_ = lattice_.index(to->cell);
    goal_link_ = to->length;
  }
}

std::optional<PlanResult> Colony::without_ants() {
  PlanResult result;
  result.counters = {{"expanded", 0}};
  if (start_ == kNone || goal_ == kNone) {
    result.status = PlanStatus::no_route;
    result.message = std::string("no route: ") + (start_ == kNone ? "the start" : "the goal") +
                     " has no free cell beside it to join the lattice";
    return result;
  }
  if (start_ != goal_) {
    return std::nullopt;
  }
  const Vec3& start = request_.start.position;
  const Vec3& goal = request_.goal.position;
  const bool straight =
      (goal - start).norm() <= request_.limits.max_route_length + kLengthTolerance &&
      leg_ok(request_.before_start(), start, goal, request_) &&
      std::isfinite(cost_of(Leg::straight(start, goal), request_));
  result.status = straight ? PlanStatus::solved : PlanStatus::no_route;
  result.message = straight ? "start and goal share a cell: the straight leg"
                            : "no route: start and goal share a cell, and the straight leg "
                              "between them violates a constraint";
  result.route = straight ? Polyline{start, goal} : Polyline{};
  return result;
}

PlanResult Colony::run() {
  if (auto told = without_ants()) {
    return *std::move(told);
  }
  ants_.resize(std::size_t(params_.ants));
  const std::size_t size = std::min(std::size_t(std::max(request_.threads, 1)), ants_.size());
  walkers_.reserve(size);
  for (std::size_t n = 0; n < size; ++n) {
    walkers_.emplace_back(request_, lattice_);
    walkers_.back().visited.reset(lattice_.spec().counts[0], lattice_.size());
  }
  Crew crew(size);
  for (int n = 0; n < params_.iterations; ++n) {
    if (!send_out(crew, std::size_t(n))) {
      break;
    }
    lay_all();
  }
  return result();
}

/// One iteration; false if a budget ended it.
bool Colony::send_out(Crew& crew, std::size_t iteration) {
  max_steps_ = request_.budget.max_iterations - expanded_;
  request_.budget.show_iteration(iteration + 1);
  next_ant_ = 0;
  walked_ = 0;
  crew.all_do([&](std::size_t n) { send_out(walkers_[n], iteration); });
  const bool complete = collect();
  note_iteration();
  return complete;
}

void Colony::send_out(Walker& walker, std::size_t iteration) {
  for (;;) {
    // Read first, so that all ants whose steps have been added come before the next one.
    const bool is_spent = walked_ >= max_steps_;
    const std::size_t n = next_ant_++;
    if (n >= ants_.size()) {
      return;
    }
    walker.ant = &ants_[n];
    if (is_spent || stopped_) {
      walker.ant->end = Ant::End::stopped;
      walker.ant->steps = 0;
      continue;
    }
    walker.random = request_.random.sub("ant", iteration * ants_.size() + n);
    walk(walker);
    walked_ += walker.ant->steps;
    request_.budget.show_expanded(expanded_ + walked_, 0);
    if (iteration == 0 && n == 0) {
      first_refused_ = walker.rules.refusals();
    }
    if (walker.ant->end == Ant::End::arrived) {
      bring_home(walker);
      price(*walker.ant);
    } else if (walker.ant->end == Ant::End::stopped && walker.ant->steps < max_steps_) {
      cancelled_ = cancelled_ || walker.watch.cancelled();
      stopped_ = true;
    }
  }
}

/// By the objective; an ant whose route has no cost is lost.
void Colony::price(Ant& ant) const {
  ant.cost = request_.objective ? cost_of(Route(route_of(ant)), request_) : ant.length;
  if (ant.cost == kInfinity) {
    ant.end = Ant::End::stuck;
  }
}

/// Collects the ants' routes in order, as far as the budget of steps covers them; true if it covers
/// all.
bool Colony::collect() {
  alive_ = stuck_ = too_long_ = 0;
  double sum = 0;
  double metres = 0;
  bool complete = true;
  for (Ant& ant : ants_) {
    const std::uint64_t left = request_.budget.max_iterations - expanded_;
    if (left == 0 || ant.steps > left) {
      ant.end = Ant::End::stopped;
      ant.steps = left;
    }
    expanded_ += ant.steps;
    complete = complete && ant.end != Ant::End::stopped;
    stuck_ += ant.end == Ant::End::stuck ? 1 : 0;
    too_long_ += ant.end == Ant::End::too_long ? 1 : 0;
    if (ant.end == Ant::End::arrived) {
      ++alive_;
      sum += ant.cost;
      metres += ant.length;
      if (best_.way.empty() || ant.cost < best_.cost) {
        best_ = ant;
        request_.budget.show_best(ant.cost);
      }
    }
  }
  past_.push_back(
      {alive_ > 0 ? sum / double(alive_) : kInfinity, best_.way.empty() ? kInfinity : best_.cost});
  if (metres_per_cost_ == 0 && sum > 0) {
    metres_per_cost_ = metres / sum;  // exactly 1 where the cost is the length
  }
  return complete && !stopped_;
}

void Colony::note_iteration() {
  if (request_.trace == nullptr) {
    return;
  }
  TraceEvent event{TraceEvent::Kind::iteration, std::int64_t(past_.size()), -1,
                   request_.goal.position, past_.back().best};
  event.mean = past_.back().mean;
  event.alive = std::int64_t(alive_);
  request_.trace->add(event);
  std::size_t shown = 0;
  for (const Ant& ant : ants_) {
    if (ant.end != Ant::End::arrived || shown == kTracedAnts) {
      continue;
    }
    ++shown;
    std::int64_t parent = -1;
    double metres = 0;
    const Polyline route = route_of(ant);
    for (std::size_t n = 0; n < route.size(); ++n) {
      metres += n > 0 ? (route[n] - route[n - 1]).norm() : 0;
      request_.trace->add({TraceEvent::Kind::added, traced_, parent, route[n], metres});
      parent = traced_++;
    }
  }
}

void Colony::lay_all() {
  evaporate();
  for (const Ant& ant : ants_) {
    if (ant.end == Ant::End::arrived) {
      // A route that costs next to nothing counts as one a thousandth as long.
      const double metres = request_.objective
                                ? std::max(ant.cost * metres_per_cost_, ant.length / 1000)
                                : ant.length;
      lay(ant, params_.deposit_q / (params_.initial_pheromone * metres));
    }
  }
  settle();
}

std::optional<Approach> Colony::before(const Ant& ant, std::size_t place) const {
  if (place > 0) {
    return position(ant.way[place - 1]);  // level legs have headings
  }
  return start_link_ == 0 ? request_.before_start() : request_.start.position;
}

bool Colony::keeps_rules(Walker& walker, std::uint32_t to) const {
  const Ant& ant = *walker.ant;
  return walker.rules.keeps_rules(before(ant, ant.way.size() - 1), position(ant.way.back()),
                                  position(to));
}

bool Colony::keeps_rules(Walker& walker, std::size_t from, std::size_t to) const {
  const Ant& ant = *walker.ant;
  const Vec3 a = position(ant.way[from]);
  const Vec3 b = position(ant.way[to]);
  if (!walker.rules.keeps_rules(before(ant, from), a, b)) {
    return false;
  }
  if (to + 1 < ant.way.size()) {
    return walker.rules.keeps_rules(a, b, position(ant.way[to + 1]));
  }
  return goal_link_ == 0 || walker.rules.any_leg_ok(a, b, request_.goal.position);
}

/// True if the leg from the goal's cell to the goal may follow the ant's last one.
bool Colony::ends_well(Walker& walker) const {
  const Ant& ant = *walker.ant;
  return goal_link_ == 0 || cells_decide_ ||
         walker.rules.any_leg_ok(position(ant.way[ant.way.size() - 2]), position(goal_),
                                 request_.goal.position);
}

double Colony::length_of(const std::vector<std::uint32_t>& way) const {
  double metres = start_link_ + goal_link_;
  for (std::size_t n = 1; n < way.size(); ++n) {
    metres += (position(way[n]) - position(way[n - 1])).norm();
  }
  return metres;
}

Polyline Colony::route_of(const Ant& ant) const {
  Polyline route = {request_.start.position};
  for (std::size_t n = start_link_ == 0 ? 1 : 0; n < ant.way.size(); ++n) {
    route.push_back(position(ant.way[n]));
  }
  if (goal_link_ == 0) {
    route.back() = request_.goal.position;
  } else {
    route.push_back(request_.goal.position);
  }
  return route;
}

PlanResult Colony::result() const {
  PlanResult result;
  const bool cut_short = stopped_ || expanded_ >= request_.budget.max_iterations;
  const bool found = !best_.way.empty();
  result.status = found        ? PlanStatus::solved
                  : cancelled_ ? PlanStatus::cancelled
                  : cut_short  ? PlanStatus::timed_out
                               : PlanStatus::no_route;
  result.budget_hit = cut_short;
  result.route = found ? route_of(best_) : Polyline{};
  result.message = reason();
  result.counters = {{"expanded", std::int64_t(expanded_)},
                     {"iterations", std::int64_t(past_.size())},
                     {"alive", std::int64_t(alive_)},
                     {"stuck", std::int64_t(stuck_)},
                     {"too_long", std::int64_t(too_long_)}};
  if (found) {
    if (alive_ > 0 && !request_.objective) {
      result.counters.push_back({"mean_length_m", std::llround(past_.back().mean)});
    }
    const auto add_first = [&](const std::string& name, const auto& settled) {
      const auto first = std::find_if(past_.begin(), past_.end(), settled);
      if (first != past_.end()) {
        result.counters.push_back({name, first - past_.begin() + 1});
      }
    };
    add_first("best_settled_at", [&](const Iteration& i) { return i.best <= 1.01 * best_.cost; });
    add_first("mean_settled_at", [&](const Iteration& i) { return i.mean <= 1.03 * best_.cost; });
  }
  result.counters.push_back({"lattice_cells", std::int64_t(lattice_.size())});
  return result;
}

std::string Colony::reason() const {
  const std::string walked = std::to_string(past_.size()) + " iterations of " +
                             std::to_string(ants_.size()) + " ants, " + std::to_string(expanded_) +
                             " steps";
  const std::string last = "in the last, " + std::to_string(alive_) + " arrived, " +
                           std::to_string(stuck_) + " were stuck and " + std::to_string(too_long_) +
                           " exceeded " + std::to_string(std::llround(longest_)) + " m";
  if (!best_.way.empty()) {
    return "a route of " + std::to_string(best_.length) + " m after " + walked + "; " + last;
  }
  return "no ant arrived: " + walked + "; " + last +
         (first_refused_.empty() ? "" : "; refused moves of the first ant: " + first_refused_);
}

PlanResult ColonyPlanner::do_plan(const Request& request) const {
  const Lattice lattice(request, params_.cell_m, Neighbourhood::all,
                        {params_.max_bytes(), bytes_per_cell_});
  if (auto over = beyond_budget(lattice, bytes_per_cell_, request.budget)) {
    return *std::move(over);
  }
  if (const int levels = lattice.spec().counts[2]; levels > 1) {
    PlanResult result;
    result.status = PlanStatus::invalid_problem;
    result.message = std::string(name_) + " searches one level of cells, this lattice has " +
                     std::to_string(levels) + ": give the scenario level_flight_at_m, or use astar";
    return result;
  }
  return search(request, lattice);
}

Traits ColonyPlanner::do_traits() const {
  Traits traits;
  traits.anytime = true;
  traits.spatial = false;
  traits.objectives = true;
  return traits;
}
}  // namespace altiplan::kit
