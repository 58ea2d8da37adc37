// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "mission_options.hpp"
#include "plan_upload.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

struct UploadArguments {
  RouteExport route;
  MissionOptions mission;
  LinkOptions link;
  FenceOptions fence;
};

struct Uploaded {
  formats::MissionFile mission;
  host::Plan plan;
};

/// A mission's own items, if it passes; a result's route as it is written.
std::optional<Uploaded> uploaded(const UploadArguments& arguments) {
  const std::string& file = arguments.route.result;
  if (!is_mission(arguments.mission, file)) {
    const std::optional<host::Exported> written = exported(arguments.route, std::nullopt);
    return written ? std::optional(Uploaded{formats::read_mission("route.plan", *written->text),
                                            plan_to_upload(*written)})
                   : std::nullopt;
  }
  if (host::RouteFormat const* format = host::format_by_extension(file);
      format != nullptr && !format->has_commands()) {
    const JudgedPlan judged = judged_plan(arguments.mission.plan, arguments.route.overrides);
    std::cout << judged.verdict() << '\n';
    if (!judged.report.passed()) {
      tell_findings(file, judged);
      return std::nullopt;
    }
    const std::optional<host::Plan> plan = plan_of_line(judged, arguments.route);
    return plan ? std::optional(
                      Uploaded{formats::read_mission("route.plan", host::plan_text(*plan)), *plan})
                : std::nullopt;
  }
  if (check_plan(arguments.mission.plan, arguments.route.overrides) != kDone) {
    return std::nullopt;
  }
  const formats::MissionFile mission = formats::read_mission(file);
  return Uploaded{mission, host::plan_of(mission)};
}

int upload_result(const UploadArguments& arguments) {
  const std::optional<Uploaded> source = uploaded(arguments);
  if (!source) {
    return kNoRoute;
  }
  const bool is_file = is_mission(arguments.mission, arguments.route.result);
  return connected(arguments.link, [&](Connection& connection) {
    if (is_file &&
        !is_judged_for(connection.vehicle, source->mission, arguments.mission.plan.gate)) {
      return kNoRoute;
    }
    tell_refusals(connection.vehicle, source->mission);
    return upload_plan(connection, source->plan, arguments.fence) ? kDone : kNoRoute;
  });
}
}  // namespace

void add_upload(App& app, Action& action) {
  const auto prepare = [](UploadArguments& arguments) {
    arguments.route.options.format = &host::format_named("qgc-plan");
    if (is_mission(arguments.mission, arguments.route.result)) {
      expect_no_item_options(arguments.route, false);
      arguments.mission.plan = checked_plan(arguments.mission, arguments.route.result);
    }
    finish_options(arguments.route);
  };
  auto [command, arguments] = add_command<UploadArguments>(
      app, action, "upload",
      "judge a result's route or a mission, upload it to a vehicle and compare what that holds",
      upload_result, prepare);
  add_link_options(command, "--link,--to", arguments.link);
  add_route_export(command, arguments.route, true);
  add_mission_options(command, arguments.mission);
  add_fence_options(command, arguments.fence);
  set_example(command, "altiplan upload result.json --link udp:127.0.0.1:14550 --takeoff --land");
}
}  // namespace altiplan::cli
