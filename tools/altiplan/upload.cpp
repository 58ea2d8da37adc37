// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "link/plan_transfer.hpp"
#include "link_options.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

struct Arguments {
  RouteExport route;
  LinkOptions link;
  bool no_fence = false;
};

/// Uploads the items of one type; true if the vehicle holds what was sent.
bool upload(Connection& connection, const host::Plan& plan, link::PlanType type,
            std::size_t count) {
  const std::vector<std::string> changed =
      link::upload(connection.link, connection.vehicle, plan, type, connection.stop);
  std::cout << link::name(type) << ": " << count << " items uploaded, read back "
            << (changed.empty() ? "equal" : "with differences") << '\n';
  for (const std::string& line : changed) {
    std::cout << "  " << line << '\n';
  }
  return changed.empty();
}

int upload_result(const Arguments& arguments) {
  const std::optional<host::Exported> written = exported(arguments.route, std::nullopt);
  if (!written) {
    return kNoRoute;
  }
  if (written->mission.decimals.degrees > 7) {
    warn(
        "MAVLink carries 7 decimals of a degree: rounded so, the route is not valid, by 1 cm at "
        "most");
  }
  const host::Plan plan = host::plan_of(written->mission);
  return connected(arguments.link, [&](Connection& connection) {
    bool is_equal = upload(connection, plan, link::PlanType::mission, plan.items.size());
    if (!plan.fence.empty() && !arguments.no_fence) {
      is_equal = upload(connection, plan, link::PlanType::fence, plan.fence.size()) && is_equal;
    }
    return is_equal ? kDone : kNoRoute;
  });
}
}  // namespace

void add_upload(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "upload", "judge a result's route, upload it to a vehicle and compare what that holds");
  auto arguments = std::make_shared<Arguments>();
  add_link_options(*command, "--to", arguments->link);
  add_route_export(*command, arguments->route);
  command->add_flag("--no-fence", arguments->no_fence,
                    "leave the vehicle's fence as it is, whatever zones the scenario has");
  set_example(*command, "altiplan upload result.json --to udp:127.0.0.1:14550 --takeoff --land");
  command->callback([&action, arguments] {
    arguments->route.options.format = kit::MissionFile::Format::qgc_plan;
    finish_options(arguments->route);
    action = [arguments] { return upload_result(*arguments); };
  });
}
}  // namespace altiplan::cli
