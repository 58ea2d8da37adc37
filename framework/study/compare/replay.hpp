// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/result/difference.hpp"
#include "study/model/study_file.hpp"
#include "study/store/store.hpp"

namespace altiplan::study {

/// The configuration of a stored run: its files, the keys that the study sets in them, its seed.
/// Throws Error if the store lacks its variants, and like load_config.
host::Config config_of(const Store& store, const StoredRun& run,
                       const std::vector<std::filesystem::path>& plugin_path);

/// Limits of the stored study. Throws Error if its file cannot be read.
StudyBudget budget_of(const Store& store);

/// The comparison of a run with its stored result.
struct Replayed {
  /// A sentence for each file, plugin and program that has changed since the stored run.
  std::vector<std::string> changed;
  std::optional<host::Difference> difference;  ///< none if the results are identical
};
/// `stored` is the stored run, `result` the new result, `key` the hash of its present inputs. If no
/// result was stored (the run exceeded a limit), outcomes are compared.
Replayed compare_replay(const StoredRun& stored, const host::Json& result, const std::string& key);
}  // namespace altiplan::study
