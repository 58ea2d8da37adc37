// SPDX-License-Identifier: Apache-2.0
// Trimming of a route in rounds of ever shorter strides.
//
// Citation: Li Rongsheng et al.: Path planning for flight vehicles based on improved ACO (paper
//   004), section 2.3 and eq. (11).
// Guarantees: every new leg, and the turn at its end, satisfies every constraint on legs; the route
//   never gets longer, no waypoint moves, and the largest violation of any constraint does not
//   grow. Neither the fewest waypoints nor the shortest choice of them (see smoother prune).
// Complexity: O(n) leg checks per round for n waypoints; 5 rounds by default.
// Deviations: legs are checked exactly, with the turns at both ends of a stride (the paper checks
//   obstacles alone). The nodes are the route's waypoints, at any spacing.
// Symbols: l_c(v) the stride of round v, see kit/trimming.hpp.
#include "altiplan/kit/smoothing/trimming.hpp"

#include "altiplan/check.hpp"
#include "altiplan/kit/smoothing/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {
using namespace altiplan;

/// The rounds over one route.
class Trimming {
 public:
  Trimming(const Polyline& route, const Request& request)
      : nodes_(without_repeats(route)), request_(request), watch_(request.budget) {}

  void round(std::size_t stride) {
    kit::trim(nodes_, stride, [&](std::size_t from, std::size_t to) {
      budget_hit_ = budget_hit_ || watch_.spent(std::uint64_t(tried_));
      if (budget_hit_) {
        return false;
      }
      ++tried_;
      return keeps_rules(from, to);
    });
  }

  const Polyline& nodes() const { return nodes_; }
  std::int64_t tried() const { return tried_; }
  bool budget_hit() const { return budget_hit_; }

 private:
  /// True if the stride between two nodes, and the following legs into which it turns, satisfy the
  /// constraints.
  bool keeps_rules(std::size_t from, std::size_t to) const {
    std::optional<Approach> before = approach(nodes_, from, request_.before_start());
    if (!leg_ok(before, nodes_[from], nodes_[to], request_)) {
      return false;
    }
    before = onward(before, nodes_[from]);
    for (std::size_t i = to; i + 1 < nodes_.size(); ++i) {
      if (!leg_ok(before, nodes_[i], nodes_[i + 1], request_)) {
        return false;
      }
      if (has_heading(nodes_[i + 1] - nodes_[i])) {
        break;  // the following legs are unchanged
      }
      before = onward(before, nodes_[i]);
    }
    return true;
  }

  Polyline nodes_;
  const Request& request_;
  BudgetWatch watch_;
  std::int64_t tried_ = 0;
  bool budget_hit_ = false;
};

class Trim final : public Smoother {
 public:
  explicit Trim(const kit::TrimParams& params) : strides_(params.strides()) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    Trimming trimming(route, request);
    for (const std::size_t stride : strides_) {
      trimming.round(stride);
    }
    PlanResult result;
    result.status = PlanStatus::solved;
    result.budget_hit = trimming.budget_hit();
    // Constraints on whole routes are checked last.
    const bool accepted = kit::Excess(check(trimming.nodes(), request).violations)
                              .within(kit::Excess(check(route, request).violations));
    result.route = accepted ? trimming.nodes() : route;
    result.counters = {{"expanded", trimming.tried()},
                       {"rounds", std::int64_t(strides_.size())},
                       {"removed", std::int64_t(route.size() - result.route.size())}};
    result.message = accepted
                         ? summary(result, route.size())
                         : "the trimmed route would violate a constraint on whole routes: it is "
                           "unchanged";
    return result;
  }

  std::string summary(const PlanResult& result, std::size_t before) const {
    std::string said = std::to_string(result.route.size()) + " of " + std::to_string(before) +
                       " waypoints kept, after strides of";
    for (std::size_t v = 0; v < strides_.size(); ++v) {
      said += (v == 0 ? " " : ", ") + std::to_string(strides_[v]);
    }
    return said + (result.budget_hit ? "; the budget was used up" : "");
  }

  std::vector<std::size_t> strides_;  // of the rounds
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "trim", Trim, kit::TrimParams,
                "straight strides over waypoints, shorter in each round")
