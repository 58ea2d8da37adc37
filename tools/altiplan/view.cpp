// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/view/basemap.hpp"
#include "host/view/chromium.hpp"
#include "host/view/film.hpp"
#include "host/view/picture_svg.hpp"
#include "host/view/reach.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "mission_options.hpp"
#include "progress.hpp"

namespace altiplan::cli {
namespace {

struct ViewArguments {
  std::vector<std::string> results;
  std::optional<std::string> page;
  std::optional<std::string> png;
  std::optional<std::string> svg;
  std::optional<std::string> mp4;
  std::optional<double> mp4_seconds;
  std::optional<double> cut_m;
  std::optional<std::string> basemap;
  bool reach = false;
  MissionOptions mission;
  host::Overrides overrides;

  /// The files to be written, with their options.
  std::array<std::pair<const std::optional<std::string>&, const char*>, 4> outputs() const {
    return {{{page, "-o"}, {png, "--png"}, {svg, "--svg"}, {mp4, "--mp4"}}};
  }
};

/// Bytes above which browsers open a page slowly.
constexpr double kLargePage = 64e6;

std::string count(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// A summary of the scene: "2 routes, 1 flight, ground 403 x 344".
std::string contents(const host::Json& scene) {
  std::size_t routes = 0;
  std::size_t flights = 0;
  for (const host::Json& result : scene.at("results")) {
    routes += !result.at("route").is_null();
    flights += !result.at("flight").is_null();
  }
  std::size_t solids = scene.at("solids").size() + scene.at("meshes").size();
  for (const host::Json& boxes : scene.at("boxes")) {
    solids += boxes.at("count").get<std::size_t>();
  }
  std::string text = count(routes, "route") + ", " + count(flights, "flight");
  if (const host::Json& ground = scene.at("ground"); !ground.is_null()) {
    text += ", ground " + host::exact_json_text(ground.at("nx")) + " x " +
            host::exact_json_text(ground.at("ny"));
  }
  text += ", " + count(solids, "solid");
  if (const std::size_t moving = scene.at("moving").size(); moving > 0) {
    text += ", " + std::to_string(moving) + " moving";
  }
  return text;
}

void say_written(const std::string& file, std::size_t bytes, const host::Json& scene) {
  std::printf("%s: %s MB: %s\n", file.c_str(), fixed(double(bytes) / 1e6, 2).c_str(),
              contents(scene).c_str());
}

void write(const std::string& file, const std::string& text, const host::Json& scene) {
  host::write_file(file, text);
  say_written(file, text.size(), scene);
}

/// Writes the PNG of the page; returns why that failed, "" if it was written.
std::string try_png(const ViewArguments& arguments, const std::string& page,
                    const host::Json& scene) {
  const auto chromium = host::find_chromium();
  if (!chromium) {
    return "no Chromium found (set ALTIPLAN_CHROMIUM to its path)";
  }
  std::string png;
  try {
    const std::string query =
        "?still&theme=light" +
        (arguments.cut_m ? "&cut=" + fixed(arguments.cut_m, 3) : std::string());
    png = busy("drawing the picture", [&] { return host::screenshot(*chromium, page, query); });
  } catch (const Error& error) {
    return error.what();
  }
  write(*arguments.png, png, scene);
  return "";
}

/// Writes the film, frame by frame.
void write_film(const ViewArguments& arguments, const host::FilmMakers& makers,
                const std::string& page, const host::Json& scene) {
  const double seconds = arguments.mp4_seconds.value_or(host::film_seconds(scene));
  const auto began = std::chrono::steady_clock::now();
  Activity progress("film: starting Chromium");
  const std::string bytes =
      host::film(makers, page, seconds, [&](std::size_t done, std::size_t all) {
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
        progress.begin("film: frame " + std::to_string(done) + " of " + std::to_string(all) + ", " +
                       duration(took.count() / double(done) * double(all - done)) + " left");
      });
  progress.end();
  host::write_file(*arguments.mp4, bytes);
  std::printf("%s: %s MB: %s s\n", arguments.mp4->c_str(),
              fixed(double(bytes.size()) / 1e6, 2).c_str(), fixed(seconds, 0).c_str());
}

std::vector<host::StoredResult> read_results(const ViewArguments& arguments) {
  std::vector<host::StoredResult> results;
  for (const std::string& file : arguments.results) {
    results.push_back(host::read_result(file, arguments.overrides));
    std::vector<std::string> files = files_of(results.back());
    for (const auto& [output, option] : arguments.outputs()) {
      expect_apart(output, option, files);
      files.push_back(output.value_or(""));
    }
  }
  const bool has_flight = std::any_of(results.begin(), results.end(),
                                      [](const auto& result) { return result.track.has_value(); });
  if (arguments.mp4 && !has_flight) {
    throw Error(
        "--mp4: expected a result with a flight (of a pipeline with a fly step), found none");
  }
  return results;
}

host::Scene scene_of(const ViewArguments& arguments) {
  const std::vector<host::StoredResult> results = read_results(arguments);
  Activity activity;
  return host::build_scene(
      results, [&](const std::string& what) { activity.begin(what); }, arguments.reach);
}

/// The places of a mission's items, with the numbers that ground stations show.
host::Json numbered(const JudgedPlan& judged) {
  host::Json items = host::Json::array();
  for (const PlacedItem& item : judged.items(judged.world.truth.frame())) {
    if (item.number > 0) {
      items.push_back({{"number", item.number}, {"at", host::to_json(Polyline{item.at})[0]}});
    }
  }
  return items;
}

/// From where the mission's home can be reached, and its point of no return.
void add_reach_of_mission(host::Json& scene, const JudgedPlan& judged) {
  if (!judged.mission.home) {
    throw Error("--reach: where home is, the mission does not say");
  }
  const formats::MissionPoint& home = *judged.mission.home;
  const std::array<double, 2> at = judged.world.truth.frame().to_local(home.lon, home.lat);
  busy("searching ways home", [&] {
    host::add_reach(scene, judged.world, {at[0], at[1], home.altitude_m},
                    judged.report.returns->point_of_no_return);
    return 0;
  });
}

/// A mission's line as it is flown, with the verdict of `check`.
host::Scene scene_of_mission(const ViewArguments& arguments) {
  const std::string& file = arguments.results.front();
  for (const auto& [output, option] : arguments.outputs()) {
    expect_apart(output, option, {file});
  }
  const JudgedPlan judged = judged_plan(arguments.mission.plan, arguments.overrides);
  host::Scene scene = host::line_scene(judged.line(judged.world.truth.frame()), judged.world);
  scene.json["numbered"] = numbered(judged);
  if (arguments.reach) {
    add_reach_of_mission(scene.json, judged);
  }
  return scene;
}

int view(const ViewArguments& arguments) {
  for (const auto& [file, option] : arguments.outputs()) {
    expect_writable(file, option);
    if (arguments.basemap) {
      expect_apart(file, option, {*arguments.basemap});
    }
  }
  std::optional<host::Basemap> basemap;
  if (arguments.basemap) {
    basemap.emplace(*arguments.basemap);
  }
  const std::optional<host::FilmMakers> makers =
      arguments.mp4 ? std::optional<host::FilmMakers>(std::in_place) : std::nullopt;
  host::Scene scene =
      arguments.mission.plan.plan.empty() ? scene_of(arguments) : scene_of_mission(arguments);
  for (const std::string& warning : scene.warnings) {
    warn(warning);
  }
  if (basemap) {
    busy("bringing the basemap into the scene", [&] { basemap->add_to(scene.json, scene.frame); });
  }
  const std::string page = host::viewer_page(scene.json);
  if (arguments.page) {
    write(*arguments.page, page, scene.json);
    if (double(page.size()) > kLargePage) {
      warn(*arguments.page + ": a page of " + fixed(double(page.size()) / 1e6, 0) +
           " MB opens slowly in a browser");
    }
  }
  if (arguments.svg) {
    write(*arguments.svg, host::picture_svg(scene.json), scene.json);
  }
  if (arguments.png) {
    if (const std::string why = try_png(arguments, page, scene.json); !why.empty()) {
      const auto instead = std::filesystem::path(*arguments.png).replace_extension(".svg");
      warn(why + ": writing a top view as SVG instead, " + instead.string());
      write(instead.string(), host::picture_svg(scene.json), scene.json);
    }
  }
  if (makers) {
    write_film(arguments, *makers, page, scene.json);
  }
  return kDone;
}
}  // namespace

void add_view(App& app, Action& action) {
  const auto prepare = [](ViewArguments& arguments) {
    if (!arguments.page && !arguments.png && !arguments.svg && !arguments.mp4) {
      throw UsageError{"-o, --png, --svg or --mp4 is required"};
    }
    const bool has_ground_image = arguments.basemap || arguments.reach;
    if (has_ground_image && !arguments.page && !arguments.png && !arguments.mp4) {
      throw UsageError{std::string(arguments.reach ? "--reach" : "--basemap") +
                       " is shown by -o, --png and --mp4"};
    }
    const std::vector<std::string>& files = arguments.results;
    for (const std::string& file : files) {
      if (!arguments.mission.plan.scenario && !is_mission(arguments.mission, file)) {
        continue;
      }
      if (arguments.reach && !arguments.mission.plan.scenario) {
        throw UsageError{"--reach of a mission needs --scenario, whose vehicle has a battery"};
      }
      if (files.size() > 1 || arguments.mp4) {
        throw UsageError{"a mission is shown alone, and not as a film"};
      }
      arguments.mission.plan = checked_plan(arguments.mission, file);
      arguments.mission.plan.returns = arguments.reach;
    }
  };
  auto [command, arguments] = add_command<ViewArguments>(
      app, action, "view", "show results, or a mission, in a 3-D page that works offline", view,
      prepare);
  command
      .add_option("results", arguments.results,
                  "result files of altiplan run, all in the same world (JSON); or a mission")
      ->required();
  command.add_option("-o,--out FILE", arguments.page, "write the page to this file (HTML)");
  auto* png = command.add_option(
      "--png FILE", arguments.png,
      "write a picture of the page, rendered by Chromium; without Chromium a top "
      "view as SVG");
  command
      .add_option("--cut M", arguments.cut_m,
                  "hide everything but routes above this altitude in the PNG (m above sea level)")
      ->check(number_from(-1e6, 1e6))
      ->needs(png);
  command.add_option("--svg FILE", arguments.svg,
                     "write a top view with the routes' altitude profiles");
  auto* mp4 = command.add_option("--mp4 FILE", arguments.mp4,
                                 "write a film of the flight from behind the vehicle, rendered by "
                                 "Chromium and ffmpeg");
  command
      .add_option("--mp4-seconds S", arguments.mp4_seconds,
                  "length of the film (s); default: a thirtieth of the flight, but 20 to 120 s")
      ->check(number_from(1, 600))
      ->needs(mp4);
  auto* basemap = add_basemap(command, arguments.basemap);
  command
      .add_flag(
          "--reach", arguments.reach,
          "show from where home can be reached on the scenario's battery: lines of the energy "
          "of the best way home, and the point of no return")
      ->excludes(basemap);
  auto* scenario = command.add_option("--scenario FILE", arguments.mission.plan.scenario,
                                      "scenario file in which to judge a mission (YAML)");
  add_mission_options(command, arguments.mission)->excludes(scenario);
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan view result.json -o page.html");
}
}  // namespace altiplan::cli
