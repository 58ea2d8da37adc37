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
  std::size_t again = 0;  ///< that another store held already, with the same result
  /// A sentence for each run of which two stores hold different results; the first one is kept.
  std::vector<std::string> differing;
};

/// Puts the runs of the stores, parts of one study, into a new one, which appears under its name
/// when it is whole; it may take the place of one of them. Throws Error where they are of different
/// studies, or hold results of one run from different files, plugins or hosts, and where another
/// process is at work on `out` or on one of the stores.
Merged merge_stores(const std::vector<std::string>& stores, const std::filesystem::path& out);

/// How two studies (Store::study) differ, "" where they are the same. Where the file lies does not
/// count.
std::string studies_differ(const std::map<std::string, std::string>& first,
                           const std::map<std::string, std::string>& second);
}  // namespace altiplan::study
