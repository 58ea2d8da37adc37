// SPDX-License-Identifier: Apache-2.0
#include "host/config/yaml_edit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "altiplan/error.hpp"
#include "host/config/yaml.hpp"
#include "support/support.hpp"

namespace altiplan::host {
namespace {

std::string edited(const std::string& text, const std::vector<std::string>& set) {
  return with_assignments(text, "f", set, FileOfKey::pipeline);
}

TEST(YamlEdit, ChangesAValueWhereItStands) {
  EXPECT_EQ(edited("# top\na: 1   # one\nb: two\n", {"a=25"}), "# top\na: 25   # one\nb: two\n");
  EXPECT_EQ(edited("a: {b: [1, 2], c: 'x # y'}  # c\n", {"a.c=z", "a.b.1=7"}),
            "a: {b: [1, 7], c: z}  # c\n");
  EXPECT_EQ(edited("a:\n  - x: 1\n    y: 2\n  # between\n  - x: 3\n", {"a.1.x=4", "a.0.y=[5, 6]"}),
            "a:\n  - x: 1\n    y: [5, 6]\n  # between\n  - x: 4\n");
  EXPECT_EQ(edited("a: [1,   # first\n    2]\nb: 3", {"b=4", "a=[]"}), "a: []\nb: 4");
  EXPECT_EQ(edited("\xC3\xA9: 1 # \xC3\xA9\nb: {\xC3\xA9: 2, d: 3}\n", {"b.d=9"}),
            "\xC3\xA9: 1 # \xC3\xA9\nb: {\xC3\xA9: 2, d: 9}\n");
}

TEST(YamlEdit, AddsAMissingKeyAsTheLastOfItsMap) {
  EXPECT_EQ(edited("a: {b: 1}\n", {"a.c=2"}), "a: {b: 1, c: 2}\n");
  EXPECT_EQ(edited("a: {}\n", {"a.c.d=2"}), "a: {c: {d: 2}}\n");
  EXPECT_EQ(edited("s:\n  - plan: x   # why\n  - fly: y\n", {"s.0.with.w=2"}),
            "s:\n  - plan: x   # why\n    with: {w: 2}\n  - fly: y\n");
  EXPECT_EQ(edited("a: 1", {"b=2"}), "a: 1\nb: 2");
}

TEST(YamlEdit, RefusesWhatItCannotChangeAlone) {
  EXPECT_THROW(edited("a: &x {b: 1}\nc: *x\n", {"c.b=2"}), ConfigError);
  EXPECT_THROW(edited("a: one\n  more\nb: 2\n", {"a=3"}), ConfigError);
  EXPECT_THROW(edited("a: [1]\n", {"a.4=3"}), ConfigError);
}

struct Path {
  std::string keys;
  bool is_list = false;
};

void collect(const Value& value, const std::string& path, std::vector<Path>& paths) {
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    collect(value.items[i], path + "." + std::to_string(i), paths);
  }
  for (const Value::Entry& entry : value.entries) {
    if (entry.key.find('.') == std::string::npos) {
      collect(entry.value, path + (path.empty() ? "" : ".") + entry.key, paths);
    }
  }
  if (value.kind != Value::Kind::map && !path.empty()) {
    paths.push_back({path, value.kind == Value::Kind::list});
  }
}

std::vector<std::string> comments(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (const std::size_t at = line.find("# "); at != std::string::npos) {
      all.push_back(line.substr(at));
    }
  }
  return all;
}

TEST(YamlEdit, EveryValueOfEveryConfigurationCanBeChangedAndNothingElseIs) {
  SplitMix64 random(5);
  int changed = 0;
  int refused = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(testing::configs())) {
    if (file.path().extension() != ".yaml") {
      continue;
    }
    std::ifstream in(file.path());
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const Value tree = parse_yaml(text, "f");
    std::vector<Path> paths;
    collect(tree, "", paths);
    for (const auto& [keys, is_list] : paths) {
      if (random.uniform() > 0.1) {
        continue;
      }
      const std::string value = random.uniform() < 0.5 ? "[1, 2.5]" : "3.25";
      try {
        const std::string after = edited(text, {keys + "=" + value});
        Value wanted = tree;
        apply_overrides(wanted, {keys + "=" + value}, FileOfKey::pipeline);
        ASSERT_TRUE(same_values(parse_yaml(after, "f"), wanted)) << file.path() << keys;
        if (!is_list) {
          ASSERT_EQ(comments(after), comments(text)) << file.path() << keys;
        }
        ++changed;
      } catch (const ConfigError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(changed, 300);
  EXPECT_LT(refused, changed / 50);
}
}  // namespace
}  // namespace altiplan::host
