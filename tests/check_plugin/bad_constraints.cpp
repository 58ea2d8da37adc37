// SPDX-License-Identifier: Apache-2.0
// Constraints broken on purpose, one thing each. The sound one admits legs of up to ten times its
// limit; half of the limit is the stricter parameter.
#include <limits>
#include <utility>

#include "altiplan/request.hpp"
#include "altiplan/route.hpp"
#include "altiplan/world.hpp"
#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

struct Params {
  double limit = 100;
  void describe(Fields& f) { f("limit", limit).greater_than(0).doc("of the rule"); }
};

/// What a constraint says; what is not set says nothing.
struct Rule {
  void (*tighten)(Limits&, double limit) = nullptr;
  bool (*admits)(const Motion&, double limit) = nullptr;
  std::vector<Violation> (*violations)(const Polyline&, double limit) = nullptr;
};

template <Rule (*kRule)(), Does kDoes = does_nothing>
class Told final : public Constraint {
 public:
  explicit Told(const Params& params) : limit_(params.limit) { kDoes(); }

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    if (kRule().tighten != nullptr) {
      kRule().tighten(limits, limit_);
    }
  }
  bool do_admits(const Motion& leg) const override {
    return kRule().admits == nullptr || kRule().admits(leg, limit_);
  }
  std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
    return kRule().violations != nullptr ? kRule().violations(route, limit_)
                                         : std::vector<Violation>{};
  }
  double limit_;
};

template <void (*kTighten)(Limits&, double)>
Rule tightening() {
  return {kTighten, nullptr, nullptr};
}
template <bool (*kAdmits)(const Motion&, double)>
Rule admitting() {
  return {nullptr, kAdmits, nullptr};
}
template <std::vector<Violation> (*kViolations)(const Polyline&, double)>
Rule violating() {
  return {nullptr, nullptr, kViolations};
}
Rule silent() { return {}; }

bool short_leg(const Motion& leg, double limit) { return (leg.to - leg.from).norm() <= 10 * limit; }
using Sound = Told<admitting<short_leg>>;

void loosens(Limits& limits, double limit) { limits.max_leg = limit; }
void not_a_number(Limits& limits, double) {
  limits.max_climb = std::numeric_limits<double>::quiet_NaN();
}
void adds_up(Limits& limits, double limit) { limits.min_clearance += limit; }
void replaces_bands(Limits& limits, double limit) {
  limits.altitude = {{AltitudeBand::Datum::sea, -limit, limit}};
}
void looser_when_stricter(Limits& limits, double limit) {
  limits.min_clearance = std::max(limits.min_clearance, limit);
}

std::atomic<int> calls = 0;

bool tires(const Motion& leg, double limit) { return short_leg(leg, limit) && ++calls % 7 != 0; }
bool remembers(const Motion& leg, double) {
  static thread_local double last = 0;
  const double before = std::exchange(last, leg.from.x());
  return before < leg.from.x();
}
bool long_leg(const Motion& leg, double limit) { return (leg.to - leg.from).norm() >= 10 * limit; }
bool divides(const Motion& leg, double limit) {
  if (leg.from == leg.to && leg.before && *leg.before == leg.from) {
    throw std::domain_error("a leg without direction");
  }
  return short_leg(leg, limit);
}

/// Keeps away from a place, as far as the leg's ends tell.
bool only_ends(const Motion& leg, double limit) {
  const double away = 5e4 / limit;
  return leg.from.norm() >= away && leg.to.norm() >= away;
}

/// In sight of a mast and within its range, as far as the leg's ends tell.
bool ends_in_sight(const Motion& leg, double limit) {
  const Vec3 mast{0, 0, limit / 2};
  const auto is_seen = [&](const Vec3& p) {
    return (p - mast).norm() <= 6000 && leg.world->ground_gap(mast, p) >= 0;
  };
  return leg.world == nullptr || (is_seen(leg.from) && is_seen(leg.to));
}

using Violations = std::vector<Violation>;

Violations impure(const Polyline&, double limit) { return {{"", 0, limit + ++calls, limit, "so"}}; }
Violations needs_a_point(const Polyline& route, double limit) {
  const double x = route.at(0).x();
  return x > limit ? Violations{{"", 0, x, limit, "too far east"}} : Violations{};
}
Violations of_nothing(const Polyline&, double limit) { return {{"", 0, limit, limit, "just so"}}; }
Violations beyond(const Polyline& route, double limit) {
  return {{"", route.size(), 2 * limit, limit, "there"}};
}
Violations without_words(const Polyline&, double limit) { return {{"", 0, 2 * limit, limit, ""}}; }
Violations kept_when_stricter(const Polyline& route, double limit) {
  const double total = length(route);
  return total < 30 * limit ? Violations{{"", 0, total, limit, "short"}} : Violations{};
}
template <Does kDoes>
using DoesWhat = Told<admitting<short_leg>, kDoes>;
Violations by_an_address(const Polyline& route, double limit) {
  const double total = length(route) + by_address();
  return total > 10 * limit ? Violations{{"", 0, total, limit, "too long"}} : Violations{};
}
using ByAddress = Told<violating<by_an_address>>;
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "sound", Sound, Params, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Constraint, "loosens", Told<tightening<loosens>>, Params,
                "sets a limit that was stricter")
ALTIPLAN_PLUGIN(Constraint, "not_a_number", Told<tightening<not_a_number>>, Params,
                "sets a limit to what is no number")
ALTIPLAN_PLUGIN(Constraint, "adds_up", Told<tightening<adds_up>>, Params,
                "makes a limit stricter each time it is asked")
ALTIPLAN_PLUGIN(Constraint, "replaces_bands", Told<tightening<replaces_bands>>, Params,
                "puts its band of altitude in the place of others")
ALTIPLAN_PLUGIN(Constraint, "looser_when_stricter", Told<tightening<looser_when_stricter>>, Params,
                "its limit is looser with the stricter parameter")
ALTIPLAN_PLUGIN(Constraint, "tires", Told<admitting<tires>>, Params,
                "what it admits depends on how often it was asked")
ALTIPLAN_PLUGIN(Constraint, "remembers", Told<admitting<remembers>>, Params,
                "what it admits depends on the leg asked for before")
ALTIPLAN_PLUGIN(Constraint, "long_leg", Told<admitting<long_leg>>, Params,
                "admits more with the stricter parameter")
ALTIPLAN_PLUGIN(Constraint, "only_ends", Told<admitting<only_ends>>, Params,
                "keeps away from a place with the ends of legs alone")
ALTIPLAN_PLUGIN(Constraint, "ends_in_sight", Told<admitting<ends_in_sight>>, Params,
                "looks for the shadow of hills at the ends of legs alone")
ALTIPLAN_PLUGIN(Constraint, "divides", Told<admitting<divides>>, Params,
                "throws at a leg without a direction")
ALTIPLAN_PLUGIN(Constraint, "impure", Told<violating<impure>>, Params,
                "its violations depend on how often it was asked")
ALTIPLAN_PLUGIN(Constraint, "needs_a_point", Told<violating<needs_a_point>>, Params,
                "throws at a route without a point")
ALTIPLAN_PLUGIN(Constraint, "of_nothing", Told<violating<of_nothing>>, Params,
                "finds violations whose value is the limit")
ALTIPLAN_PLUGIN(Constraint, "beyond", Told<violating<beyond>>, Params,
                "finds violations beyond the route's end")
ALTIPLAN_PLUGIN(Constraint, "without_words", Told<violating<without_words>>, Params,
                "finds violations without a message")
ALTIPLAN_PLUGIN(Constraint, "kept_when_stricter", Told<violating<kept_when_stricter>>, Params,
                "a route that breaks its rule keeps it with the stricter parameter")
ALTIPLAN_PLUGIN(Constraint, "silent", Told<silent>, Params, "says nothing at all")
ALTIPLAN_BAD_ENTRIES(Constraint, Sound, Params)
ALTIPLAN_BAD_PROCESSES(Constraint, DoesWhat<changes_locale>, DoesWhat<prints>,
                       DoesWhat<writes_file>, DoesWhat<leaks>, ByAddress, Params)
