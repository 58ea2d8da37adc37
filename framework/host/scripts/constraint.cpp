// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "host/scripts/object.hpp"
#include "host/scripts/values.hpp"

namespace altiplan::host {
namespace {

constexpr std::chrono::seconds kAnswerTimeout(20);

bool has(const char* method, const ScriptObject& object) {
  const Json& methods = object.made().at("methods");
  return std::find(methods.begin(), methods.end(), method) != methods.end();
}

AppliesTo applies_to_of(const std::string& name) {
  return name == "route" ? AppliesTo::route : name == "track" ? AppliesTo::track : AppliesTo::both;
}

void add(std::vector<double>& numbers, const Vec3& point) {
  numbers.insert(numbers.end(), point.begin(), point.end());
}

AltitudeBand band_of(const Json& reported) {
  AltitudeBand band;
  band.datum = reported.at("above_ground").get<bool>() ? AltitudeBand::Datum::ground
                                                       : AltitudeBand::Datum::sea;
  band.min = reported.at("min_m").is_null() ? -kInfinity : reported.at("min_m").get<double>();
  band.max = reported.at("max_m").is_null() ? kInfinity : reported.at("max_m").get<double>();
  return band;
}

/// Tells whether a limit is among those reported, and which.
std::optional<double> found(const Json& reported, const char* name) {
  const auto at = reported.find(name);
  return at == reported.end() ? std::nullopt : std::optional(at->get<double>());
}

class ScriptConstraint : public Constraint {
 public:
  explicit ScriptConstraint(std::unique_ptr<const ScriptObject> object)
      : object_(std::move(object)),
        applies_to_(applies_to_of(object_->made().at("applies_to").get<std::string>())),
        tightens_(has("tighten", *object_)),
        judges_routes_(has("violations", *object_)) {}

 protected:
  const ScriptObject& object() const { return *object_; }

 private:
  AppliesTo do_applies_to() const override { return applies_to_; }
  void do_tighten(Limits& limits, const Request& request) const override;
  std::vector<Violation> do_violations(const Polyline& route,
                                       const Request& request) const override;
  bool do_admits_all() const override { return true; }

  std::unique_ptr<const ScriptObject> object_;
  AppliesTo applies_to_;
  bool tightens_;
  bool judges_routes_;
};

/// One that admits legs: the others, which admit all of them, are not asked.
class ScriptLegConstraint final : public ScriptConstraint {
 public:
  using ScriptConstraint::ScriptConstraint;

 private:
  bool do_admits(const Motion& leg) const override {
    std::vector<double> numbers;
    add(numbers, leg.from);
    add(numbers, leg.to);
    if (leg.before) {
      add(numbers, *leg.before);
    }
    static const World kNothing;  // where no world is known
    const ScriptAsked asked{leg.world != nullptr ? leg.world : &kNothing};
    return object()
        .answer({{{"admits", true}}, std::move(numbers)}, asked, kAnswerTimeout)
        .head.at("yes")
        .get<bool>();
  }
  bool do_admits_all() const override { return false; }
};

/// What it reports is taken where it is stricter, so that nothing is loosened.
void ScriptConstraint::do_tighten(Limits& limits, const Request& request) const {
  if (!tightens_) {
    return;
  }
  Request tightened = request;
  tightened.limits = limits;
  const Json reported = object_
                            ->answer({{{"tighten", script_values(tightened)}}, {}},
                                     {request.world.get(), &request}, kAnswerTimeout)
                            .head.at("limits");
  const auto at_least = [&](const char* name, double& limit) {
    limit = std::max(limit, found(reported, name).value_or(limit));
  };
  const auto at_most = [&](const char* name, double& limit) {
    limit = std::min(limit, found(reported, name).value_or(limit));
  };
  at_least("min_clearance_m", limits.min_clearance);
  at_least("min_leg_m", limits.min_leg);
  at_least("min_turn_radius_m", limits.min_turn_radius);
  at_most("max_leg_m", limits.max_leg);
  at_most("max_turn", limits.max_turn_horizontal);
  at_most("max_turn_in_space", limits.max_turn_space);
  at_most("max_route_m", limits.max_route_length);
  if (const auto above = found(reported, "min_ground_clearance_m")) {
    limits.min_ground_clearance = std::max(limits.min_ground_clearance.value_or(*above), *above);
  }
  if (const auto descent = found(reported, "max_descent")) {
    limits.max_sink = std::min(limits.max_descent(), *descent);
  }
  at_most("max_climb", limits.max_climb);
  for (const Json& band : reported.value("altitude", Json::array())) {
    limits.altitude.push_back(band_of(band));
  }
}

std::vector<Violation> ScriptConstraint::do_violations(const Polyline& route,
                                                       const Request& request) const {
  std::vector<Violation> violations;
  if (!judges_routes_ || route.empty()) {
    return violations;
  }
  std::vector<double> numbers;
  for (const Vec3& point : route) {
    add(numbers, point);
  }
  const ScriptMessage answer =
      object_->answer({{{"violations", script_values(request)}}, std::move(numbers)},
                      {request.world.get(), &request}, kAnswerTimeout);
  for (const Json& reported : answer.head.at("violations")) {
    violations.push_back({"", reported.at(0).get<std::size_t>(), reported.at(1).get<double>(),
                          reported.at(2).get<double>(), reported.at(3).get<std::string>()});
  }
  return violations;
}
}  // namespace

std::unique_ptr<Constraint> script_constraint(ScriptSource source) {
  auto object = std::make_unique<const ScriptObject>(std::move(source));
  if (has("admits", *object)) {
    return std::make_unique<ScriptLegConstraint>(std::move(object));
  }
  return std::make_unique<ScriptConstraint>(std::move(object));
}
}  // namespace altiplan::host
