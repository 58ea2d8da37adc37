// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {

/// A subcommand whose rows Google Benchmark times and prints; `add_rows` registers them.
inline CLI::App& add_google(Subcommands& all, const std::string& name, const std::string& sentence,
                            const std::function<void(const Given&)>& add_rows) {
  CLI::App& command = all.add(name, sentence, [=](const Given& given) -> Json {
    std::vector<std::string> words{"altiplan-bench"};
    words.insert(words.end(), given.others.begin(), given.others.end());
    if (given.as_json) {
      words.emplace_back("--benchmark_format=json");
    }
    std::vector<char*> arguments;
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    int count = int(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) {
      throw Error("unknown option of Google Benchmark");
    }
    add_rows(given);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return nullptr;
  });
  command.allow_extras()->footer(
      "Google Benchmark's options apply too: --benchmark_filter=REGEX, --benchmark_repetitions=N.");
  command.parse_complete_callback([&command, name] {
    for (const std::string& word : command.remaining()) {
      if (word.rfind("--benchmark_", 0) != 0) {
        throw CLI::ExtrasError(name, {word});
      }
    }
  });
  return command;
}
}  // namespace altiplan::bench
