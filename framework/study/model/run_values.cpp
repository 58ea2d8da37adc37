// SPDX-License-Identifier: Apache-2.0
#include "study/model/run_values.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace altiplan::study {
namespace {

constexpr std::initializer_list<const char*> kOfFlightAlone = {
    "collisions",        "min_separation_m",   "reached",
    "cross_track_max_m", "cross_track_p999_m", "height_error_max_m"};

class Values {
 public:
  void add(const std::string& name, const host::Json& value) {
    if (value.is_boolean()) {
      all_[name] = value.get<bool>() ? 1 : 0;
    } else if (value.is_number()) {
      all_[name] = value.get<double>();
    }
  }
  void add_once(const std::string& name, const host::Json& value) {
    if (!all_.contains(name)) {
      add(name, value);
    }
  }
  void add_each(const std::string& prefix, const host::Json& map) {
    for (const auto& [name, value] : map.items()) {
      add(prefix + name, value);
    }
  }
  /// Cost, bound, and by what share of the bound the route may cost too much.
  void add_cost(const std::string& prefix, const host::Json& of) {
    const host::Json cost = of.value("cost", host::Json());  // results of former versions have none
    const host::Json bound = of.value("bound", host::Json());
    add(prefix + "cost", cost);
    add(prefix + "bound", bound);
    if (cost.is_number() && bound.is_number() && bound.get<double>() > 0) {
      all_[prefix + "gap"] = host::Cost{cost.get<double>(), bound.get<double>()}.gap();
    }
  }
  /// The published cost of the best route, and by what share of it the route costs more.
  void add_reference(const host::Json& result) {
    const host::Json reference = result.value("reference", host::Json());
    const host::Json cost = result.value("cost", host::Json());
    add("reference", reference);
    if (reference.is_number() && reference.get<double>() > 0 && cost.is_number()) {
      all_["reference_gap"] = cost.get<double>() / reference.get<double>() - 1;
    }
  }
  /// Sums over all replans: their time (s), and each of their counters.
  void add_replans(const host::Json& replans) {
    add("flight.replans", replans.size());
    for (const host::Json& replan : replans) {
      all_["flight.replan_time_s"] += replan.at("time_s").get<double>();
      for (const auto& [name, value] : replan.at("counters").items()) {
        all_["flight.replan_counters." + name] += value.get<double>();
      }
    }
  }
  std::vector<std::pair<std::string, double>> sorted() const { return {all_.begin(), all_.end()}; }

 private:
  std::map<std::string, double> all_;
};

std::vector<std::string> keys_of(const host::Json& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map.items()) {
    keys.push_back(key);
  }
  return keys;
}

std::vector<std::string> joined(std::vector<std::string> names,
                                std::initializer_list<const char*> more) {
  names.insert(names.end(), more.begin(), more.end());
  return names;
}
}  // namespace

RunValues values_of(const host::Json& result) {
  Values values;
  values.add_each("", result.at("metrics"));
  values.add("setup_time_s", result.at("setup_time_s"));
  values.add_cost("", result);
  values.add_reference(result);
  for (const host::Json& step : result.at("steps")) {
    const std::string prefix = "steps." + step.at("id").get<std::string>() + ".";
    values.add_each(prefix + "counters.", step.at("counters"));
    values.add_each(prefix, step.at("metrics"));
    // Last: of a step `time_s` is the wall time, not that of its route's flight.
    for (const char* name : {"time_s", "setup_time_s", "accepted", "budget_hit"}) {
      values.add(prefix + name, step.at(name));
    }
    values.add_cost(prefix, step);
    if (const auto first = step.find("first_route_s"); first != step.end()) {
      values.add(prefix + "first_route_s", *first);
      values.add_once("first_route_s", *first);
    }
  }
  if (const auto task = result.find("task"); task != result.end() && task->is_object()) {
    values.add("task.bound_s", task->at("bound_s"));
    values.add("task.flights", task->at("flights").size());
  }
  if (const host::Json& flight = result.at("flight"); !flight.is_null()) {
    for (const char* name : kOfFlightAlone) {
      if (const auto value = flight.find(name); value != flight.end()) {
        values.add(std::string("flight.") + name, *value);
      }
    }
    values.add_replans(flight.at("replans"));
    values.add("flight.handovers", flight.at("handovers").size());
    values.add_each("flight.counters.", flight.at("counters"));
    values.add_each("flight.", flight.at("metrics"));
  }
  return values.sorted();
}

std::string why_no_value(const std::string& name, const std::vector<std::string>& metrics) {
  static const std::vector<std::string> kOfRoute = keys_of(host::to_json(Measures{}));
  static const std::vector<std::string> kOfRun =
      joined(kOfRoute, {"plan_time_s", "smooth_time_s", "expanded", "setup_time_s", "solved",
                        "wall_time_s", "cpu_time_s", "peak_memory_mb", "cost", "bound", "gap",
                        "reference", "reference_gap", "first_route_s"});
  static const std::vector<std::string> kOfStep =
      joined(kOfRoute, {"time_s", "setup_time_s", "first_route_s", "accepted", "budget_hit", "cost",
                        "bound", "gap"});
  static const std::vector<std::string> kOfFlight =
      joined(joined(kOfRoute, kOfFlightAlone), {"replans", "replan_time_s", "handovers"});
  const std::size_t last = name.rfind('.');
  const std::string end = name.substr(last == std::string::npos ? 0 : last + 1);
  const std::string before = last == std::string::npos ? "" : name.substr(0, last);
  const bool is_of_flight = before == "flight";
  const bool is_of_step = before.starts_with("steps.") && before.size() > 6;
  if (before == "flight.counters" || before == "flight.replan_counters" ||
      (is_of_step && before.ends_with(".counters"))) {
    return "";  // plugins choose the names of their counters
  }
  if (name == "task.bound_s" || name == "task.flights") {
    return "";
  }
  if (!before.empty() && !is_of_flight && !is_of_step) {
    return "no run has a value '" + name +
           "': expected a value of the run, or flight.…, flight.counters.…, "
           "flight.replan_counters.…, steps.ID.…, steps.ID.counters.…";
  }
  std::vector<std::string> known = is_of_flight ? kOfFlight : is_of_step ? kOfStep : kOfRun;
  known.insert(known.end(), metrics.begin(), metrics.end());
  if (std::find(known.begin(), known.end(), end) != known.end()) {
    return "";
  }
  if (is_of_step && end == "stands") {
    return "no run has a value '" + name + "': stands is now accepted";
  }
  const std::string nearest = nearest_name(end, known);
  return "no run has a value '" + name + "'" +
         (nearest.empty()
              ? ""
              : "; did you mean '" + (before.empty() ? "" : before + ".") + nearest + "'?");
}

std::string why_no_part(const std::string& name, const std::vector<PipelineParts>& pipelines) {
  constexpr std::string_view kSteps = "steps.";
  const bool is_of_step = name.starts_with(kSteps);
  const auto may_have = [&](const PipelineParts& pipeline) {
    const auto is_its = [&](const std::string& step) {
      return name.starts_with(std::string(kSteps) + step + ".");
    };
    return !pipeline.is_known ||
           (is_of_step ? std::any_of(pipeline.steps.begin(), pipeline.steps.end(), is_its)
                       : pipeline.flies);
  };
  if ((!is_of_step && !name.starts_with("flight.")) ||
      std::any_of(pipelines.begin(), pipelines.end(), may_have)) {
    return "";
  }
  const bool is_one = pipelines.size() == 1;
  const std::string who = is_one ? "it has no " : "no pipeline has a ";
  const std::string why = "no run" + (is_one ? " of '" + pipelines[0].name + "'" : "") +
                          " has a value '" + name + "': " + who;
  if (!is_of_step) {
    return why + "fly step";
  }
  std::set<std::string> steps;
  for (const PipelineParts& pipeline : pipelines) {
    steps.insert(pipeline.steps.begin(), pipeline.steps.end());
  }
  const std::size_t end = std::min(name.find('.', kSteps.size()), name.size());
  const std::string step = name.substr(kSteps.size(), end - kSteps.size());
  const std::string near = nearest_name(step, {steps.begin(), steps.end()});
  std::string all;
  for (const std::string& one : steps) {
    all += (all.empty() ? "" : ", ") + one;
  }
  return why + "step '" + step + "'" +
         (near.empty() ? ", only " + all
                       : "; did you mean '" + std::string(kSteps) + near + name.substr(end) + "'?");
}

bool is_own_metric(const std::string& name) {
  return name.find('.') == std::string::npos && !why_no_value(name).empty();
}
}  // namespace altiplan::study
