// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace altiplan::study {

struct Merged {
  std::size_t runs = 0;   ///< in the new store
  std::size_t again = 0;  ///< stored more than once with the same result
  /// A sentence for each run with different results in two stores; the first result is kept.
  std::vector<std::string> differing;
};

/// Merges the runs of the stores, shards of one study, into a new one, which is renamed to `out`
/// once complete; it may replace one of them. Throws Error if they are of different studies, or
/// contain results of one run from different files, plugins or hosts, or if another process is
/// writing `out` or one of the stores.
Merged merge_stores(const std::vector<std::string>& stores, const std::filesystem::path& out);

/// The difference of two studies (Store::study), "" if they are equal. The path of the file does
/// not count.
std::string studies_differ(const std::map<std::string, std::string>& first,
                           const std::map<std::string, std::string>& second);
}  // namespace altiplan::study
