// SPDX-License-Identifier: Apache-2.0
#include "plan_upload.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

struct UploadArguments {
  RouteExport route;
  LinkOptions link;
  bool no_fence = false;
};

int upload_result(const UploadArguments& arguments) {
  const std::optional<host::Exported> written = exported(arguments.route, std::nullopt);
  if (!written) {
    return kNoRoute;
  }
  const host::Plan plan = plan_to_upload(*written);
  return connected(arguments.link, [&](Connection& connection) {
    return upload_plan(connection, plan, !arguments.no_fence) ? kDone : kNoRoute;
  });
}
}  // namespace

void add_upload(App& app, Action& action) {
  const auto prepare = [](UploadArguments& arguments) {
    arguments.route.options.format = formats::MissionFile::Format::qgc_plan;
    finish_options(arguments.route);
  };
  auto [command, arguments] = add_command<UploadArguments>(
      app, action, "upload",
      "judge a result's route, upload it to a vehicle and compare what that holds", upload_result,
      prepare);
  add_link_options(command, "--to", arguments.link);
  add_route_export(command, arguments.route);
  add_no_fence(command, arguments.no_fence);
  set_example(command, "altiplan upload result.json --to udp:127.0.0.1:14550 --takeoff --land");
}
}  // namespace altiplan::cli
