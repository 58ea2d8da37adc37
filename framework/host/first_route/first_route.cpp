// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/first_route.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/first_route/zones.hpp"
#include "host/mission/runways.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

constexpr double kCopterSpeed = 10;    // as ArduPilot's WP_SPD is by default,
constexpr double kPx4CopterSpeed = 5;  // and PX4's MPC_XY_CRUISE
constexpr double kCopterRadius = 1;
constexpr double kBank = 30;  // degrees
constexpr double kMaxBank = 60;
constexpr double kGravity = 9.80665;

/// How far a copter's flight may be off the drawn route: corners are rounded, and numbers stored,
/// within it.
constexpr double kFlownWithin = 3;

/// From zones, its radius included: it leaves its line at corners, by what autopilots accept.
constexpr double kCopterFromZones = 5;

/// The same of the heights of an aeroplane, which lag behind slopes.
constexpr double kWingHeightWithin = 6;

/// Of an aeroplane's turn radius: clearance from islands, and how far rows go on beyond an area.
constexpr double kIslandRadii = 1.2;
constexpr double kBeyondRadii = 1.5;

/// How far beside its line an aeroplane may fly, with its radius and some more.
constexpr double kWingFlownWithin = 12;

struct Try {
  int width;
  int fineness;
};
constexpr Try kTry[FirstRoute::kTries] = {{0, 1}, {1, 1}, {2, 1}, {1, 2}};

/// As short as it is exact.
std::string text_of(double value) {
  const std::string text = exact_json_text(value);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}
std::string whole(double value) { return with_digits(std::round(value), 9); }

std::string in_metres(double value) { return with_digits(value, 5) + " m"; }

/// Within a millimetre, which is what scenarios say.
formats::Ring in_frame(const formats::Ring& lonlat, const Frame& frame) {
  formats::Ring ring;
  for (const auto& [lon, lat] : lonlat) {
    const auto [x, y] = frame.to_local(lon, lat);
    ring.push_back({std::round(x * 1000) / 1000, std::round(y * 1000) / 1000});
  }
  return formats::without_repeats(ring);
}

/// What lies within a distance of a leg, but beyond its ends.
formats::Ring beside(const formats::Point2& from, const formats::Point2& to, double distance) {
  const double x = to[0] - from[0];
  const double y = to[1] - from[1];
  const double k = distance / std::hypot(x, y);
  return {{from[0] + k * y, from[1] - k * x},
          {to[0] + k * y, to[1] - k * x},
          {to[0] - k * y, to[1] + k * x},
          {from[0] - k * y, from[1] + k * x}};
}

double ring_m2(const formats::Ring& ring) {
  double twice = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    twice += formats::cross(ring[0], ring[i - 1], ring[i]);
  }
  return std::abs(twice) / 2;
}

std::string text_of(const formats::Ring& ring) {
  std::string text;
  for (const auto& [x, y] : ring) {
    text += (text.empty() ? "[[" : ", [") + text_of(x) + ", " + text_of(y) + "]";
  }
  return text + "]";
}

/// The whole flight is at the height of the photos, within their tolerance.
WishedHeights heights_of_photos(const RouteWish& wish, const SurveyLines& lines) {
  WishedHeights heights;
  heights.min_m = lines.above_ground_m - lines.off_m;
  heights.max_m = lines.above_ground_m + lines.off_m;
  heights.ends_m = lines.above_ground_m;
  if (wish.turn_radius_m) {  // it turns between the lines, where it may be higher and lower
    heights.min_m = std::min(WishedHeights().min_m, lines.above_ground_m / 2);
    heights.min_m = wish.min_above_ground_m.value_or(heights.min_m);
    heights.max_m = wish.max_above_ground_m;
  }
  const std::string needed =
      " m above ground that photos of " + with_digits(100 * wish.survey->gsd_m, 4) + " cm take";
  const double low = lines.above_ground_m - lines.off_m;
  const double high = lines.above_ground_m + lines.off_m;
  if (wish.min_above_ground_m.value_or(0) > low) {
    throw Error("--min-agl: " + in_metres(*wish.min_above_ground_m) + " is above the " +
                with_digits(low, 4) + needed + ": raise --gsd-cm");
  }
  if (wish.max_above_ground_m.value_or(kInfinity) < high) {
    throw Error("--max-agl: " + in_metres(*wish.max_above_ground_m) + " is below the " +
                with_digits(high, 4) + needed + ": lower --gsd-cm");
  }
  return heights;
}

/// A file below the current folder is named from the new one, so that both can be moved together.
std::string path_in(const fs::path& folder, const fs::path& file) {
  const fs::path absolute = fs::absolute(file).lexically_normal();
  const fs::path below = absolute.lexically_relative(fs::current_path());
  if (below.empty() || *below.begin() == "..") {
    return absolute.string();
  }
  return absolute.lexically_relative(fs::absolute(folder).lexically_normal()).string();
}
}  // namespace

FirstRoute::FirstRoute(const RouteWish& wish, const std::vector<fs::path>& plugin_path)
    : wish_(wish),
      heights_(heights_of(wish)),
      registry_(std::make_shared<Registry>(Registry::search_path(plugin_path))),
      corridor_(wish, *registry_) {
  for (const fs::path& file : wish_.avoid) {
    try {
      zone_parameters_.push_back(
          zone_parameters(file, {wish_.start_time.has_value(), wish_.buffer_m, wish_.permitted}));
    } catch (const Error& error) {
      throw Error(std::string("--avoid: ") + error.what());
    }
  }
  if (wish_.survey) {
    lines_ = lines_of(*wish_.survey);
    heights_ = heights_of_photos(wish_, *lines_);
    if (wish_.turn_radius_m && !wish_.survey->line.empty()) {
      throw Error("--wing: an aeroplane photographs areas; " + wish_.survey->file.string() +
                  " has a line, which a copter follows");
    }
  }
  expect_flyable();
  reach_runways();
  if (wish_.survey) {
    for (const SurveyArea& area : wish_.survey->areas) {
      formats::Polygon& own = areas_.emplace_back();
      own.outline = in_frame(area.polygon.outline, corridor_.frame());
      for (const formats::Ring& hole : area.polygon.holes) {
        own.holes.push_back(in_frame(hole, corridor_.frame()));
      }
    }
    line_ = in_frame(wish_.survey->line, corridor_.frame());
    for (std::size_t i = 1; i < line_.size() && wish_.survey->width_m > 0; ++i) {
      areas_.push_back({beside(line_[i - 1], line_[i], wish_.survey->width_m / 2), {}});
    }
  }
}

Vec3 FirstRoute::local(const WishedPoint& point) const {
  const auto [x, y] = corridor_.frame().to_local(point.lon, point.lat);
  return {x, y, 0};
}

bool FirstRoute::is_on_ground(const WishedPoint& at) const {
  return !wish_.is_vtol() && ((wish_.takeoff && &at == &wish_.points.front()) ||
                              (wish_.landing && &at == &wish_.points.back()));
}

void FirstRoute::reach_runways() {
  if (wish_.takeoff) {
    corridor_.reach(end_of(*wish_.takeoff, local(wish_.points.front())));
  }
  if (wish_.landing) {
    corridor_.reach(line_of(*wish_.landing, local(wish_.points.back())).entry);
  }
}

/// As slow as turns of the radius allow at the bank, rounded up.
double FirstRoute::speed_mps() const {
  if (wish_.speed_mps) {
    return *wish_.speed_mps;
  }
  if (lines_ && !wish_.turn_radius_m) {  // the camera keeps up, rounded down
    return std::min(kCopterSpeed, std::max(0.1, std::floor(lines_->max_mps * 10) / 10));
  }
  if (!wish_.turn_radius_m) {
    return wish_.autopilot.is_px4() ? kPx4CopterSpeed : kCopterSpeed;
  }
  const double speed = std::sqrt(*wish_.turn_radius_m * kGravity * std::tan(radians(kBank)));
  return std::ceil(speed * 100) / 100;
}

/// As turns of the radius take at the speed, rounded down so that they are no tighter.
double FirstRoute::bank_deg() const {
  if (!wish_.speed_mps) {
    return kBank;
  }
  const double speed = speed_mps();
  return std::floor(1e6 * degrees(std::atan(speed * speed / (*wish_.turn_radius_m * kGravity)))) /
         1e6;
}

/// Throws Error for a speed that turns of the radius do not allow, that the wind exceeds, or that
/// is too fast for the camera.
void FirstRoute::expect_flyable() const {
  if (wish_.turn_radius_m && bank_deg() > kMaxBank) {
    throw Error("--speed: turns of " + in_metres(*wish_.turn_radius_m) + " at " +
                text_of(speed_mps()) + " m/s take a bank of " + whole(bank_deg()) +
                " degrees: at most " + whole(kMaxBank) + ", raise --wing or lower --speed");
  }
  if (wish_.wind && wish_.wind->speed_mps >= speed_mps()) {
    throw Error("--wind: " + text_of(wish_.wind->speed_mps) + " m/s is not less than the speed, " +
                text_of(speed_mps()) + " m/s: nothing is reached against it");
  }
  // A copter's autopilot holds the speed over the ground that its plan commands.
  const double fastest =
      speed_mps() + (wish_.turn_radius_m && wish_.wind ? wish_.wind->speed_mps : 0);
  if (lines_ && fastest > lines_->max_mps) {
    throw Error("--speed: at up to " + with_digits(fastest, 3) +
                " m/s over the ground photos would be due every " +
                with_digits(lines_->trigger_m / fastest, 3) + " s, which takes the camera " +
                with_digits(wish_.survey->camera.min_interval_s, 3) +
                " s: lower --speed or --overlap");
  }
}

Box FirstRoute::volume(int attempt) const {
  Box box = corridor_.box(kTry[attempt].width);
  double top = heights_.max_m.value_or(heights_.ends_m);
  for (const WishedPoint& point : wish_.points) {
    top = std::max(top, point.above_ground_m.value_or(0));
  }
  // Without a limit there is space to pass above the highest ground.
  box.max.z() += std::ceil(top + (heights_.max_m ? 0 : 50 + wish_.turn_radius_m.value_or(0)));
  return box;
}

bool FirstRoute::repeats(int attempt) const {
  if (attempt == 0 || kTry[attempt].fineness != kTry[attempt - 1].fineness) {
    return false;
  }
  const Box before = corridor_.box(kTry[attempt - 1].width);
  const Box now = corridor_.box(kTry[attempt].width);
  return before.min == now.min && before.max == now.max;
}

std::vector<std::string> FirstRoute::zone_layers() const {
  std::vector<std::string> ids;
  for (const fs::path& file : wish_.avoid) {
    std::string id = file.filename();
    while (std::count(ids.begin(), ids.end(), id) > 0) {
      id += "_";
    }
    ids.push_back(id);
  }
  return ids;
}

std::string FirstRoute::environment(const Box& volume, const fs::path& folder) const {
  std::string text = "environment:\n";
  for (const Tile& tile : corridor_.tiles(volume)) {
    text += terrain_entry(tile, path_in(folder, tile.file));
  }
  // Zones with hours count if they are active while the flight may last.
  const double slowest = speed_mps() - (wish_.wind ? wish_.wind->speed_mps : 0);
  const double horizon = std::ceil(3 * length_m() / slowest + 600);
  const std::vector<std::string> ids = zone_layers();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const fs::path& file = wish_.avoid[i];
    text += "  - zones: {file: " + exact_json_text(path_in(folder, file)) +
            ", clip: true, horizon_s: " + text_of(horizon) + zone_parameters_[i] +
            "}\n    id: " + exact_json_text(ids[i]) + "\n";
  }
  return text;
}

std::string FirstRoute::climb() const {
  const auto rates = [](double climb_mps, double sink_mps) {
    return ", climb_mps: " + text_of(climb_mps) + ", sink_mps: " + text_of(sink_mps);
  };
  if (wish_.climb_mps) {
    return rates(*wish_.climb_mps, *wish_.climb_mps);
  }
  if (!wish_.turn_radius_m || lines_) {
    return "";
  }
  const HeldRates held =
      held_rates(wish_.autopilot, wish_.parameters, corridor_.box(0).max.z() + heights_.ends_m);
  const double in_wind = speed_mps() / (speed_mps() + (wish_.wind ? wish_.wind->speed_mps : 0));
  const auto down = [&](double rate) { return std::floor(100 * rate * in_wind) / 100; };
  return rates(down(held.climb_mps), down(held.sink_mps));
}

std::string FirstRoute::vehicle() const {
  const std::string energy = wish_.battery_wh && wish_.power_w && !lines_
                                 ? ", energy: {capacity_wh: " + text_of(*wish_.battery_wh) +
                                       ", reserve: " + text_of(wish_.reserve) +
                                       ", power_w: " + text_of(*wish_.power_w) + "}"
                                 : "";
  return (wish_.turn_radius_m ? std::string(wish_.is_vtol() ? "{type: vtol, " : "{") +
                                    "radius_m: 2, wing: {airspeed_mps: " + text_of(speed_mps()) +
                                    ", bank_deg: " + text_of(bank_deg()) + "}"
                              : "{radius_m: " + text_of(kCopterRadius) + ", performance: " +
                                    (wish_.autopilot.is_px4() ? "px4_mc" : "arducopter") +
                                    ", speed_mps: " + text_of(speed_mps())) +
         climb() + energy + "}";
}

std::string FirstRoute::point(const WishedPoint& at) const {
  return "{at_lonlat: [" + text_of(at.lon) + ", " + text_of(at.lat) + "], above_ground_m: " +
         text_of(is_on_ground(at) ? 0 : at.above_ground_m.value_or(heights_.ends_m));
}

double FirstRoute::clearance_m() const {
  if (!wish_.turn_radius_m) {
    return wish_.avoid.empty() || lines_ ? kFlownWithin : kCopterFromZones;
  }
  return lines_ || !wish_.avoid.empty() ? kWingFlownWithin : 0;
}

double FirstRoute::flown_margin() const {
  if (lines_ && !wish_.turn_radius_m) {
    constexpr double kStored = 0.05;  // of what is drawn, numbers of files may be off
    return lines_->off_m - lines_->drawn_off_m(*wish_.survey) - kStored;
  }
  double margin = wish_.turn_radius_m && !lines_ ? kWingHeightWithin : kFlownWithin;
  margin += wish_.kept_m;
  for (const WishedPoint& at : wish_.points) {
    const double slope = &at == &wish_.points.front() && wish_.takeoff  ? wish_.takeoff->height_m
                         : &at == &wish_.points.back() && wish_.landing ? wish_.landing->height_m
                                                                        : 0;
    const double height = slope > 0 ? slope : at.above_ground_m.value_or(heights_.ends_m);
    margin =
        std::min({margin, height - heights_.min_m, heights_.max_m.value_or(kInfinity) - height});
  }
  return std::max(margin, 0.0);
}

std::string FirstRoute::world(const std::string& environment, const Box& volume) const {
  const auto corner = [](const Vec3& p) {
    return "[" + text_of(p.x()) + ", " + text_of(p.y()) + ", " + text_of(p.z()) + "]";
  };
  std::string text =
      std::string("# The world of ") +
      (lines_ ? "a survey, written by altiplan survey" : "a first route, written by altiplan go") +
      ".\naltiplan: 1\nname: " +
      exact_json_text((lines_ ? wish_.survey->file : wish_.terrain.front()).stem()) + "\n" +
      environment + corridor_.frame_line() + (corridor_.frame_line().empty() ? "" : "\n");
  text += "volume: {min_m: " + corner(volume.min) + ", max_m: " + corner(volume.max) + "}\n" +
          "vehicle: " + vehicle() + "\n" + ends();
  if (wish_.wind) {
    text += "wind: {from_deg: " + text_of(wish_.wind->from_deg) +
            ", speed_mps: " + text_of(wish_.wind->speed_mps) + "}\n";
  }
  if (wish_.start_time) {
    text += "start_time: " + exact_json_text(*wish_.start_time) + "\n";
  }
  return text;
}

std::string FirstRoute::ends() const {
  const auto& takeoff = wish_.takeoff;
  const std::string start =
      "start: " + point(wish_.points.front()) +
      (takeoff ? ", takeoff: {course_deg: " + text_of(takeoff->course_deg) +
                     ", height_m: " + text_of(takeoff->height_m) +
                     (wish_.is_vtol() ? ", level_m: " + text_of(takeoff->level_m)
                                      : ", climb_deg: " + text_of(takeoff->climb_deg)) +
                     "}"
               : "") +
      "}\n";
  if (lines_) {
    const std::string back = "goal: " + point(wish_.points.front()) + ", tolerance_m: 1}\n";
    const std::string task = survey_task();
    return !wish_.survey->has_start ? task : line_.empty() ? start + task : start + back + task;
  }
  std::string text = start;
  const char* reached = ", tolerance_m: 1}\n";  // files of missions round points
  if (wish_.points.size() > 2) {
    text += "via:\n";
    for (std::size_t i = 1; i + 1 < wish_.points.size(); ++i) {
      text += "  - " + point(wish_.points[i]) + reached;
    }
  }
  const auto& landing = wish_.landing;
  return text + "goal: " + point(wish_.points.back()) +
         (landing ? ", landing: {course_deg: " + text_of(landing->course_deg) +
                        ", height_m: " + text_of(landing->height_m) +
                        (wish_.is_vtol() ? "" : ", glide_deg: " + text_of(landing->glide_deg)) +
                        ", level_m: " + text_of(landing->level_m) + "}"
                  : "") +
         reached;
}

std::string FirstRoute::survey_task() const {
  const auto number = [](double value) { return text_of(std::round(value * 1e6) / 1e6); };
  return "task:\n" +
         (line_.empty() ? cover_task() + "    spacing_m: " + number(lines_->spacing_m)
                        : follow_task()) +
         "\n    above_ground_m: " + number(lines_->above_ground_m) +
         "\n    tolerance_m: " + number(lines_->drawn_off_m(*wish_.survey)) + "\n";
}

std::string FirstRoute::cover_task() const {
  std::string text = "  cover:\n";
  bool has_islands = false;
  for (std::size_t i = 0; i < areas_.size(); ++i) {
    const std::string lead = i == 0 ? "    " : "        ";
    text += i == 1 ? "    more_areas:\n" : "";
    if (areas_.size() > 1) {
      const std::string& name = wish_.survey->areas[i].name;
      text += (i == 0 ? lead : "      - ") + "name: " + exact_json_text(name) + "\n";
    }
    text += lead + "outline_m: " + text_of(areas_[i].outline) + "\n";
    if (!areas_[i].holes.empty()) {
      text += lead + "holes_m:\n";
      for (const formats::Ring& hole : areas_[i].holes) {
        text += lead + "  - " + text_of(hole) + "\n";
      }
      has_islands = true;
    }
  }
  if (wish_.turn_radius_m) {  // room to turn away in front of an island, and to line up with a row
    text +=
        std::string(has_islands ? "    clearance_m: " +
                                      text_of(std::ceil(kIslandRadii * *wish_.turn_radius_m)) + "\n"
                                : "") +
        "    beyond_m: " + text_of(beyond_m()) + "\n" +
        (wish_.survey->has_start ? "" : "    closed: false\n");
  } else if (has_islands) {
    text += "    clearance_m: " + text_of(kCopterRadius + kFlownWithin + 0.01) + "\n";
  }
  if (wish_.survey->flight_s) {
    text += "    capacity_s: " + text_of(std::floor(*wish_.survey->flight_s * 10) / 10) + "\n";
  }
  return text;
}

double FirstRoute::beyond_m() const {
  return wish_.turn_radius_m ? std::ceil(kBeyondRadii * *wish_.turn_radius_m) : 0;
}

std::string FirstRoute::follow_task() const {
  std::string offsets;
  for (const double offset : offsets_of(*wish_.survey, *lines_)) {
    offsets += (offsets.empty() ? "" : ", ") + text_of(std::round(offset * 1e6) / 1e6);
  }
  return "  follow:\n    line_m: " + text_of(line_) + "\n    offsets_m: [" + offsets + "]";
}

double FirstRoute::area_m2() const {
  double sum = 0;
  for (const formats::Polygon& area : areas_) {
    sum += ring_m2(area.outline);
    for (const formats::Ring& hole : area.holes) {
      sum -= ring_m2(hole);
    }
  }
  return sum;
}

double FirstRoute::length_m() const {
  const double beside =
      line_.empty() ? 0 : double(offsets_of(*wish_.survey, *lines_).size()) * corridor_.length_m();
  return corridor_.length_m() + (lines_ ? beside + area_m2() / lines_->spacing_m : 0);
}

std::string FirstRoute::heights(double margin, const std::string& applies_to) const {
  std::string text =
      "  - ground_clearance: {min_m: " + text_of(heights_.min_m + margin) + applies_to + "}\n";
  if (heights_.max_m) {
    text += "  - altitude: {datum: ground, max_m: " + text_of(*heights_.max_m - margin) +
            applies_to + "}\n";
  }
  return text;
}

std::string FirstRoute::scenario(const Box& volume, const fs::path& folder) const {
  std::string text =
      world(environment(volume, folder), volume) +
      "constraints:  # of the route narrower than asked for, by what a flight may be "
      "off\n" +
      heights(flown_margin(), ", applies_to: route") + heights(0, ", applies_to: track");
  if (clearance_m() > 0) {
    text += "  - clearance: {min_m: " + text_of(clearance_m()) + ", applies_to: route}\n";
  }
  return text;
}

std::string FirstRoute::flown_scenario() const {
  constexpr double kFar = 1e8;  // metres: the ground and the zones alone bound a flight
  return world(environment(volume(kTries - 1), "."),
               {Vec3::Constant(-kFar), Vec3::Constant(kFar)}) +
         "constraints:\n" + heights(0, "");
}

std::vector<std::string> FirstRoute::choices(int attempt, const Box& volume,
                                             const Search& search) const {
  const std::vector<Tile> tiles = corridor_.tiles(volume);
  const Tile& tile = tiles.front();
  std::string ground = tile.file.filename().string() + ", " + tile.note;
  if (tiles.size() > 1) {
    ground += ", and " + counted(tiles.size() - 1, "tile") + " more";
  }
  if (!tile.crs.empty()) {
    ground += ", read as " + tile.crs;
  }
  const Vec3 size = (volume.max - volume.min) / 1000;
  static constexpr const char* kWidth[] = {"a narrow corridor", "a wider corridor",
                                           "the widest corridor"};
  const std::string wind = wish_.wind ? ", wind of " + text_of(wish_.wind->speed_mps) +
                                            " m/s from " + text_of(wish_.wind->from_deg) + " deg"
                                      : "";
  const std::string vehicle =
      wish_.turn_radius_m
          ? (wish_.is_vtol() ? "VTOL" : "wing") + std::string(" with turns of ") +
                whole(*wish_.turn_radius_m) + " m or more, " + text_of(speed_mps()) + " m/s" + wind
          : "copter of 1 m radius, " + text_of(speed_mps()) + " m/s" + wind;
  return {"terrain: " + ground + "; frame: " + corridor_.frame_in_words(),
          "volume: " + with_digits(size.x(), 3) + " x " + with_digits(size.y(), 3) + " km, " +
              (corridor_.is_all(volume) ? "all of the model" : kWidth[kTry[attempt].width]) + ", " +
              whole(volume.min.z()) + " to " + whole(volume.max.z()) + " m above sea level",
          heights_in_words() + "; " + vehicle, "planner: " + search.words};
}

std::string FirstRoute::heights_in_words() const {
  if (lines_) {
    const Camera& camera = wish_.survey->camera;
    return "photos: " + camera.name + ", " + in_metres(lines_->above_ground_m) +
           " above ground within " + in_metres(lines_->off_m) + ", each of " +
           in_metres(lines_->across_m) + " x " + in_metres(lines_->along_m) + ", every " +
           in_metres(lines_->trigger_m) + " " + lines_in_words();
  }
  return "heights: at least " + text_of(heights_.min_m) + " m above ground" +
         (heights_.is_min_lowered ? " (half of --max-agl)" : "") +
         (heights_.max_m ? ", at most " + text_of(*heights_.max_m) + " m" : "") +
         ", points without a height at " + text_of(heights_.ends_m) + " m";
}

std::string FirstRoute::lines_in_words() const {
  if (line_.empty()) {
    return "on lines " + in_metres(lines_->spacing_m) + " apart";
  }
  std::string text;
  for (const double offset : offsets_of(*wish_.survey, *lines_)) {
    text += (text.empty() ? "" : ", ") +
            (offset == 0
                 ? "over it"
                 : in_metres(std::abs(offset)) + (offset > 0 ? " to the left" : " to the right"));
  }
  return "along the line: " + text;
}

std::string FirstRoute::over_voids(const Polyline& route) const {
  const Corridor::Voids voids = corridor_.voids_below(route);
  if (voids.length_m == 0) {
    return "";
  }
  return whole(std::ceil(voids.length_m)) + " m of the route" +
         (voids.at_start ? voids.at_goal ? ", with start and goal," : ", with the start," : "") +
         (!voids.at_start && voids.at_goal ? ", with the goal," : "") +
         " lie over voids of the model, filled from their neighbours: the ground may be higher";
}

FirstFiles FirstRoute::files(int attempt, const fs::path& folder) const {
  const Box box = volume(attempt);
  RouteWish wish = wish_;
  if (lines_ && wish.turn_radius_m && !wish.planner) {
    wish.planner = "hybrid_astar";  // quick from row to row
  }
  Search search = choose_search(
      wish, heights_, {box, corridor_.length_m(), corridor_.spacing_m(), kTry[attempt].fineness},
      *registry_);
  if (lines_) {  // passes stay as they are, and joins that need a planner are few
    search.steps.erase(std::min(search.steps.find("  - smooth"), search.steps.size()));
    search.words.erase(std::min(search.words.find(", then"), search.words.size()));
  }
  return {scenario(box, folder),
          std::string("# The search of ") +
              (lines_ ? "a survey, written by altiplan survey"
                      : "a first route, written by altiplan go") +
              ".\naltiplan: 1\n"
              "scenario: scenario.yaml\nsteps:\n" +
              search.steps,
          choices(attempt, box, search), zone_layers()};
}
}  // namespace altiplan::host
