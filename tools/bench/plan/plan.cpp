// SPDX-License-Identifier: Apache-2.0
// The time of a plan from the files to the result, for tools/bench/python_plan.py.
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/result/result_json.hpp"
#include "host/run/pipeline.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

/// One call: what it holds is freed when it returns.
Json call(const std::string& pipeline, const host::Overrides& overrides) {
  const double begin = wall_s();
  const host::Config config = host::load_config(pipeline, overrides);
  const double loaded = wall_s();
  const host::RunResult run = host::run(config, {});
  const double ran = wall_s();
  const host::Json result = host::result_json(config, run);
  return {{"load_ms", 1e3 * (loaded - begin)},
          {"run_ms", 1e3 * (ran - loaded)},
          {"result_ms", 1e3 * (wall_s() - ran)},
          {"expanded", result.at("metrics").at("expanded")}};
}

/// With `asked`, each call waits for a line of stdin, and its row is printed at once: so that calls
/// of another process can come between, which meet the same noise.
Json measure(const std::string& pipeline, const host::Overrides& overrides, int passes,
             bool asked) {
  Json figures;
  std::string line;
  for (int pass = 0; pass < passes && (!asked || std::getline(std::cin, line)); ++pass) {
    const double begin = wall_s();
    const double begin_cpu = process_s();
    Json row = call(pipeline, overrides);
    row["ms"] = 1e3 * (wall_s() - begin);
    row["cpu_ms"] = 1e3 * (process_s() - begin_cpu);
    if (asked) {
      std::cout << host::exact_json_text(row) << std::endl;
    } else {
      figures["calls"].push_back(std::move(row));
    }
  }
  return figures;
}
}  // namespace

void add_plan(Subcommands& all) {
  struct Arguments {
    std::string pipeline;
    std::vector<std::string> set;
    int passes = 20;
    bool asked = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("plan", "time a pipeline from its files to its result", [=](const Given&) {
        host::Overrides overrides;
        overrides.set = arguments->set;
        return measure(arguments->pipeline, overrides, arguments->passes, arguments->asked);
      });
  command.add_option("pipeline", arguments->pipeline, "pipeline file")->required();
  command.add_option("--set", arguments->set, "KEY=VALUE, as of altiplan run")
      ->allow_extra_args(false);
  command.add_option("--passes", arguments->passes, "so many calls")->check(CLI::Range(1, 100000));
  command.add_flag("--asked", arguments->asked,
                   "each call at a line of stdin, a row of JSON for it");
}
}  // namespace altiplan::bench
