// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/script_answers.hpp"

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "host/plugins/asked_world.hpp"

namespace altiplan::host {
namespace {

using Json = nlohmann::ordered_json;

/// The numbers of a question as `parts` lists of points, one after the other.
class Points {
 public:
  Points(const std::vector<double>& numbers, std::size_t parts)
      : numbers_(numbers), size_(numbers.size() / (3 * parts)) {
    if (numbers.size() % (3 * parts) != 0) {
      throw PluginError("asks about points that are not whole");
    }
  }
  std::size_t size() const { return size_; }
  Vec3 at(std::size_t part, std::size_t i) const {
    const double* numbers = numbers_.data() + 3 * (part * size_ + i);
    return {numbers[0], numbers[1], numbers[2]};
  }

 private:
  const std::vector<double>& numbers_;
  std::size_t size_;
};

std::vector<double> clearances(const Points& points, const Request& request) {
  std::vector<double> answers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    answers.push_back(asked_clearance(*request.world, points.at(0, i)));
  }
  return answers;
}

std::vector<double> heights(const std::vector<double>& xy, const Request& request) {
  std::vector<double> answers;
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) {
    answers.push_back(asked_ground(*request.world, xy[i], xy[i + 1]));
  }
  return answers;
}

std::vector<double> blocked(const Points& points, double radius, const Request& request) {
  std::vector<double> answers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool meets =
        !(radius >= 0) || asked_blocked(*request.world, points.at(0, i), points.at(1, i), radius);
    answers.push_back(meets ? 1 : 0);
  }
  return answers;
}

std::vector<double> admitted(const Points& points, bool with_before, const Request& request) {
  std::vector<double> answers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 a = points.at(0, i);
    const Vec3 b = points.at(1, i);
    std::optional<Approach> before;
    if (with_before) {
      before = points.at(2, i);
    } else if (a == request.start.position) {
      before = request.before_start();
    }
    const bool finite =
        is_finite(a) && is_finite(b) && (!with_before || is_finite(points.at(2, i)));
    answers.push_back(finite && request.volume.contains(a) && request.volume.contains(b) &&
                              leg_ok(before, a, b, request)
                          ? 1
                          : 0);
  }
  return answers;
}

Json violations(const Points& points, const Request& request) {
  Polyline route;
  for (std::size_t i = 0; i < points.size(); ++i) {
    route.push_back(points.at(0, i));
    if (!is_finite(route.back())) {
      return Json::array({"a coordinate is not finite"});
    }
  }
  Json sentences = Json::array();
  if (route.empty()) {
    return Json::array({"it has no points"});
  }
  for (const Violation& violation : check(route, request).violations) {
    sentences.push_back("(" + violation.constraint + "): " + violation.message);
  }
  return sentences;
}
}  // namespace

ScriptMessage script_answer(const ScriptMessage& question, const Request& request) {
  const Json& head = question.head;
  const std::vector<double>& numbers = question.numbers;
  const auto what = head.value("ask", "");
  if (what == "clearance") {
    return {Json::object(), clearances(Points(numbers, 1), request)};
  }
  if (what == "ground") {
    return {Json::object(), heights(numbers, request)};
  }
  if (what == "legs_blocked") {
    return {Json::object(), blocked(Points(numbers, 2), head.value("radius_m", 0.0), request)};
  }
  if (what == "legs_ok") {
    const bool with_before = head.value("before", false);
    return {Json::object(), admitted(Points(numbers, with_before ? 3 : 2), with_before, request)};
  }
  if (what == "violations") {
    return {{{"violations", violations(Points(numbers, 1), request)}}, {}};
  }
  throw PluginError("asks for " + excerpt(what) + ", which no world answers");
}
}  // namespace altiplan::host
