// SPDX-License-Identifier: Apache-2.0
// Answers a statistic per line of JSON: {"call": "wilcoxon", "of": [0.5, -1]} and so on, for
// statistics_scipy_test.py. What has no answer is null.
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "study/statistics/statistics.hpp"

namespace altiplan::host {
using namespace study;
namespace {
using Json = nlohmann::json;
using Sample = std::vector<double>;
using Samples = std::vector<Sample>;
using Call = Json (*)(const Json&);

Sample of(const Json& call, const char* key = "of") { return call.at(key).get<Sample>(); }

Json interval(const std::optional<Interval>& found) {
  return found ? Json::array({found->low, found->high}) : Json();
}
Json number(const std::optional<double>& found) { return found ? Json(*found) : Json(); }

Json signed_rank(const Json& call) {
  const std::map<std::string, WilcoxonMethod> methods{{"auto", WilcoxonMethod::automatic},
                                                      {"exact", WilcoxonMethod::exact},
                                                      {"approx", WilcoxonMethod::approximate}};
  const auto test = wilcoxon(of(call), methods.at(call.at("mode")));
  return test ? Json::array({test->statistic, test->p}) : Json();
}

Json friedman_test(const Json& call) {
  const auto test = friedman(call.at("of").get<Samples>());
  return test ? Json::array({test->statistic, test->p, test->average_ranks}) : Json();
}

const std::map<std::string, Call> kCalls{
    {"normal_tail", [](const Json& call) { return Json(normal_tail(call.at("of"))); }},
    {"normal_quantile", [](const Json& call) { return Json(normal_quantile(call.at("of"))); }},
    {"chi_squared_tail",
     [](const Json& call) { return Json(chi_squared_tail(call.at("of"), call.at("degrees"))); }},
    {"studentized_range",
     [](const Json& call) { return Json(studentized_range(call.at("of"), call.at("k"))); }},
    {"studentized_range_quantile",
     [](const Json& call) {
       return Json(studentized_range_quantile(call.at("of"), call.at("k")));
     }},
    {"mean", [](const Json& call) { return Json(mean(of(call))); }},
    {"median", [](const Json& call) { return Json(median(of(call))); }},
    {"quantile", [](const Json& call) { return Json(quantile(of(call), call.at("q"))); }},
    {"ranks", [](const Json& call) { return Json(ranks(of(call))); }},
    {"wilson",
     [](const Json& call) {
       return interval(wilson(call.at("successes"), call.at("trials"), call.at("confidence")));
     }},
    {"mcnemar",
     [](const Json& call) { return Json(mcnemar(call.at("first"), call.at("second"))); }},
    {"wilcoxon", signed_rank},
    {"vargha_delaney",
     [](const Json& call) { return number(vargha_delaney(of(call, "x"), of(call, "y"))); }},
    {"friedman", friedman_test},
    {"student_quantile",
     [](const Json& call) { return Json(student_quantile(call.at("of"), call.at("degrees"))); }},
    {"tango",
     [](const Json& call) {
       return interval(tango(call.at("gained"), call.at("lost"), call.at("pairs"), 0.95));
     }},
    {"quantile_interval",
     [](const Json& call) {
       return interval(
           quantile_interval(of(call), call.at("q"), call.at("units"), call.at("confidence")));
     }},
};
}  // namespace
}  // namespace altiplan::host

int main() {
  std::string line;
  while (std::getline(std::cin, line)) {
    const auto call = nlohmann::json::parse(line);
    std::cout << altiplan::host::kCalls.at(call.at("call"))(call) << "\n";
  }
}
