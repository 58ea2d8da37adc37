// SPDX-License-Identifier: Apache-2.0
#include "host/mission/mission.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "altiplan/attributed.hpp"
#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/field.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "host/autopilot/parameters.hpp"
#include "host/base/shapes.hpp"
#include "host/config/config_check.hpp"
#include "host/mission/coverage.hpp"
#include "host/mission/runways.hpp"
#include "host/mission/scale_note.hpp"
#include "host/mission/vehicle.hpp"
#include "host/mission/volume.hpp"
#include "host/mission/winds.hpp"

namespace altiplan::host {
namespace {

std::vector<MovingObstacle> moving_of(const Config& config, const Site& site, const Box& volume,
                                      bool level) {
  std::vector<MovingObstacle> all;
  for (std::size_t i = 0; i < config.scenario.moving.size(); ++i) {
    const MovingEntry& entry = config.scenario.moving[i];
    const Value& tree = config.scenario_tree.find("moving")->items[i];
    const bool known = entry.known.value_or(true);
    const bool planned = entry.known.value_or(false);
    if (entry.shape == "random") {
      RandomMoving random;
      bind(random, &entry.parameters);
      RandomStream stream = random.seed ? RandomStream(std::uint64_t(*random.seed)) : site.random;
      stream = stream.sub("moving:" + entry.id);
      for (int n = 0; n < random.count; ++n) {
        RandomStream draw = stream.sub("sphere", std::uint64_t(n));
        const Vec3 at = draw.in(volume);
        const double heading = draw.uniform(0, 2 * kPi);
        const double climb = level ? 0 : draw.uniform(-0.1, 0.1);
        const Vec3 direction(std::cos(heading) * std::cos(climb),
                             std::sin(heading) * std::cos(climb), std::sin(climb));
        all.push_back({entry.id + "_" + std::to_string(n + 1), Sphere{at, random.radius_m},
                       direction * random.speed_mps, 0, known, planned});
      }
      continue;
    }
    try {
      const MovingShape made = make_moving(entry.shape, entry.parameters, site);
      all.push_back({entry.id, made.shape, made.velocity, 0, known, planned});
    } catch (const ConfigError&) {
      throw;
    } catch (const Error& error) {
      throw ConfigError(place_of(tree, entry.shape), "moving." + std::to_string(i), error.what());
    }
  }
  return all;
}

using Calling = std::function<void(const std::string&)>;

/// The parameters of a constraint; its largest distance from the ground, or total, less what
/// lengths are off by, where routes are only judged.
Value parameters_of(const ConstraintEntry& entry, double scale_error) {
  Value parameters = entry.parameters;
  const char* key = entry.plugin == "ground_distance" ? "max_m"
                    : entry.plugin == "limit"         ? "maximum"
                                                      : "";
  if (Value* limit = parameters.find(key)) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", std::atof(limit->text.c_str()) / (1 + scale_error));
    limit->text = text;
  }
  return parameters;
}

/// `scale_error`: of lengths, by which limits on them are tightened.
std::vector<NamedConstraint> constraints_of(const Config& config, const Site& site,
                                            double scale_error, const Calling& calling) {
  std::vector<NamedConstraint> all;
  for (const auto* entries : {&config.scenario.constraints, &config.pipeline.constraints}) {
    for (const ConstraintEntry& entry : *entries) {
      const std::string who = "the constraint '" + entry.plugin + "'";
      calling(who + ": its constructor");
      try {
        const Value parameters =
            scale_error > 0 ? parameters_of(entry, scale_error) : entry.parameters;
        const std::string key = "constraints." + entry.plugin;
        all.push_back({entry.plugin, entry.plugin == "limit"
                                         ? limit_of(config, parameters, site, key)
                                         : plugin(*config.registry, "constraint", entry.plugin)
                                               .constraint(&parameters, site)});
      } catch (const ConfigError&) {
        throw;
      } catch (const PluginError& error) {
        throw PluginError(who + " " + error.what(), error.reason());
      } catch (const Error& error) {
        throw ConfigError(entry.parameters.where, "constraints." + entry.plugin, error.what());
      }
      if (all.back().constraint == nullptr) {
        throw PluginError(who + " made no object");
      }
    }
  }
  return all;
}

/// The point, or nothing if it depends on a layer that is not built yet.
std::optional<Vec3> maybe_point(const Point& point, const Site& site,
                                const std::optional<double>& level) {
  try {
    return resolve_point(point, site, level, {}, "");
  } catch (const Error&) {
    return std::nullopt;
  }
}
}  // namespace

Vec3 resolve_point(const Point& point, const Site& site, const std::optional<double>& level_m,
                   const Location& where, const std::string& key) {
  try {
    Vec3 p = site.resolve(point);
    if (level_m && !point.has_height && !point.above_ground_m) {
      p.z() = *level_m;
    }
    return p;
  } catch (const Error& error) {
    const std::string why =
        site.before == nullptr
            ? ""
            : beside(point, site.frame, "the elevation model", ground_area(*site.before));
    throw ConfigError(where, key, why.empty() ? error.what() : why);
  }
}

namespace {
using namespace std::string_literals;

/// Checks what every use of a layer relies on.
void expect_sound(const Layer& layer) {
  if (layer.environment == nullptr) {
    throw PluginError("made no object");
  }
  const auto [slack, box] =
      attributed([] { return "when asked for its bounds, ground, cells, threats or notes"s; },
                 [&] {
                   const Environment& asked = *layer.environment;
                   // Whatever can throw does so here, not in a later query.
                   (void)(asked.ground(), asked.info());
                   return std::pair(asked.over_approximation(), asked.bounds());
                 });
  if (!(slack >= 0 && std::isfinite(slack))) {
    throw PluginError("violated the contract of its interface: its over-approximation is " +
                      std::to_string(slack) + ", expected a length of at least 0");
  }
  for (int axis = 0; axis < 3; ++axis) {
    const bool crossed = std::isfinite(box.min[axis]) && box.max[axis] < box.min[axis];
    if (crossed || std::isnan(box.min[axis]) || std::isnan(box.max[axis])) {
      throw PluginError("violated the contract of its interface: its bounds reach from " +
                        std::to_string(box.min[axis]) + " to " + std::to_string(box.max[axis]) +
                        " on an axis");
    }
  }
}
}  // namespace

Layer build_layer(const Config& config, const std::string& plugin_name, const Value& parameters,
                  const std::string& id, bool known, Site site, const std::string& key) {
  site.random = RandomStream(std::uint64_t(config.seed)).sub("layer:" + id);
  const PluginEntry& entry = plugin(*config.registry, "environment", plugin_name);
  try {
    Layer layer{id, plugin_name, entry.environment(&parameters, site), known};
    expect_sound(layer);
    return layer;
  } catch (const ConfigError&) {
    throw;
  } catch (const PluginError& error) {
    throw PluginError("the environment '" + plugin_name + "' (" + key + ") " + error.what(),
                      error.reason());
  } catch (const ParameterError& error) {
    throw ConfigError(place_of(parameters, error.key()), key + "." + error.key(), error.what());
  } catch (const Error& error) {
    throw ConfigError(parameters.where, key, error.what());
  }
}

namespace {
/// True if the scenario has the end of the route: with a task it need not.
bool is_given(const Config& config, std::string_view end) {
  return !config.scenario.task || config.scenario_tree.find(end) != nullptr;
}

/// Start, via points and goal; none if one of them depends on a layer that is not built yet.
std::vector<Vec3> maybe_points(const Config& config, const Site& site) {
  const ScenarioFile& file = config.scenario;
  std::vector<const Point*> all;
  if (is_given(config, "start")) {
    all.push_back(&file.start.point);
  }
  if (is_given(config, "goal")) {
    all.push_back(&file.goal.point);
  }
  for (const GoalEntry& via : file.via) {
    all.push_back(&via.point);
  }
  std::vector<Vec3> points;
  for (const Point* point : all) {
    if (const auto placed = maybe_point(*point, site, file.level_flight_at_m)) {
      points.push_back(*placed);
    }
  }
  return points.size() == all.size() ? points : std::vector<Vec3>{};
}

bool is_solid(std::string_view plugin) {
  const std::span<const PluginEntry> solids = built_in_environments();
  return std::any_of(solids.begin(), solids.end(),
                     [&](const PluginEntry& solid) { return plugin == solid.name; });
}

/// Builds the layers in order, each with access to those before it.
void build_layers(const Config& config, Mission& mission, const Calling& calling,
                  const NoteSink& on_note) {
  const ScenarioFile& file = config.scenario;
  Site& site = mission.site;
  World& truth = mission.truth;
  const std::optional<double>& level = file.level_flight_at_m;
  for (std::size_t i = 0; i < file.environment.size(); ++i) {
    const LayerEntry& entry = file.environment[i];
    site.frame = truth.frame();
    site.before = &truth;
    if (is_given(config, "start")) {
      site.start = maybe_point(file.start.point, site, level);
    }
    if (is_given(config, "goal")) {
      site.goal = maybe_point(file.goal.point, site, level);
    }
    site.volume = asked_volume(file, maybe_points(config, site));
    const std::string key = "environment." + std::to_string(i) + "." + entry.plugin;
    if (!is_solid(entry.plugin)) {  // of ten thousand solids, each call would cost more than they
      calling("the environment '" + entry.plugin + "' (" + key + "): its constructor");
    }
    Layer layer =
        build_layer(config, entry.plugin, entry.parameters, entry.id, entry.known, site, key);
    const LayerInfo& info = layer.environment->info();
    for (const std::string& note : info.notes) {
      mission.notes.push_back(entry.id + ": " + note);
      on_note(mission.notes.back());
    }
    truth = std::move(truth).with(std::move(layer));
    if (info.frame && !truth.frame().has_position()) {
      truth = truth.with_frame(*info.frame);
    }
  }
}

/// "x 0 to 29600, y 0 to 31600, z 0 to 1800 m".
std::string extent(const Box& box) {
  char text[200];
  std::snprintf(text, sizeof text, "x %.0f to %.0f, y %.0f to %.0f, z %.0f to %.0f m", box.min.x(),
                box.max.x(), box.min.y(), box.max.y(), box.min.z(), box.max.z());
  return text;
}

/// Warns of a layer that is empty or does not touch the volume, and so has no effect: usually a
/// mistake, such as latitude and longitude swapped in its file.
void warn_of_distant_layers(Mission& mission) {
  for (const Layer& layer : mission.truth.layers()) {
    const Box box = layer.environment->bounds();
    if (!box.is_empty() && box.intersected(mission.site.volume).is_empty()) {
      mission.warnings.push_back("'" + layer.id + "' (" + layer.plugin + ") at " + extent(box) +
                                 " does not touch the volume at " + extent(mission.site.volume) +
                                 ": check its position");
    } else if (box.is_empty() && layer.environment->field() == nullptr) {
      const std::vector<std::string>& notes = layer.environment->info().notes;
      mission.warnings.push_back("'" + layer.id + "' (" + layer.plugin + ") holds nothing here" +
                                 (notes.empty() ? "" : ": " + notes.back()));
    }
  }
}

/// The part of the world that is known at take-off.
World known_part(const World& truth) {
  World known = truth;
  for (const Layer& layer : truth.layers()) {
    if (!layer.known) {
      known = known.without(layer.id);
    }
  }
  std::vector<MovingObstacle> moving;
  for (const MovingObstacle& obstacle : truth.moving()) {
    if (obstacle.known) {
      moving.push_back(obstacle);
    }
  }
  return known.with_moving(std::move(moving));
}

/// The site that the layers are built from, without what they add to it.
Site site_of(const Config& config) {
  const ScenarioFile& file = config.scenario;
  Site site;
  site.vehicle = vehicle_of(file.vehicle, config.scenario_tree.find("vehicle"), *config.registry);
  site.frame_crs = file.frame.crs;
  site.about = config.about;
  site.random = RandomStream(std::uint64_t(config.seed));
  if (file.start_time) {
    site.start_time_s = formats::parse_iso_time(*file.start_time).value();  // checked on reading
    site.has_start_time = true;
  }
  return site;
}

std::optional<double> heading_of(const std::optional<double>& compass_deg) {
  return compass_deg ? std::optional(radians(90 - *compass_deg)) : std::nullopt;
}

std::optional<Loiter> loiter_of(const std::optional<LoiterEntry>& entry) {
  return entry ? std::optional(Loiter{entry->radius_m, entry->left ? 1 : -1}) : std::nullopt;
}

/// Throws ConfigError for a point given in degrees that lies outside the volume.
void expect_within(const Config& config, const Mission& mission) {
  const ScenarioFile& file = config.scenario;
  const Value& tree = config.scenario_tree;
  const auto expect = [&](const Point& point, const Location& where, const std::string& key) {
    const std::string why =
        beside(point, mission.site.frame, "the volume", mission.site.volume.grown(1));
    if (!why.empty()) {
      throw ConfigError(where, key, why);
    }
  };
  if (is_given(config, "start")) {
    expect(file.start.point, place_of(tree, "start"), "start");
  }
  if (is_given(config, "goal")) {
    expect(file.goal.point, place_of(tree, "goal"), "goal");
  }
  for (std::size_t i = 0; i < file.via.size(); ++i) {
    expect(file.via[i].point, tree.find("via")->items[i].where, item("via", i));
  }
}

/// Throws ConfigError for a place so far from the frame's origin that zones there are left out.
void expect_in_frame(const Config& config, const Mission& mission) {
  const Frame& frame = mission.site.frame;
  const auto expect = [&](const Vec3& there, const Location& where, const std::string& key) {
    const LonLat lonlat = frame.to_lonlat(there.x(), there.y());
    if (!formats::are_in_frame({lonlat}, frame)) {
      throw ConfigError(where, key,
                        "lies more than 20 degrees from the origin of the world's frame, which its "
                        "first layer with a position gives: zones there are not known in it; put "
                        "a layer about the flight first, or give " +
                            frame_about(lonlat));
    }
  };
  const Value& tree = config.scenario_tree;
  if (!frame.has_position()) {
    return;
  }
  if (mission.ends.start) {
    expect(*mission.ends.start, place_of(tree, "start"), "start");
  }
  if (mission.ends.goal) {
    expect(*mission.ends.goal, place_of(tree, "goal"), "goal");
  }
  for (std::size_t i = 0; i < mission.via.size(); ++i) {
    expect(mission.via[i].position, tree.find("via")->items[i].where, item("via", i));
  }
}

/// Resolves start, goal and via points, in the frame that is now known.
void place_points(const Config& config, Mission& mission) {
  const ScenarioFile& file = config.scenario;
  const Value& tree = config.scenario_tree;
  Site& site = mission.site;
  Request& request = mission.request;
  const auto placed = [&](const Point& point, const Location& where, const std::string& key) {
    return resolve_point(point, site, file.level_flight_at_m, where, key);
  };
  if (is_given(config, "start")) {
    request.start.position = placed(file.start.point, place_of(tree, "start"), "start");
    mission.ends.start = request.start.position;
  }
  if (is_given(config, "goal")) {
    request.goal = {placed(file.goal.point, place_of(tree, "goal"), "goal"), file.goal.tolerance_m,
                    heading_of(file.goal.heading_deg), loiter_of(file.goal.loiter)};
    mission.ends.goal = request.goal.position;
  }
  request.start.loiter = loiter_of(file.start.loiter);
  site.start = mission.ends.start;
  site.goal = mission.ends.goal;
  for (std::size_t i = 0; i < file.via.size(); ++i) {
    mission.via.push_back(
        {placed(file.via[i].point, tree.find("via")->items[i].where, "via." + std::to_string(i)),
         file.via[i].tolerance_m, heading_of(file.via[i].heading_deg),
         loiter_of(file.via[i].loiter)});
  }
}
}  // namespace

namespace {
/// Builds the task in the world of all layers, and adds what it keeps out of as one more.
void add_task(const Config& config, Mission& mission, const Calling& calling) {
  const TaskEntry& entry = *config.scenario.task;
  const std::string who = "the task '" + entry.plugin + "'";
  calling(who + ": its constructor");
  Site site = mission.site;
  site.before = &mission.truth;
  site.random = RandomStream(std::uint64_t(config.seed)).sub("task");
  if (const auto level = config.scenario.level_flight_at_m) {
    site.volume.min.z() = site.volume.max.z() = *level;
  }
  try {
    mission.task = plugin(*config.registry, "task", entry.plugin).task(&entry.parameters, site);
    if (mission.task == nullptr) {
      throw PluginError("made no object");
    }
    if (auto obstacles = mission.task->obstacles()) {
      const bool is_taken = mission.truth.find(entry.plugin) != nullptr;
      Layer layer{entry.plugin + (is_taken ? "_task" : ""), entry.plugin, std::move(obstacles)};
      expect_sound(layer);
      mission.truth = std::move(mission.truth).with(std::move(layer));
    }
  } catch (const ConfigError&) {
    throw;
  } catch (const PluginError& error) {
    throw PluginError(who + " " + error.what(), error.reason());
  } catch (const ParameterError& error) {
    throw ConfigError(place_of(entry.parameters, error.key()),
                      "task." + entry.plugin + "." + error.key(), error.what());
  } catch (const Error& error) {
    throw ConfigError(entry.parameters.where, "task." + entry.plugin, error.what());
  }
}
}  // namespace

TaskOrder order_of_task(const Mission& mission, Budget budget) {
  Request request = mission.request;
  request.budget = std::move(budget);
  request.random = mission.request.random.sub("task:order");
  return mission.task->order(request, mission.ends);
}

namespace {
/// What judging the returns of a route takes: places on the Earth, and ground.
void expect_returns(const Config& config, const World& world) {
  for (const StepEntry& step : config.steps) {
    if (step.verb != Verb::returns) {
      continue;
    }
    if (!world.frame().has_position() || !world.has_ground()) {
      throw ConfigError(step.where, step.path + ".returns",
                        std::string("returns are flown over known ground: the scenario's world ") +
                            (world.has_ground() ? "is not georeferenced" : "has no terrain"));
    }
    if (step.params) {
      try {
        static_cast<void>(read_parameters(step.params->text));
      } catch (const Error& error) {
        throw ConfigError(step.where, step.path + ".params", error.what());
      }
    }
  }
}
}  // namespace

Mission build_mission(const Config& config, int threads, const Calling& given,
                      const NoteSink& noted) {
  const auto ignore = [](const std::string&) {};
  const Calling calling = given ? given : ignore;
  const NoteSink on_note = noted ? noted : ignore;
  const auto began = std::chrono::steady_clock::now();
  const ScenarioFile& file = config.scenario;
  Mission mission;
  mission.notes = config.notes;
  std::for_each(mission.notes.begin(), mission.notes.end(), on_note);
  mission.site = site_of(config);
  mission.vehicle_type = file.vehicle.flown_as();
  Site& site = mission.site;
  if (file.frame.origin_lonlat) {
    const LonLat& origin = *file.frame.origin_lonlat;
    mission.truth = mission.truth.with_frame(
        file.frame.crs == "local" ? Frame::local(origin)
                                  : Frame::geographic(origin[0], origin[1], origin[1]));
  }
  build_layers(config, mission, calling, on_note);
  World& truth = mission.truth;
  if (!file.frame.crs.empty() && !file.frame.origin_lonlat && !truth.has_ground()) {
    throw ConfigError(place_of(config.scenario_tree, "frame"), "frame.crs",
                      "only an elevation model (terrain) can be warped to a coordinate system, "
                      "and the world has none: give origin_lonlat, a point near the flight");
  }
  expect_returns(config, truth);
  const std::optional<double>& level = file.level_flight_at_m;
  site.frame = truth.frame();
  site.before = &truth;
  Request& request = mission.request;
  request.vehicle = site.vehicle;
  place_points(config, mission);
  if (file.task) {
    add_task(config, mission, calling);
  }
  site.volume = volume_of(config, mission, maybe_points(config, site), on_note);
  if (!config.is_only_judged) {
    expect_within(config, mission);
    expect_in_frame(config, mission);
  }
  request.wind = site.wind = read_winds(config, mission);
  if (const auto heading = heading_of(file.start.heading_deg)) {
    request.start.velocity = request.ground_velocity({request.start.position, *heading});
  }
  const double off = note_scale(mission, on_note);
  // What is clear must be so whichever way the frame is wrong.
  const double scale_error = config.is_only_judged ? off : 0;
  warn_of_distant_layers(mission);
  truth = truth.with_moving(moving_of(config, site, site.volume, level.has_value()));

  request.volume = site.volume;
  request.level_m = level;
  request.threads = threads;
  request.random = site.random;
  mission.known = known_part(truth);
  request.world = std::make_shared<const World>(mission.known);
  if (config.objective() != nullptr) {
    calling("the objective '" + config.objective()->plugin + "': its constructor");
    request.objective = objective_of(config, site);
  }
  mission.metrics = metrics_of(config, site, calling);
  const std::vector<NamedConstraint> constraints =
      constraints_of(config, site, scale_error, calling);
  mission.track_request = request;
  apply_constraints(request, constraints, AppliesTo::route);
  apply_constraints(mission.track_request, constraints, AppliesTo::track);
  request.vehicle.radius_m *= 1 + scale_error;
  request.limits.min_clearance *= 1 + scale_error;
  add_runways(file, mission);
  calling("");
  site.before = nullptr;
  mission.setup_time_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return mission;
}
}  // namespace altiplan::host
