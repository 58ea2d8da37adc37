// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/result/result_json.hpp"

namespace altiplan::testing {

/// A folder of the running test's own, gone with this object.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  /// Writes a file and returns where it is.
  std::filesystem::path write(std::string_view name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

std::string text_of(const std::filesystem::path& file);
/// Throws where `from` does not stand in the text.
std::string replaced(std::string text, std::string_view from, std::string_view to);

/// load_config, run and result_json, with the plugins of this build.
struct Ran {
  host::Json json;
  int exit_code = -1;
};
Ran run_file(const std::filesystem::path& pipeline, host::Overrides overrides = {},
             int threads = 1);

/// The document of a YAML file, typed as the file is.
host::Json yaml_as_json(const std::filesystem::path& file);

/// What an independent validator says of documents that should or should not fit the schema; ""
/// where it agrees with all.
std::string schema_disagreement(const host::Json& schema,
                                const std::vector<std::pair<bool, host::Json>>& cases);
/// Whether that validator is there (Debian: python3-jsonschema).
bool has_schema_validator();
}  // namespace altiplan::testing
