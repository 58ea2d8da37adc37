// SPDX-License-Identifier: Apache-2.0
// The tables of parameters in the plugins' READMEs and in docs/reference/files.md are those of the
// code. With ALTIPLAN_UPDATE=1 in the environment they are written.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "host/describe/describe.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::host::parameter_tables_test {
namespace {
namespace fs = std::filesystem;

const fs::path kSource = altiplan::folders::source();

/// The text with the table between the opening mark and the next closing one.
std::string filled(const std::string& text, const std::string& open, const std::string& table) {
  static const std::string kClose = "<!-- /parameters -->";
  const std::size_t at = text.find(open + "\n");
  const std::size_t end = text.find(kClose, at);
  if (at == std::string::npos || end == std::string::npos) {
    ADD_FAILURE() << "there is no " << open << " … " << kClose;
    return text;
  }
  return text.substr(0, at) + open + "\n" + table + text.substr(end);
}

void expect_tables(const fs::path& file, const std::string& wanted) {
  if (std::getenv("ALTIPLAN_UPDATE") != nullptr) {
    std::ofstream(file, std::ios::binary) << wanted;
  }
  EXPECT_EQ(altiplan::testing::text_of(file), wanted)
      << file << " is not up to date: run this test with ALTIPLAN_UPDATE=1";
}

TEST(ParameterTables, OfPlugins) {
  Registry registry({altiplan::folders::build() / "lib/altiplan/plugins"});
  int tables = 0;
  for (const fs::directory_entry& kind : fs::directory_iterator(kSource / "plugins")) {
    if (!kind.is_directory()) {
      continue;
    }
    for (const fs::directory_entry& folder : fs::directory_iterator(kind)) {
      const std::string name = folder.path().filename().string();
      if (registry.offering(kind.path().filename().string(), name) == nullptr) {
        continue;  // an option of the build
      }
      SCOPED_TRACE(folder.path());
      for (const Description& description : describe_plugin(registry, name)) {
        if (description.kind != kind.path().filename()) {
          continue;
        }
        const fs::path file = folder.path() / "README.md";
        expect_tables(file, filled(altiplan::testing::text_of(file), "<!-- parameters -->",
                                   parameter_table(description.parameters)));
        ++tables;
      }
    }
  }
  EXPECT_GE(tables, 10);
}

TEST(ParameterTables, OfBuiltInShapes) {
  Registry none({});
  const fs::path file = kSource / "docs/reference/files.md";
  std::string wanted = altiplan::testing::text_of(file);
  for (const char* shape : {"sphere", "cylinder", "box", "prism"}) {
    wanted = filled(wanted, "<!-- parameters of " + std::string(shape) + " -->",
                    parameter_table(describe_plugin(none, shape).at(0).parameters));
  }
  expect_tables(file, wanted);
}
}  // namespace
}  // namespace altiplan::host::parameter_tables_test
