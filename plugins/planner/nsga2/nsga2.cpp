// SPDX-License-Identifier: Apache-2.0
// NSGA-II: routes of which none is better in all terms of the objective.
//
// Citation: K. Deb, A. Pratap, S. Agarwal, T. Meyarivan: A fast and elitist multiobjective genetic
//   algorithm: NSGA-II. IEEE Transactions on Evolutionary Computation 6(2), 2002,
//   doi:10.1109/4235.996017.
// Guarantees: a larger budget never gives a costlier route; the result does not depend on the
// number
//   of threads. Neither complete nor optimal.
// Complexity: an evaluation of a route for each child; O(m n²) to sort n routes by m terms.
// Deviations: of the last front the route is returned that costs least, the best of all that were
//   evaluated. The terms are those of the objective: of `weighted` its parts, of `nmopso` and
//   `spso` the published ones. A number that leaves the cube is put on its side.
// Symbols: P the parents, Q the children, F the fronts.
#include <algorithm>
#include <numeric>

#include "altiplan/kit/population/variation.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params : kit::PopulationParams {
  int members = 100;
  kit::VariationParams variation;

  void describe(Fields& f) {
    PopulationParams::describe(f);
    f("members", members).range(4, 100'000).doc("size of the population");
    variation.describe(f);
  }
};

struct Ranked : kit::Member {
  std::size_t rank = 0;
  double distance = 0;  ///< crowding distance
};
using Front = std::vector<std::size_t>;

/// Constrained domination: by violation, unless both are feasible.
bool dominates(const kit::Score& a, const kit::Score& b) {
  if (!a.is_feasible() || !b.is_feasible()) {
    return a.violation < b.violation;
  }
  bool is_less = false;
  for (std::size_t m = 0; m < a.terms.size(); ++m) {
    if (a.terms[m] > b.terms[m]) {
      return false;
    }
    is_less = is_less || a.terms[m] < b.terms[m];
  }
  return is_less;
}

std::vector<Front> fast_non_dominated_sort(const std::vector<Ranked>& all) {
  std::vector<Front> dominated(all.size());
  std::vector<std::size_t> dominators(all.size(), 0);
  for (std::size_t p = 0; p < all.size(); ++p) {
    for (std::size_t q = 0; q < all.size(); ++q) {
      if (dominates(all[p].score, all[q].score)) {
        dominated[p].push_back(q);
        ++dominators[q];
      }
    }
  }
  std::vector<Front> fronts(1);
  for (std::size_t p = 0; p < all.size(); ++p) {
    if (dominators[p] == 0) {
      fronts[0].push_back(p);
    }
  }
  while (!fronts.back().empty()) {
    Front next;
    for (const std::size_t p : fronts.back()) {
      for (const std::size_t q : dominated[p]) {
        if (--dominators[q] == 0) {
          next.push_back(q);
        }
      }
    }
    fronts.push_back(std::move(next));
  }
  fronts.pop_back();
  return fronts;
}

/// Sum over the terms of the gap between the neighbours, as a share of the front's range.
void assign_crowding_distance(std::vector<Ranked>& all, const Front& front) {
  for (const std::size_t p : front) {
    all[p].distance = all[p].score.is_feasible() ? 0 : -1;
  }
  const std::size_t terms =
      all[front.front()].score.is_feasible() ? all[front.front()].score.terms.size() : 0;
  for (std::size_t m = 0; m < terms; ++m) {
    Front sorted = front;
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
      return all[a].score.terms[m] < all[b].score.terms[m];
    });
    const auto value = [&](std::size_t n) { return all[sorted[n]].score.terms[m]; };
    const double range = value(sorted.size() - 1) - value(0);
    all[sorted.front()].distance = all[sorted.back()].distance = kInfinity;
    for (std::size_t n = 1; n + 1 < sorted.size() && range > 0; ++n) {
      all[sorted[n]].distance += (value(n + 1) - value(n - 1)) / range;
    }
  }
}

class Nsga2 final : public kit::PopulationPlanner {
 public:
  explicit Nsga2(const Params& params) : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    RandomStream random = population.random("children");
    const auto count = std::size_t(params_.members);
    std::vector<Ranked> P;
    for (kit::Member& drawn : population.draw(count)) {
      P.push_back({std::move(drawn)});
    }
    bool goes_on = population.evaluate(P);
    P = survivors(std::move(P), count);
    while (goes_on) {
      std::vector<Ranked> Q;
      while (Q.size() < count) {
        const Ranked& a = tournament(P, random);
        const Ranked& b = tournament(P, random);
        auto [first, second] = kit::children_of(a, b, params_.variation, random);
        Q.push_back({std::move(first)});
        Q.push_back({std::move(second)});
      }
      goes_on = population.evaluate(Q);
      Q.insert(Q.end(), std::make_move_iterator(P.begin()), std::make_move_iterator(P.end()));
      P = survivors(std::move(Q), count);
    }
  }

  /// The first fronts, the last of them by crowding distance.
  static std::vector<Ranked> survivors(std::vector<Ranked> all, std::size_t count) {
    std::vector<Ranked> next;
    std::size_t rank = 0;
    for (Front& front : fast_non_dominated_sort(all)) {
      assign_crowding_distance(all, front);
      std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
        return all[a].distance > all[b].distance;
      });
      for (std::size_t n = 0; n < front.size() && next.size() < count; ++n) {
        all[front[n]].rank = rank;
        next.push_back(std::move(all[front[n]]));
      }
      ++rank;
    }
    return next;
  }

  /// By rank, then by crowding distance.
  static const Ranked& tournament(const std::vector<Ranked>& parents, RandomStream& random) {
    const auto drawn = [&]() -> const Ranked& {
      return parents[std::size_t(random.integer(0, std::int64_t(parents.size()) - 1))];
    };
    const Ranked& a = drawn();
    const Ranked& b = drawn();
    return b.rank < a.rank || (b.rank == a.rank && b.distance > a.distance) ? b : a;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "nsga2", Nsga2, Params,
                "NSGA-II: compromises between the terms of an objective, over whole routes")
