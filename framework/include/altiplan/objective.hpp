// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "altiplan/route.hpp"

namespace altiplan {

struct Request;

/// What a route is to have least of: a cost of its legs, added up, or of its waypoints as a whole.
///
/// Contract:
///  1. Pure and const: callable from any number of threads.
///  2. cost is at least 0 and additive: the sum of the costs of the leg's pieces, each at its own
///     time. It is infinite where the leg cannot be priced: such a leg is not flown.
///  3. bound is consistent: bound(a, a) = 0 and bound(a, c) <= cost(a-b) + bound(b, c) for all
///     places in the request's volume and all times. So it is at most the cost of any route.
///  4. cost depends on nothing that traits denies: the place (a leg moved elsewhere costs the
///     same), the heading (so does the leg flown backwards), the time (in an unchanging wind).
///  5. costs are at least 0. Without the trait `waypoints` their sum is that of cost over the legs,
///     and what joining them takes (stops at corners), which no search from leg to leg sees; with
///     it cost and bound serve those who look at single legs, and tell nothing of a route but that
///     an infinite leg makes it infinite. min_cost is at most the sum of the costs of any route
///     between the request's ends.
class ALTIPLAN_API Objective {
 public:
  struct Traits {
    bool place = true;
    bool heading = false;
    bool time = false;
    bool waypoints = false;
  };

  virtual ~Objective();
  /// Cost of a leg that begins `time_s` seconds after the start, in `unit`. Throws PluginError if
  /// it is negative or no number.
  double cost(const Leg& leg, double time_s, const Request& request) const;
  /// Lower bound of the cost of all routes between two places, at any time. Throws likewise.
  double bound(const Vec3& from, const Vec3& to, const Request& request) const;
  /// What a route from the start costs, term by term: searches for compromises (Pareto) minimise
  /// each. Throws likewise.
  std::vector<double> costs(const Route& route, const Request& request) const;
  /// What a route from the start costs: the sum of its terms.
  double cost(const Route& route, const Request& request) const;
  /// Lower bound of the cost of all routes between the request's ends, which are points. Throws
  /// likewise.
  double min_cost(const Request& request) const;
  /// Unit of costs ("m"), for people; "" without one.
  std::string unit() const { return do_unit(); }
  Traits traits() const { return do_traits(); }
  /// What messages call it: "'exposure' (scenario.objective.exposure)"; "" without a name.
  void set_name(std::string name) { name_ = std::move(name); }
  const std::string& name() const { return name_; }

 protected:
  /// The sum of cost over the legs, each at its time.
  double legs_cost(const Route& route, const Request& request) const;

 private:
  virtual double do_cost(const Leg& leg, double time_s, const Request& request) const = 0;
  virtual double do_bound(const Vec3& from, const Vec3& to, const Request& request) const = 0;
  /// Default: one term, legs_cost.
  virtual std::vector<double> do_costs(const Route& route, const Request& request) const;
  /// Default: bound.
  virtual double do_min_cost(const Request& request) const;
  virtual std::string do_unit() const = 0;
  /// Default: depends on the place alone.
  virtual Traits do_traits() const;

  std::string name_;
};

// By the request's objective; by length, in metres, if it has none.

/// Cost of a leg that begins at the start's time.
ALTIPLAN_API double cost_of(const Leg& leg, const Request& request);
/// Cost of a route from the start: the sum of its terms.
ALTIPLAN_API double cost_of(const Route& route, const Request& request);
/// Lower bound of the cost of all routes that begin and end as the request asks; 0 where its ends
/// are not points (a tolerance or a loiter circle) and no bound is known.
ALTIPLAN_API double min_cost(const Request& request);

/// True if a cost exceeds another by more than the rounding of sums.
inline bool costs_more(double cost, double than) { return !(cost <= than * (1 + 1e-12)); }
}  // namespace altiplan
