// SPDX-License-Identifier: Apache-2.0
#include "host/gate/returns_json.hpp"

namespace altiplan::host {
namespace {

Json refused_json(const std::vector<RefusedReturn>& stretches, const Mission& world) {
  Json refused = Json::array();
  for (const RefusedReturn& stretch : stretches) {
    const Finding& finding = stretch.finding;
    Json one{{"from_s", stretch.from_s},
             {"to_s", stretch.to_s},
             {"worst_s", stretch.worst_s},
             {"item", finding.item},
             {"items", finding.items},
             {"part", finding.what},
             {"rule", finding.violation.constraint},
             {"value", finding.violation.value},
             {"limit", finding.violation.limit},
             {"unit", finding.violation.unit},
             {"layer", finding.violation.layer},
             {"zone", finding.zone},
             {"message", finding.violation.message}};
    for (const Finding& other : stretch.others) {
      one["others"].push_back({{"rule", other.violation.constraint},
                               {"layer", other.violation.layer},
                               {"zone", other.zone},
                               {"message", other.violation.message}});
    }
    if (finding.at) {
      const auto [lon, lat] = world.truth.frame().to_lonlat(finding.at->x(), finding.at->y());
      one["lonlat"] = {lon, lat};
      one["altitude_m"] = finding.at->z();
    }
    refused.push_back(std::move(one));
  }
  return refused;
}

Json glide_json(const GlideReport& glide, const PlanReport& report, const Mission& world) {
  Json reached = Json::array();
  for (const GlideStretch& stretch : glide.reached) {
    reached.push_back({{"from_s", stretch.from_s},
                       {"to_s", stretch.to_s},
                       {"items", {report.name_of(stretch.first), report.name_of(stretch.last)}},
                       {"site", stretch.site},
                       {"margin_m", stretch.margin_m}});
  }
  return Json{{"verdict", key_of(glide.verdict)},
              {"ratio", glide.ratio},
              {"wind_mps", glide.wind_mps},
              {"margin_m", glide.margin_m() ? Json(*glide.margin_m()) : Json()},
              {"reached", reached},
              {"refused", refused_json(glide.refused, world)},
              {"not_judged", glide.unjudged},
              {"parameters", to_json(glide.parameters)}};
}

}  // namespace

const char* key_of(Verdict verdict) {
  return verdict == Verdict::not_judged ? "not_judged" : word_of(verdict);
}

Json to_json(const std::vector<Parameters::Used>& used) {
  Json parameters = Json::object();
  for (const Parameters::Used& one : used) {
    parameters[one.name] = one.value;
  }
  return parameters;
}

Json returns_json(const PlanReport& report, const Mission& world) {
  const ReturnsReport& returns = *report.returns;
  const RefusedReturn* worst = returns.worst();
  Json json{
      {"verdict", key_of(returns.overall())},
      {"worst",
       worst == nullptr ? Json() : Json{{"time_s", worst->worst_s}, {"item", worst->finding.item}}},
      {"point_of_no_return_s",
       returns.point_of_no_return_s ? Json(*returns.point_of_no_return_s) : Json()},
      {"refused", refused_json(returns.refused, world)},
      {"not_judged", returns.unjudged},
      {"parameters", to_json(returns.parameters)}};
  if (returns.glide) {
    json["glide"] = glide_json(*returns.glide, report, world);
  }
  return json;
}
}  // namespace altiplan::host
