// SPDX-License-Identifier: Apache-2.0
// upload_plan ADDRESS SEED FILE|COUNT: uploads the mission of the file, or COUNT random items, with
// a fence and rally points to the vehicle, and reads them back. Prints a line of JSON: the seconds
// that it took, what was sent, and the differences that were found.
#include <cstdlib>
#include <iostream>

#include "altiplan/geometry.hpp"
#include "altiplan/random.hpp"
#include "link/plan_transfer.hpp"

namespace altiplan::link {
namespace {

using host::Command;
using host::PlanItem;

constexpr Time kHeartbeatTimeout{20'000};

/// Of a degree, as MAVLink carries it.
double near(RandomStream& random, double degrees) {
  return degrees + 1e-7 * double(random.integer(-100'000, 100'000));
}

/// Whole metres, as ArduPilot stores radii and the altitudes of rally points.
double metres(RandomStream& random, int low, int high) { return double(random.integer(low, high)); }

PlanItem random_item(RandomStream& random, double lat, double lon) {
  constexpr int kCommands[] = {Command::kWaypoint, Command::kWaypoint, Command::kLoiterForever};
  constexpr int kFrames[] = {0, 3, 10};
  PlanItem item{kCommands[random.integer(0, 2)], kFrames[random.integer(0, 2)]};
  if (item.command == Command::kLoiterForever) {
    item.params[2] = metres(random, -500, 500);
  }
  item.params[4] = near(random, lat);
  item.params[5] = near(random, lon);
  item.params[6] = double(random.integer(-30'000, 500'000)) / 100;
  return item;
}

std::vector<PlanItem> random_items(RandomStream& random, int count) {
  std::vector<PlanItem> items;
  const double lat = random.uniform(-80, 80);
  const double lon = random.uniform(-179, 179);
  for (int n = 0; n < count; ++n) {
    items.push_back(random_item(random, lat, lon));
  }
  return items;
}

/// Polygons and circles around a point; where they lie to each other does not matter.
std::vector<PlanItem> random_fence(RandomStream& random, double lat, double lon) {
  std::vector<PlanItem> fence;
  const auto add = [&](int command, double param, double y, double x) {
    PlanItem item{command};
    item.params = {param, 0, 0, 0, y, x, 0};
    fence.push_back(item);
  };
  for (std::int64_t zones = random.integer(1, 4); zones > 0; --zones) {
    const int is_out = int(random.integer(0, 1));
    const int corners = int(random.integer(2, 12));
    if (corners == 2) {
      add(Command::kFenceCircleIn + is_out, metres(random, 50, 900), near(random, lat),
          near(random, lon));
    }
    for (int n = 0; n < corners && corners > 2; ++n) {
      const double angle = 2 * kPi * n / corners;
      add(Command::kFencePolygonIn + is_out, corners, lat + 0.01 * std::sin(angle),
          lon + 0.01 * std::cos(angle));
    }
  }
  return fence;
}

std::vector<PlanItem> random_rally(RandomStream& random, double lat, double lon) {
  std::vector<PlanItem> rally;
  for (std::int64_t n = random.integer(1, 5); n > 0; --n) {
    PlanItem item{Command::kRallyPoint, 3};
    item.params = {0, 0, 0, 0, near(random, lat), near(random, lon), metres(random, 20, 200)};
    rally.push_back(item);
  }
  return rally;
}

host::Plan plan_from(const std::string& source, RandomStream& random) {
  host::Plan plan;
  if (formats::is_mission_file(source)) {
    host::MissionText text;
    text.mission = formats::read_mission(source);
    plan = host::plan_of(text);
  } else {
    plan.items = random_items(random, std::atoi(source.c_str()));
  }
  const double lat = plan.items.empty() ? 47 : plan.items.front().params[4];
  const double lon = plan.items.empty() ? 8 : plan.items.front().params[5];
  if (plan.fence.empty()) {
    plan.fence = random_fence(random, lat, lon);
  }
  plan.rally = random_rally(random, lat, lon);
  return plan;
}

std::string number(double value) {
  return std::isfinite(value) ? host::rounded_text(value, 9) : "null";
}

/// "[[command, frame, autocontinue, x, y, z, parameters 1 to 4], …]"
std::string json(const std::vector<PlanItem>& items) {
  std::string text;
  for (const MissionItemInt& item : wire_items(items)) {
    text += (text.empty() ? "[" : ",[") + std::to_string(item.command) + "," +
            std::to_string(item.frame) + "," + std::to_string(item.autocontinue) + "," +
            std::to_string(item.x) + "," + std::to_string(item.y);
    for (const float value : {item.z, item.param1, item.param2, item.param3, item.param4}) {
      text += "," + number(value);
    }
    text += "]";
  }
  return "[" + text + "]";
}

std::string json(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += (text.empty() ? "\"" : ",\"") + line + "\"";
  }
  return "[" + text + "]";
}

void upload_plan(const std::string& address, const host::Plan& plan) {
  Link link(open_transport(read_endpoint(address)), {255, 190}, std::nullopt);
  const Vehicle vehicle = await_vehicle(link, std::nullopt, kHeartbeatTimeout, {});
  const Time begin = time_now();
  std::vector<std::string> found;
  for (const PlanType type : {PlanType::mission, PlanType::fence, PlanType::rally}) {
    for (const std::string& difference : upload(link, vehicle, plan, type, {})) {
      found.push_back(name(type) + ": " + difference);
    }
  }
  std::cout << "{\"seconds\":" << number(double((time_now() - begin).count()) / 1000)
            << ",\"sent\":[" << json(plan.items) << "," << json(plan.fence) << ","
            << json(plan.rally) << "],\"differences\":" << json(found) << "}\n";
}
}  // namespace
}  // namespace altiplan::link

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "expected ADDRESS SEED FILE|COUNT\n";
    return 2;
  }
  try {
    altiplan::RandomStream random(std::strtoull(argv[2], nullptr, 10));
    altiplan::link::upload_plan(argv[1], altiplan::link::plan_from(argv[3], random));
  } catch (const altiplan::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
