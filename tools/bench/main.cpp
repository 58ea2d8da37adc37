// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "altiplan_build.hpp"
#include "guarded.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

int main(int argc, char** argv) {
  using namespace altiplan;
  CLI::App app(
      "Benchmarks altiplan's parts against plain implementations, libraries and published "
      "figures.",
      "altiplan-bench");
  app.set_version_flag("--version", ALTIPLAN_VERSION);
  bench::Subcommands all(app);
  for (const auto add :
       {bench::add_grid, bench::add_any_angle, bench::add_search, bench::add_replan,
        bench::add_sampling, bench::add_ants, bench::add_pilot, bench::add_field,
        bench::add_queries, bench::add_dubins, bench::add_hybrid_astar, bench::add_airspace,
        bench::add_detours, bench::add_terrain, bench::add_reach, bench::add_legs, bench::add_plan,
        bench::add_watch}) {
    add(all);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? cli::kDone : cli::kUsage;
  }
  return cli::guarded("altiplan-bench", [&] {
    try {
      all.run();
      return cli::kDone;
    } catch (const bench::WrongAnswer& error) {
      std::cerr << "altiplan-bench: " << error.what() << '\n';
      return bench::kWrong;
    }
  });
}
