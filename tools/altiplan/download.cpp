// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include "host/base/output_file.hpp"
#include "link/plan_transfer.hpp"
#include "link/status.hpp"
#include "link_options.hpp"

namespace altiplan::cli {
namespace {

struct DownloadArguments {
  LinkOptions link;
  std::string out;
};

constexpr link::Time kHomeTimeout{4000};

bool is_plan(const std::string& file) { return std::filesystem::path(file).extension() == ".plan"; }

std::string out_problem(const std::string& file) {
  return is_plan(file) || std::filesystem::path(file).extension() == ".waypoints"
             ? ""
             : "expected a file name that ends in .plan or .waypoints, found '" + file + "'";
}

/// A vehicle need not know fences and rally points.
void add_others(Connection& connection, host::Plan& plan) {
  for (const link::PlanType type : {link::PlanType::fence, link::PlanType::rally}) {
    try {
      link::download(connection.link, connection.vehicle, type, plan, connection.stop);
    } catch (const link::LinkError& error) {
      if (connection.stop.stop_requested()) {
        throw;
      }
      warn("the file is written without " + link::name(type) + ": " + error.what());
    }
  }
}

int download_plan(const DownloadArguments& arguments) {
  expect_writable(arguments.out, "-o");
  return connected(arguments.link, [&](Connection& connection) {
    const auto& [address, heartbeat] = connection.vehicle;
    host::Plan plan;
    plan.autopilot = heartbeat.autopilot;
    plan.vehicle = heartbeat.type;
    plan.decimals.metres = 6;
    link::download(connection.link, connection.vehicle, link::PlanType::mission, plan,
                   connection.stop);
    if (is_plan(arguments.out)) {
      add_others(connection, plan);
    }
    if (!plan.home) {
      plan.home =
          link::read_home(connection.link, connection.vehicle, kHomeTimeout, connection.stop);
    }
    if (!plan.home) {
      warn("the vehicle reports no home: the file has it below the first item, at sea level");
    }
    host::write_file(arguments.out,
                     is_plan(arguments.out) ? plan_text(plan) : waypoints_text(plan));
    std::cout << arguments.out << ": " << plan.items.size() << " items, " << plan.fence.size()
              << " of the fence, " << plan.rally.size() << " rally points\n";
    return kDone;
  });
}

int print_status(const LinkOptions& options) {
  return connected(options, [](Connection& connection) {
    constexpr link::Time kTimeout{4000};
    std::cout << in_words(
        link::read_status(connection.link, connection.vehicle, kTimeout, connection.stop));
    return kDone;
  });
}
}  // namespace

void add_download(App& app, Action& action) {
  auto [command, arguments] = add_command<DownloadArguments>(
      app, action, "download", "write a vehicle's mission, fence and rally points to a file",
      download_plan);
  add_link_options(command, "--link,--from", arguments.link);
  command.add_option("-o,--out FILE", arguments.out, "output file: .plan, or .waypoints (mission)")
      ->required()
      ->check(out_problem);
  set_example(command, "altiplan download --link udp:127.0.0.1:14550 -o mission.plan");
}

void add_status(App& app, Action& action) {
  auto [command, options] = add_command<LinkOptions>(
      app, action, "status", "print a vehicle's mode, position, battery and mission count",
      print_status);
  add_link_options(command, "--link,--from", options);
  set_example(command, "altiplan status --link udp:127.0.0.1:14550");
}
}  // namespace altiplan::cli
