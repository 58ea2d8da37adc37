// SPDX-License-Identifier: Apache-2.0
#include "host/scripts/answers.hpp"

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "host/scripts/asked_world.hpp"

namespace altiplan::host {
namespace {

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

std::vector<double> clearances(const Points& points, const World& world) {
  std::vector<double> answers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    answers.push_back(asked_clearance(world, points.at(0, i)));
  }
  return answers;
}

std::vector<double> heights(const std::vector<double>& xy, const World& world) {
  std::vector<double> answers;
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) {
    answers.push_back(asked_ground(world, xy[i], xy[i + 1]));
  }
  return answers;
}

std::vector<double> blocked(const Points& points, double radius, const World& world) {
  std::vector<double> answers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool meets =
        !(radius >= 0) || asked_blocked(world, points.at(0, i), points.at(1, i), radius);
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

/// Longitudes and latitudes in the frame, x and y in turn.
std::vector<double> local(const std::vector<double>& lonlat, const Frame& frame) {
  std::vector<double> answers;
  for (std::size_t i = 0; i + 1 < lonlat.size(); i += 2) {
    const auto xy = frame.to_local(lonlat[i], lonlat[i + 1]);
    answers.insert(answers.end(), xy.begin(), xy.end());
  }
  return answers;
}

ScriptMessage answer_of_world(const std::string& what, const ScriptMessage& question,
                              const World& world) {
  const std::vector<double>& numbers = question.numbers;
  if (what == "clearance") {
    return {Json::object(), clearances(Points(numbers, 1), world)};
  }
  if (what == "ground") {
    return {Json::object(), heights(numbers, world)};
  }
  if (what == "legs_blocked") {
    const double radius = question.head.value("radius_m", 0.0);
    return {Json::object(), blocked(Points(numbers, 2), radius, world)};
  }
  Json layers = Json::array();
  for (const Layer& layer : world.layers()) {
    layers.push_back(layer.id);
  }
  return {{{"layers", layers}}, {}};
}
}  // namespace

ScriptMessage script_answer(const ScriptMessage& question, const ScriptAsked& asked) {
  const auto what = question.head.value("ask", "");
  const bool is_of_world =
      what == "clearance" || what == "ground" || what == "legs_blocked" || what == "layers";
  if (is_of_world && asked.world != nullptr) {
    return answer_of_world(what, question, *asked.world);
  }
  if (what == "legs_ok" && asked.request != nullptr) {
    const bool with_before = question.head.value("before", false);
    const Points points(question.numbers, with_before ? 3 : 2);
    return {Json::object(), admitted(points, with_before, *asked.request)};
  }
  if (what == "violations" && asked.request != nullptr) {
    return {{{"violations", violations(Points(question.numbers, 1), *asked.request)}}, {}};
  }
  const Frame* frame =
      asked.frame == nullptr && asked.world != nullptr ? &asked.world->frame() : asked.frame;
  if (what == "local" && frame != nullptr) {
    return {Json::object(), local(question.numbers, *frame)};
  }
  throw PluginError("asks for " + excerpt(what) + ", which cannot be answered here");
}
}  // namespace altiplan::host
