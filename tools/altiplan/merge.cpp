// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "progress.hpp"
#include "study/store/merge.hpp"
#include "study/store/place.hpp"

namespace altiplan::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> stores;
  std::string out;
};

/// Throws Error if the output exists and is not among the merged stores: its runs would be lost.
void expect_no_loss(const MergeArguments& arguments) {
  std::error_code error;
  const bool merged =
      std::any_of(arguments.stores.begin(), arguments.stores.end(), [&](const std::string& store) {
        return std::filesystem::equivalent(store, arguments.out, error);
      });
  if (std::filesystem::exists(arguments.out, error) && !merged) {
    throw Error("-o: '" + arguments.out +
                "' exists: list it among the stores to keep its runs, or give another name");
  }
}

int merge(const MergeArguments& arguments) {
  expect_store_writable(arguments.out, "-o");
  expect_no_loss(arguments);
  const study::Merged merged =
      busy("merging", [&] { return study::merge_stores(arguments.stores, arguments.out); });
  for (const std::string& sentence : merged.differing) {
    warn(sentence);
  }
  std::printf("%s: %zu run%s of %zu store%s", arguments.out.c_str(), merged.runs,
              merged.runs == 1 ? "" : "s", arguments.stores.size(),
              arguments.stores.size() == 1 ? "" : "s");
  if (merged.again > 0) {
    std::printf("; %zu stored more than once with the same result", merged.again);
  }
  std::printf("\n");
  return kDone;
}
}  // namespace

void add_merge(App& app, Action& action) {
  auto [command, arguments] = add_command<MergeArguments>(
      app, action, "merge", "merge the shards of a study into one database", merge);
  command.add_option("stores DB", arguments.stores, "study databases, all of the same study")
      ->required();
  command.add_option("-o,--out DB", arguments.out, "merged database")->required();
  set_example(command, "altiplan merge part-1.db part-2.db -o all.db");
}
}  // namespace altiplan::cli
