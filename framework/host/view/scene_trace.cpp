// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include "altiplan/formats/input_file.hpp"
#include "host/base/base64.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxEvents = 200'000;
constexpr std::size_t kMaxIterations = 20'000;  // of those
constexpr std::size_t kMaxSteps = 256;
/// In the order of their numbers in the scene.
constexpr std::array<std::string_view, 5> kKinds{"expanded", "added", "removed", "rewired",
                                                 "iteration"};
constexpr std::uint8_t kIteration = 4;

using Point = std::array<float, 3>;

struct Event {
  std::size_t nth = 0;  ///< index among its step's events of its kind
  std::size_t line = 0;
  std::uint8_t step = 0;
  std::uint8_t kind = 0;
  Point at{};
  Point parent{};
  float value = 0;
  // Of an iteration.
  float number = 0;
  float mean = 0;
  float alive = -1;
};

/// Keeps every n-th event of each step, n the smallest power of two that keeps at most
/// `max_events`; events that continue the previous one are kept or dropped with it.
class Thinned {
 public:
  explicit Thinned(std::size_t max_events) : max_events_(max_events) {}

  void add(Event event, bool goes_on) {
    std::size_t& count = counts_[event.step];
    count += goes_on && count > 0 ? 0 : 1;
    event.nth = count - 1;
    greatest_ = std::max(greatest_, event.nth);
    if (event.nth % every_ == 0) {
      kept_.push_back(event);
    }
    // If n exceeds all counts, only the first is left; it stays, however long it is.
    while (kept_.size() > max_events_ && every_ <= greatest_) {
      every_ *= 2;
      kept_.erase(std::remove_if(kept_.begin(), kept_.end(),
                                 [&](const Event& old) { return old.nth % every_ != 0; }),
                  kept_.end());
    }
  }
  const std::vector<Event>& kept() const { return kept_; }

 private:
  std::size_t max_events_;
  std::size_t every_ = 1;
  std::size_t greatest_ = 0;
  std::array<std::size_t, kMaxSteps> counts_{};
  std::vector<Event> kept_;
};

/// A trace, read line by line; memory holds only what is shown and the positions of the nodes.
class Reader {
 public:
  /// Throws a Json::exception or an Error if the line is not an event.
  void add(const std::string& line) {
    const Json json = parse_json(line);
    Event event;
    event.line = count_;
    event.step = step_number(json.at("step").get_ref<const std::string&>());
    event.kind = kind_number(json.at("kind").get_ref<const std::string&>());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Json& coordinate = json.at("at").at(axis);
      event.at[axis] = coordinate.is_null() ? 0 : coordinate.get<float>();
    }
    event.value = number_or_none(json.at("value"));
    const auto node = json.at("node").get<std::int64_t>();
    // Iterations are few, and only they show how the best length decreased.
    if (event.kind == kIteration) {
      event.number = float(node);
      event.alive = json.value("alive", -1.0F);
      event.mean = number_or_none(json.value("mean", Json()));
      is_population_ = event.alive >= 0;
      if (is_population_) {
        nodes_.clear();  // drops its routes
      }
      event.parent = event.at;
      iterations_.add(event, false);
    } else {
      const auto parent = nodes_.find(json.at("parent").get<std::int64_t>());
      event.parent = parent == nodes_.end() ? event.at : parent->second;
      nodes_[node] = event.at;
      others_.add(event, is_population_ && parent != nodes_.end());
    }
    ++count_;
  }

  Json json() const {
    std::vector<Event> kept = iterations_.kept();
    kept.insert(kept.end(), others_.kept().begin(), others_.kept().end());
    std::sort(kept.begin(), kept.end(),
              [](const Event& a, const Event& b) { return a.line < b.line; });
    std::vector<std::uint8_t> steps;
    std::vector<std::uint8_t> kinds;
    std::vector<Point> places;
    std::vector<Point> parents;
    std::vector<float> values;
    std::vector<float> numbers;
    std::vector<float> means;
    std::vector<float> alive;
    for (const Event& event : kept) {
      steps.push_back(event.step);
      kinds.push_back(event.kind);
      places.push_back(event.at);
      parents.push_back(event.parent);
      values.push_back(event.value);
      if (event.kind == kIteration) {
        numbers.push_back(event.number);
        means.push_back(event.mean);
        alive.push_back(event.alive);
      }
    }
    return {
        {"events", count_},
        {"kept", kept.size()},
        {"steps", steps_},
        {"step", base64_of(steps)},
        {"kind", base64_of(kinds)},
        {"at", base64_of(places)},
        {"parent", base64_of(parents)},
        {"value", base64_of(values)},
        {"iterations",
         {{"number", base64_of(numbers)}, {"mean", base64_of(means)}, {"alive", base64_of(alive)}}},
        {"order", nullptr}};
  }

 private:
  std::uint8_t step_number(const std::string& id) {
    if (steps_.empty() || id != steps_[step_]) {
      step_ = std::size_t(std::find(steps_.begin(), steps_.end(), id) - steps_.begin());
      if (step_ == kMaxSteps) {
        throw Error("more than " + std::to_string(kMaxSteps) + " steps");
      }
      if (step_ == steps_.size()) {
        steps_.push_back(id);
      }
      nodes_.clear();  // each search numbers its own nodes
      is_population_ = false;
    }
    return std::uint8_t(step_);
  }
  static float number_or_none(const Json& json) {
    return json.is_null() ? std::numeric_limits<float>::quiet_NaN() : json.get<float>();
  }
  static std::uint8_t kind_number(std::string_view kind) {
    const auto found = std::find(kKinds.begin(), kKinds.end(), kind);
    if (found == kKinds.end()) {
      throw Error("unknown kind of event");
    }
    return std::uint8_t(found - kKinds.begin());
  }

  std::size_t count_ = 0;
  std::size_t step_ = 0;
  std::vector<std::string> steps_;
  std::unordered_map<std::int64_t, Point> nodes_;
  bool is_population_ = false;  // the search adds routes, not nodes
  Thinned iterations_{kMaxIterations};
  Thinned others_{kMaxEvents - kMaxIterations};
};

bool begins_a_trace(const std::string& line) {
  const Json json = json_or_discarded(line);
  return json.is_object() && json.contains("altiplan_trace") && json["altiplan_trace"] == 1;
}

/// Path of the trace: as written, or beside the result if both were moved.
std::filesystem::path find_trace(const StoredResult& stored, const std::string& written) {
  const std::filesystem::path beside =
      std::filesystem::path(stored.file).parent_path() / std::filesystem::path(written).filename();
  std::error_code error;
  return std::filesystem::exists(written, error) || !std::filesystem::exists(beside, error)
             ? std::filesystem::path(written)
             : beside;
}
}  // namespace

Json trace_scene(const StoredResult& stored, SceneNotes& notes,
                 const std::function<void(double share)>& progress) {
  constexpr std::size_t kReportEvery = 10'000;  // lines
  const Json& written = stored.json.at("trace");
  if (written.is_null()) {
    return nullptr;
  }
  const std::filesystem::path file = find_trace(stored, written.get<std::string>());
  if (const std::string why = formats::why_unreadable(file.string()); !why.empty()) {
    notes.warn(file.string() + ": " + why + ": the search is not shown");
    return nullptr;
  }
  formats::InputFile in(file.string());
  std::string line;
  if (!std::getline(in, line) || !begins_a_trace(line)) {
    notes.warn(file.string() + ":1: expected a trace of altiplan run: the search is not shown");
    return nullptr;
  }
  std::error_code unknown;
  const auto bytes = double(std::max<std::uintmax_t>(1, std::filesystem::file_size(file, unknown)));
  double read = 0;
  Reader reader;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    read += double(line.size() + 1);
    if (number % kReportEvery == 0) {
      progress(std::min(1.0, read / bytes));
    }
    try {
      reader.add(line);
    } catch (const std::exception&) {
      notes.warn(file.string() + ":" + std::to_string(number) +
                 ": this is not a search event: the search is shown up to here");
      break;
    }
  }
  return reader.json();
}
}  // namespace altiplan::host
