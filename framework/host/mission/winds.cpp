// SPDX-License-Identifier: Apache-2.0
#include "host/mission/winds.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "altiplan/geometry.hpp"
#include "host/config/config_check.hpp"
#include "host/mission/wind_grid.hpp"

namespace altiplan::host {
namespace {

/// Reads the winds of a scenario.
class Winds {
 public:
  Winds(const Config& config, Mission& mission) : config_(config), mission_(mission) {}

  Wind read() {
    const WindEntry& entry = config_.scenario.wind;
    Wind wind{layers_of(entry, "wind"), {}};
    for (std::size_t i = 0; i < entry.hours.size(); ++i) {
      begins_s_ = begin_of(entry.hours[i]);
      ends_s_ = i + 1 < entry.hours.size() ? begin_of(entry.hours[i + 1]) : begins_s_;
      std::vector<Wind::Layer> layers = layers_of(entry.hours[i], item("wind.hours", i));
      if (begins_s_ <= 0) {
        wind.layers = std::move(layers);
      } else {
        wind.changes.push_back({begins_s_, std::move(layers)});
      }
    }
    return wind;
  }

 private:
  /// Seconds after the start.
  double begin_of(const WindHourEntry& hour) const {
    return formats::parse_iso_time(hour.from_time).value() -  // checked on reading
           mission_.site.start_time_s;
  }

  /// Of one time; `key` is that of its entry in the scenario.
  std::vector<Wind::Layer> layers_of(const WindLayersEntry& entry, const std::string& key) {
    std::vector<Wind::Layer> layers;
    if (entry.speed_mps.value_or(0) > 0 || !entry.grid.text.empty()) {
      layers.push_back(layer_of(entry, -kInfinity, key));
    }
    for (std::size_t i = 0; i < entry.layers.size(); ++i) {
      const WindLayerEntry& layer = entry.layers[i];
      layers.push_back(layer_of(layer, layer.above_m, item(key + ".layers", i)));
    }
    return layers;
  }

  Wind::Layer layer_of(const WindKindEntry& entry, double above_m, const std::string& key) {
    if (entry.grid.text.empty()) {
      return {above_m, -*entry.speed_mps * unit_heading(radians(90 - *entry.from_deg))};
    }
    const Site& site = mission_.site;
    try {
      const WindFile file = read_wind_grid(entry.grid.text, entry.bands, site.frame, site.volume);
      if (file.valid_s && site.has_start_time) {
        expect_near(*file.valid_s - site.start_time_s, key);
      }
      return {above_m, {0, 0, 0}, file.grid};
    } catch (const Error& error) {
      throw ConfigError(place_of(config_.scenario_tree, key + ".grid"), key + ".grid",
                        error.what());
    }
  }

  /// Warns of a wind of another hour than that in which it is to blow.
  void expect_near(double valid_s, const std::string& key) {
    constexpr double kNear = 1.5 * 3600;  // a forecast is of every third hour, or of every one
    const double start_s = mission_.site.start_time_s;
    const double off_s = std::max(begins_s_ - valid_s, valid_s - ends_s_);
    if (off_s > kNear) {
      mission_.warnings.push_back(
          key + ".grid: the wind is of " + formats::iso_time(start_s + valid_s) +
          (begins_s_ == 0 && ends_s_ == 0
               ? ", the flight starts at " + formats::iso_time(start_s) +
                     ": wind.hours has winds of other hours"
               : ", and is to blow from " + formats::iso_time(start_s + begins_s_) + " on"));
    }
  }

  const Config& config_;
  Mission& mission_;
  // Seconds after the start: from when on the wind that is read is to blow, and until when.
  double begins_s_ = 0;
  double ends_s_ = 0;
};
}  // namespace

void expect_one_wind(const Config& config) {
  const std::vector<WindHourEntry>& hours = config.scenario.wind.hours;
  const bool changes = !hours.empty() && formats::parse_iso_time(hours.back().from_time) >
                                             formats::parse_iso_time(*config.scenario.start_time);
  if (!changes) {
    return;
  }
  constexpr const char* kOneWind = " knows one wind, and this one changes: give that of one hour";
  const auto refuse = [](const Location& where, const std::string& key, const char* what) {
    throw ConfigError(where, key, std::string(what) + kOneWind);
  };
  const ScenarioFile& file = config.scenario;
  if (file.vehicle.body) {
    refuse(place_of(config.scenario_tree, "vehicle.body"), "vehicle.body", "a body's attitude");
  }
  if (file.task) {
    refuse(place_of(config.scenario_tree, "task"), "task", "a task");
  }
  if (file.start.takeoff) {
    refuse(place_of(config.scenario_tree, "start.takeoff"), "start.takeoff", "a take-off run");
  }
  if (file.goal.landing) {
    refuse(place_of(config.scenario_tree, "goal.landing"), "goal.landing", "a landing");
  }
  for (const StepEntry& step : config.steps) {
    if (step.verb == Verb::fly) {
      refuse(step.where, step.path + ".fly", "a flight");
    }
  }
}

Wind read_winds(const Config& config, Mission& mission) {
  expect_one_wind(config);
  return Winds(config, mission).read();
}
}  // namespace altiplan::host
