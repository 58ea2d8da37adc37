// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

enum class Datum { sea, ground, start };

struct Params {
  std::optional<double> min_m;
  std::optional<double> max_m;
  Datum datum = Datum::sea;
  AppliesTo applies_to = AppliesTo::both;

  void describe(Fields& f) {
    f("min_m", min_m).unit("m").range(-20000, 100000).doc("minimum height above the datum");
    f("max_m", max_m).unit("m").range(-20000, 100000).doc("maximum height above the datum");
    f("datum", datum, {{"sea", Datum::sea}, {"ground", Datum::ground}, {"start", Datum::start}})
        .doc("datum of the heights: the sea, the ground below, or the start of the route");
    f("applies_to", applies_to,
      {{"both", AppliesTo::both}, {"route", AppliesTo::route}, {"track", AppliesTo::track}})
        .doc(
            "what it restricts: a larger value for the route than for the track leaves a margin "
            "for the flight");
    f.check(min_m || max_m, "altitude needs min_m, max_m or both");
    f.check(!min_m || !max_m || *min_m <= *max_m, "min_m must not exceed max_m");
  }
};

class Altitude final : public Constraint {
 public:
  explicit Altitude(const Params& params) : params_(params) {}

 private:
  AppliesTo do_applies_to() const override { return params_.applies_to; }
  void do_tighten(Limits& limits, const Request& request) const override {
    // Adding the start's height converts datum `start` to datum `sea`.
    const double shift = params_.datum == Datum::start ? request.start.position.z() : 0;
    AltitudeBand band;
    if (params_.datum == Datum::ground) {
      band.datum = AltitudeBand::Datum::ground;
    }
    band.min = params_.min_m.value_or(-kInfinity) + shift;
    band.max = params_.max_m.value_or(kInfinity) + shift;
    limits.altitude.push_back(band);
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "altitude", Altitude, Params,
                "Keeps the route between two heights above the sea, the ground or the start")
