// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/view/picture_svg.hpp"
#include "host/view/scene.hpp"
#include "host/view/screenshot.hpp"
#include "host/view/viewer_page.hpp"
#include "progress.hpp"

namespace altiplan::cli {
namespace {

struct Arguments {
  std::vector<std::string> results;
  std::optional<std::string> page;
  std::optional<std::string> png;
  std::optional<std::string> svg;
  std::optional<double> cut_m;
  host::Overrides overrides;
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
    text += ", ground " + ground.at("nx").dump() + " x " + ground.at("ny").dump();
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
std::string try_png(const Arguments& arguments, const std::string& page, const host::Json& scene) {
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

host::Scene scene_of(const std::vector<host::StoredResult>& results) {
  Activity activity;
  return host::build_scene(results, [&](const std::string& what) { activity.begin(what); });
}

int view(const Arguments& arguments) {
  expect_writable(arguments.page, "-o");
  expect_writable(arguments.png, "--png");
  expect_writable(arguments.svg, "--svg");
  std::vector<host::StoredResult> results;
  for (const std::string& file : arguments.results) {
    results.push_back(host::read_result(file, arguments.overrides));
    std::vector<std::string> files = files_of(results.back());
    expect_apart(arguments.page, "-o", files);
    files.push_back(arguments.page.value_or(""));
    expect_apart(arguments.png, "--png", files);
    files.push_back(arguments.png.value_or(""));
    expect_apart(arguments.svg, "--svg", files);
  }
  const host::Scene scene = scene_of(results);
  for (const std::string& warning : scene.warnings) {
    warn(warning);
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
  return kDone;
}
}  // namespace

void add_view(App& app, Action& action) {
  App* command = app.add_subcommand("view", "show results in a 3-D page that works offline");
  auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("results", arguments->results,
                   "result files of altiplan run, all in the same world (JSON)")
      ->required();
  command->add_option("-o,--out", arguments->page, "write the page to this file (HTML)")
      ->type_name("FILE");
  auto* png =
      command
          ->add_option("--png", arguments->png,
                       "write a picture of the page, rendered by Chromium; without Chromium a top "
                       "view as SVG")
          ->type_name("FILE");
  command
      ->add_option("--cut", arguments->cut_m,
                   "hide everything but routes above this altitude in the PNG (m above sea level)")
      ->type_name("M")
      ->check(number_from(-1e6, 1e6))
      ->needs(png);
  command
      ->add_option("--svg", arguments->svg, "write a top view with the routes' altitude profiles")
      ->type_name("FILE");
  add_plugin_path(*command, arguments->overrides);
  set_example(*command, "altiplan view result.json -o page.html");
  command->callback([&action, arguments] {
    if (!arguments->page && !arguments->png && !arguments->svg) {
      throw UsageError{"-o, --png or --svg is required"};
    }
    action = [arguments] { return view(*arguments); };
  });
}
}  // namespace altiplan::cli
