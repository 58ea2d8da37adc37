// SPDX-License-Identifier: Apache-2.0
// The time of leg checks in the world of a scenario, for tools/bench/python_queries.py.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/mission/mission.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

using Leg = std::array<double, 6>;

std::vector<Leg> read_legs(const std::string& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error || bytes == 0 || bytes % sizeof(Leg) != 0) {
    throw Error(file + ": expected legs of six numbers of 8 bytes");
  }
  std::vector<Leg> legs(bytes / sizeof(Leg));
  if (!std::ifstream(file, std::ios::binary)
           .read(reinterpret_cast<char*>(legs.data()), std::streamsize(bytes))) {
    throw Error(file + ": cannot be read");
  }
  return legs;
}

Json measure(const std::string& scenario, const std::string& file, double radius_m, int passes) {
  const host::Config config = host::load_scenario(scenario, {});
  const host::Mission mission = host::build_mission(config, 1);
  const World& world = mission.truth;
  const std::vector<Leg> legs = read_legs(file);
  double min_s = kInfinity;
  std::size_t blocked = 0;
  for (int pass = 0; pass < passes; ++pass) {
    blocked = 0;
    const double begin = thread_s();
    for (const Leg& leg : legs) {
      const Vec3 a(leg[0], leg[1], leg[2]);
      const Vec3 b(leg[3], leg[4], leg[5]);
      blocked += world.blocked(a, b, radius_m) ? 1 : 0;
    }
    min_s = std::min(min_s, thread_s() - begin);
  }
  Json figures;
  figures["worlds"].push_back({{"legs", legs.size()},
                               {"blocked", blocked},
                               {"ns_per_leg", 1e9 * min_s / double(legs.size())}});
  return figures;
}
}  // namespace

void add_legs(Subcommands& all) {
  struct Arguments {
    std::string scenario;
    std::string legs;
    double radius_m = 0;
    int passes = 5;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("legs", "time leg checks in the world of a scenario", [=](const Given&) {
        return measure(arguments->scenario, arguments->legs, arguments->radius_m,
                       arguments->passes);
      });
  command.add_option("scenario", arguments->scenario, "scenario file")->required();
  command
      .add_option("legs", arguments->legs, "file of legs: six float64 each, both ends in metres")
      ->required();
  command.add_option("--radius", arguments->radius_m, "radius of the sphere (m)")
      ->check(CLI::Range(0.0, 1e6));
  command.add_option("--passes", arguments->passes, "the fastest of so many counts")
      ->check(CLI::Range(1, 1000));
}
}  // namespace altiplan::bench
