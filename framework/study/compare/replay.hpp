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

/// The configuration of a stored run: its files, what the study set in them, its seed. Throws Error
/// where the store does not know its variants, and as load_config.
host::Config config_of(const Store& store, const StoredRun& run,
                       const std::vector<std::filesystem::path>& plugin_path);

/// Limits of the stored study. Throws Error where its file cannot be read.
StudyBudget budget_of(const Store& store);

/// A run set beside its stored result.
struct Replayed {
  /// A sentence for each file, plugin and program that is not the one of the stored run.
  std::vector<std::string> changed;
  std::optional<host::Difference> difference;  ///< nothing where the results are identical
};
/// `stored` is the stored run, `result` what it gave now, `key` that of what it was made from now.
/// Where no result was stored (the run took too much) outcomes are compared.
Replayed compare_replay(const StoredRun& stored, const host::Json& result, const std::string& key);
}  // namespace altiplan::study
