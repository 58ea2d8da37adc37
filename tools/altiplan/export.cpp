// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/import_export/route_csv.hpp"
#include "mission_options.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

struct ExportArguments {
  RouteExport route;
  MissionOptions mission;
  std::optional<std::string> to;
  std::optional<std::string> out;
  std::optional<std::string> fence;
};

/// As given, or by the output file's extension.
const host::RouteFormat& format_of(const ExportArguments& arguments) {
  if (arguments.to) {
    return host::format_named(*arguments.to);
  }
  const host::RouteFormat* format = host::format_by_extension(arguments.out.value_or(""));
  if (format == nullptr) {
    std::string extensions;
    for (const std::string& extension : host::format_extensions()) {
      extensions += (extensions.empty() ? "" : ", ") + extension;
    }
    throw UsageError{"--to is required, or an output file (-o) that ends in one of " + extensions};
  }
  return *format;
}

/// The zones in a file of their own; false if there are none.
bool write_fence(const LoadedRoute& route, const std::string& file) {
  const host::Exported fence = host::export_fence(route.mission, route.source.route);
  for (const std::string& message : fence.messages) {
    warn(file + ": " + message);
  }
  if (fence.text) {
    host::write_file(file, *fence.text);
  }
  return fence.text.has_value();
}

/// The drawn points with the gate's times.
std::string csv_of(const JudgedPlan& judged) {
  const host::ImportedRoute& drawn = judged.report.imported;
  std::vector<host::CsvRow> rows;
  for (std::size_t n = 0; n < drawn.items.size(); ++n) {
    const host::TimeSpan& time = judged.report.times[n];
    rows.push_back({time.min_s, time.max_s, drawn.route[n], drawn.items[n].at});
  }
  return host::route_csv_text(rows, judged.world.truth.frame().has_position(), {});
}

/// A format of positions alone has no waits, drops and landings on the way: a landing would be a
/// place on the ground to fly to.
void expect_positions_alone(const std::string& file, const formats::MissionFile& mission,
                            const host::RouteFormat& format) {
  using formats::Task;
  std::size_t left_out = 0;
  std::optional<std::string> landed;
  for (const formats::MissionCommand& command : mission.commands) {
    const Task task = formats::command_task(command.number).task;
    const bool takes_off = task == Task::take_off || task == Task::vtol_take_off;
    if (takes_off && landed) {
      throw Error(file + ": " + *landed + " is a landing on the way, and " +
                  std::string(format.name) + " holds positions alone: not written");
    }
    if (task == Task::land || task == Task::vtol_land || task == Task::payload_place) {
      landed = command.item > 0 ? "item " + std::to_string(command.item) : command.place;
    }
    const bool holds = task == Task::waypoint && command.params[0] > 0;
    left_out += holds || task == Task::delay || task == Task::loiter_time ||
                command.number == host::Command::kGripper;
  }
  if (left_out > 0) {
    warn(std::string(format.name) + " holds positions alone: " + std::to_string(left_out) +
         " waits and drops are left out");
  }
}

/// Its own commands, where the format has some; else its positions. None, which is reported: the
/// mission does not pass.
std::optional<std::string> text_of_mission(const ExportArguments& arguments) {
  const std::string& file = arguments.route.result;
  const JudgedPlan judged = judged_plan(arguments.mission.plan, arguments.route.overrides);
  const host::RouteFormat& format = *arguments.route.options.format;
  // A line that becomes commands is judged as these are flown, whose frames are other ones.
  const bool becomes_commands = format.has_commands() && judged.mission.commands.empty();
  if (!becomes_commands && !judged.report.passed()) {
    tell_findings(file, judged);
    return std::nullopt;
  }
  if (format.has_commands()) {
    const std::optional<host::Plan> plan =
        becomes_commands ? plan_of_line(judged, arguments.route) : host::plan_of(judged.mission);
    if (plan && format.zones == host::RouteFormat::Zones::none &&
        !(plan->fence.empty() && plan->rally.empty())) {
      warn(std::string(format.name) +
           " holds the mission alone: its fence and rally points are left out");
    }
    return plan ? std::optional(format.write_plan(*plan)) : std::nullopt;
  }
  expect_positions_alone(file, judged.mission, format);
  if (&format == &host::format_named("csv")) {
    return csv_of(judged);
  }
  return exported_route(judged, arguments.route).text;
}

int write_mission(const ExportArguments& arguments) {
  expect_apart(arguments.out, "-o", {arguments.route.result});
  const std::optional<std::string> text = text_of_mission(arguments);
  if (text && arguments.out) {
    host::write_file(*arguments.out, *text);
  } else if (text) {
    std::cout << *text;
  }
  return text ? kDone : kNoRoute;
}

/// As few items as an autopilot flies as judged, where one is named; else all points.
std::optional<std::string> text_of_route(const LoadedRoute& route,
                                         const ExportArguments& arguments) {
  if (arguments.mission.autopilot) {
    const std::optional<host::Plan> plan =
        fewest_plan(route, arguments.route, arguments.mission.plan);
    return plan ? std::optional(arguments.route.options.format->write_plan(*plan)) : std::nullopt;
  }
  const std::optional<host::Exported> written = exported(route, arguments.route);
  return written ? written->text : std::nullopt;
}

int export_result(const ExportArguments& arguments) {
  expect_writable(arguments.out, "-o");
  expect_writable(arguments.fence, "--fence");
  if (is_mission(arguments.mission, arguments.route.result)) {
    return write_mission(arguments);
  }
  const std::optional<LoadedRoute> route = loaded(arguments.route, arguments.out);
  const std::optional<std::string> text = route ? text_of_route(*route, arguments) : std::nullopt;
  if (!text) {
    return kNoRoute;
  }
  if (arguments.fence) {
    std::vector<std::string> others = files_of(route->stored);
    others.push_back(arguments.out.value_or(""));
    expect_apart(arguments.fence, "--fence", others);
  }
  if (arguments.out) {
    host::write_file(*arguments.out, *text);
  } else {
    std::cout << *text;
  }
  return !arguments.fence || write_fence(*route, *arguments.fence) ? kDone : kNoRoute;
}
}  // namespace

void add_export(App& app, Action& action) {
  const auto prepare = [](ExportArguments& arguments) {
    arguments.route.options.format = &format_of(arguments);
    if (is_mission(arguments.mission, arguments.route.result)) {
      expect_no_item_options(arguments.route, arguments.fence.has_value());
      arguments.mission.plan = checked_plan(arguments.mission, arguments.route.result);
    } else if (arguments.mission.autopilot) {
      if (!arguments.route.options.format->has_commands() || arguments.route.flight) {
        throw UsageError{"--autopilot with a result needs qgc-plan or waypoints, and no --flight"};
      }
      arguments.mission.plan = checked_plan(arguments.mission, arguments.route.result);
    }
    finish_options(arguments.route);
  };
  auto [command, arguments] = add_command<ExportArguments>(
      app, action, "export",
      "write a result's route, or a mission, for ground control stations and maps", export_result,
      prepare);
  command
      .add_option("--to FORMAT", arguments.to,
                  "format: " + host::format_names() + " (default: by -o)")
      ->check(Check::one_of(host::format_words()));
  command.add_option("-o,--out FILE", arguments.out, "output file (default: stdout)");
  command.add_option("--fence FILE", arguments.fence,
                     "also write the zones as a fence file for Mission Planner (QGC WPL 110)");
  add_route_export(command, arguments.route, true);
  add_mission_options(command, arguments.mission);
  command.add_flag("--flight", arguments.route.flight,
                   "export the flown track instead of the route");
  set_example(command, "altiplan export result.json --takeoff --land -o ridge.plan");
}
}  // namespace altiplan::cli
