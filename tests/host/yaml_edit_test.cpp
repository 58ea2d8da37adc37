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

namespace altiplan::host::yaml_edit_test {
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

TEST(YamlEdit, AddsAnItemAfterTheLast) {
  EXPECT_EQ(edited("a: [1, 2] # c\n", {"a.2=3"}), "a: [1, 2, 3] # c\n");
  EXPECT_EQ(edited("a: []\n", {"a.0={b: 1}", "a.1.b=2"}), "a: [{b: 1}, {b: 2}]\n");
  EXPECT_EQ(edited("a:\n  - b: 1\n    c: 2   # two\n# end\nd: 1\n", {"a.1={b: 3}", "a.2.b=4"}),
            "a:\n  - b: 1\n    c: 2   # two\n  - {b: 3}\n  - {b: 4}\n# end\nd: 1\n");
  EXPECT_EQ(edited("a:\n- b: 1", {"a.1=2"}), "a:\n- b: 1\n- 2");
}

TEST(YamlEdit, RemovesAnItemOrAKeyWithItsLines) {
  EXPECT_EQ(edited("a: [1, 2, 3] # c\n", {"~a.1"}), "a: [1, 3] # c\n");
  EXPECT_EQ(edited("a: [1, 2, 3]\n", {"~a.2", "~a.0", "~a.0"}), "a: []\n");
  EXPECT_EQ(edited("a: {b: 1, c: 2}\n", {"~a.c"}), "a: {b: 1}\n");
  EXPECT_EQ(edited("a: 1\nb: 2   # two\nc: 3\n", {"~b"}), "a: 1\nc: 3\n");
  EXPECT_EQ(edited("# top\na: 1\nb: 2\n", {"~a"}), "# top\nb: 2\n");
  EXPECT_EQ(edited("a:\n  - b: 1\n    c: 2\n  # kept\n  - d: 3   # gone\n  - e: 4\n", {"~a.1"}),
            "a:\n  - b: 1\n    c: 2\n  # kept\n  - e: 4\n");
  EXPECT_EQ(edited("a:\n  - b: 1\n    c: 2\n  - e: 4\n", {"~a.0.b", "~a.1"}), "a:\n  - c: 2\n");
  EXPECT_EQ(edited("a:\n  - b: 1\n  - c: 2\nd: 3\n", {"~a.0", "~a.0"}), "a:\n  []\nd: 3\n");
  EXPECT_THROW(edited("a: [1]\n", {"~a.1"}), ConfigError);
  EXPECT_THROW(edited("a: [1]\n", {"~b"}), ConfigError);
}

/// A random value as text: in brackets, or as a block at that indent, with comments.
std::string random_yaml(SplitMix64& random, int depth, int indent, bool in_flow) {
  const auto pick = [&](int below) { return int(random.next() % std::uint64_t(below)); };
  const int kind = depth == 0 ? 0 : pick(3);
  if (kind == 0) {
    const char* const scalars[] = {"1",       "-2.5",       "word",
                                   "'a # b'", "\"x, [y]\"", "\xC3\xA9t\xC3\xA9"};
    return scalars[pick(6)];
  }
  const int count = pick(4);
  const bool is_flow = in_flow || count == 0 || pick(3) == 0;
  std::string text = is_flow ? (kind == 1 ? "[" : "{") : "";
  for (int n = 0; n < count; ++n) {
    const std::string key = kind == 1 ? (is_flow ? "" : "- ") : "k" + std::to_string(n) + ": ";
    const std::string value = random_yaml(random, depth - 1, indent + 2, is_flow);
    if (is_flow) {
      text += (n > 0 ? ", " : "") + key + value;
      continue;
    }
    const bool on_lines = value.find('\n') != value.npos;
    const std::string blanks(std::size_t(indent), ' ');
    // A list's item begins behind its dash, a key's block on the next line.
    const std::string begun = kind == 1 && on_lines ? value.substr(std::size_t(indent + 2)) : value;
    text += blanks + key + (kind == 2 && on_lines ? "\n" : "") + begun;
    text += on_lines       ? ""
            : pick(3) == 0 ? "  # c" + std::to_string(random.next() % 1000) + "\n"
                           : "\n";
    text += pick(5) == 0 ? blanks + "# between\n" : "";
  }
  return text + (is_flow ? (kind == 1 ? "]" : "}") : "");
}

/// A random place in the value, as keys; "" is the value itself.
std::string random_place(SplitMix64& random, const Value& value) {
  const std::size_t count = std::max(value.items.size(), value.entries.size());
  if (count == 0 || random.next() % 4 == 0) {
    return "";
  }
  const std::size_t n = random.next() % count;
  const bool is_list = value.kind == Value::Kind::list;
  const std::string rest = random_place(random, is_list ? value.items[n] : value.entries[n].value);
  return (is_list ? std::to_string(n) : value.entries[n].key) + (rest.empty() ? "" : "." + rest);
}

void hold_random_assignments(int trials) {
  SplitMix64 random(11);
  int changed = 0;
  int refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::string text = "top: 1\nroot:\n" + random_yaml(random, 3, 2, false) + "\nlast: 2 # end\n";
    if (text.find("\n  ") == text.npos) {
      continue;  // a scalar stands on the line below its key
    }
    for (int step = 0; step < 4; ++step) {
      Value tree = parse_yaml(text, "f");
      const Value& root = *tree.find("root");
      std::string place = random_place(random, root);
      const Value* here = &root;
      std::istringstream keys(place);
      for (std::string key; std::getline(keys, key, '.');) {
        here = here->kind == Value::Kind::map ? here->find(key) : &here->items[std::stoul(key)];
      }
      place = "root" + (place.empty() ? "" : "." + place);
      const bool is_list = here->kind == Value::Kind::list;
      const std::string one = random.next() % 3 == 0 ? "~" + place
                              : is_list ? place + "." + std::to_string(here->items.size()) + "=7"
                              : random.next() % 2 == 0 ? place + "=[8, {x: 9}]"
                                                       : place + ".fresh=a";
      apply_overrides(tree, {one}, FileOfKey::pipeline);
      try {
        text = edited(text, {one});
        ASSERT_TRUE(same_values(parse_yaml(text, "f"), tree)) << one << "\n" << text;
        EXPECT_NE(text.find("# end"), text.npos);
        ++changed;
      } catch (const ConfigError&) {
        ++refused;
      }
      if (tree.find("root") == nullptr || parse_yaml(text, "f").find("root") == nullptr) {
        break;
      }
    }
  }
  EXPECT_GT(changed, trials);
  EXPECT_LT(refused, changed / 20);
}

TEST(YamlEdit, RandomAssignmentsMeanTheSameInTheTextAndInTheTree) {
  hold_random_assignments(5'000);
}
TEST(NightlyYamlEdit, RandomAssignmentsMeanTheSameInTheTextAndInTheTree) {
  hold_random_assignments(20'000);
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
}  // namespace altiplan::host::yaml_edit_test
