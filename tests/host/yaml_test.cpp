// SPDX-License-Identifier: Apache-2.0
#include "host/config/yaml.hpp"

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <fstream>
#include <locale>

#include "altiplan/error.hpp"
#include "altiplan/random.hpp"

namespace altiplan::host::yaml_test {
namespace {

/// What the reader says of `text`, a problem a line ("LINE:COLUMN key: message"); "" if it reads.
std::string problems_of(const std::string& text) {
  try {
    parse_yaml(text, "f");
  } catch (const ConfigError& error) {
    std::string all;
    for (const Problem& problem : error.problems()) {
      EXPECT_EQ(problem.where.file, "f");
      all += (all.empty() ? "" : "\n") + std::to_string(problem.where.line) + ":" +
             std::to_string(problem.where.column) + " " + problem.key + ": " + problem.message;
    }
    return all;
  }
  return "";
}

bool starts_with(const std::string& text, const std::string& start) {
  return text.substr(0, start.size()) == start;
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) {
    all += text;
  }
  return all;
}

#define EXPECT_PROBLEM(text, start) \
  EXPECT_PRED2(starts_with, problems_of(text), start) << "for " << ::testing::PrintToString(text)

TEST(Yaml, KeepsTextAndPlaces) {
  const Value value =
      parse_yaml("a: 1\nb: [010, \"5\", {yes: no}]\nl:\n  - ü: on\n    é: x\n", "f");
  ASSERT_EQ(value.kind, Value::Kind::map);
  EXPECT_EQ(value.where.line, 1);
  EXPECT_EQ(value.where.column, 1);
  EXPECT_EQ(value.find("a")->text, "1");
  EXPECT_EQ(value.find("a")->where.column, 4);
  const Value& b = *value.find("b");
  ASSERT_EQ(b.items.size(), 3U);
  EXPECT_EQ(b.items[0].text, "010");
  EXPECT_FALSE(b.items[0].quoted);
  EXPECT_EQ(b.items[1].text, "5");
  EXPECT_TRUE(b.items[1].quoted);
  EXPECT_EQ(b.items[2].find("yes")->text, "no");
  const Value& item = value.find("l")->items.at(0);
  EXPECT_EQ(item.find("ü")->where.line, 4);
  EXPECT_EQ(item.find("ü")->where.column, 8) << "columns count characters, not bytes";
  EXPECT_EQ(item.entries[1].key, "é");
  EXPECT_EQ(item.entries[1].where.line, 5);
}

TEST(Yaml, AliasesAreCopies) {
  const Value value = parse_yaml("a: &x {k: [1, 2]}\nb: *x\nc: [*x, &y z, *y]\n", "f");
  EXPECT_EQ(value.find("b")->find("k")->items[1].text, "2");
  EXPECT_EQ(value.find("b")->where.line, 2);
  EXPECT_EQ(value.find("c")->items[0].find("k")->items[0].text, "1");
  EXPECT_EQ(value.find("c")->items[2].text, "z");
}

TEST(Yaml, AcceptsByteOrderMarkWindowsLinesAndDocumentMarks) {
  EXPECT_EQ(parse_yaml("\xEF\xBB\xBF---\r\na: 1\r\nb: 2\r\n...\r\n", "f").find("b")->text, "2");
  EXPECT_PROBLEM("\xEF\xBB\xBFü: 1\nü: 2\n",
                 "2:1 ü: this key occurs twice in one map, first on line 1");
}

TEST(Yaml, RefusesWhatCarriesNoValue) {
  EXPECT_PROBLEM("a:\nb: 2\n", "1:1 a: has no value");
  EXPECT_PROBLEM("l:\n  - 1\n  -\n\n  - 2\n", "3:3 l.1: has no value");
  EXPECT_PROBLEM("l:\n  - 1\n  - # nothing\nb: 1\n", "2:3 l.1: has no value");
  EXPECT_PROBLEM("{a, b: }", "1:2 a: has no value\n1:5 b: has no value");
  for (const char* word : {"null", "Null", "NULL", "~"}) {
    EXPECT_PROBLEM(std::string("a: ") + word, std::string("1:4 a: '") + word + "' is not a value");
  }
  EXPECT_PROBLEM("null\n", "1:1 : 'null' is not a value");
  EXPECT_PROBLEM("a:\nnull_island: 3\n", "1:1 a: has no value");
  EXPECT_EQ(problems_of("a: \"\"\nb: 'null'\n"), "");
  EXPECT_PROBLEM("", "0:0 : the file is empty");
  EXPECT_PROBLEM("# only words\n\n", "0:0 : the file is empty");
}

TEST(Yaml, RefusesEveryDuplicateKeyAtOnce) {
  EXPECT_EQ(problems_of("a: 1\n'a': 2\nb:\n  - {c: 1, c: 2}\n"),
            "2:1 a: this key occurs twice in one map, first on line 1\n"
            "4:12 b.0.c: this key occurs twice in one map, first on line 4");
}

TEST(Yaml, RefusesWhatIsNotPlainData) {
  EXPECT_PROBLEM("a: &x {k: 1}\nb:\n  <<: *x\n", "3:3 b.<<: merge keys ('<<') are not supported");
  EXPECT_EQ(problems_of("'<<': 1"), "");
  for (const char* tagged : {"!!str 5", "! 5", "!mine [1]", "!<x> {}", "&a ! 5", "!!null", "!"}) {
    EXPECT_PROBLEM(std::string("a: ") + tagged, "1:4 a: tags ('!…') are not supported");
  }
  EXPECT_PROBLEM("%YAML 1.2\n---\na: 1\n", "1:1 : lines that start with '%'");
  EXPECT_PROBLEM("? [1]\n: 2\n", "1:3 : a list cannot be a key");
  EXPECT_PROBLEM("? {a: 1}\n: 2\n", "1:3 : a map cannot be a key");
  EXPECT_PROBLEM(": 2\n", "1:1 : a value without a key");
  EXPECT_PROBLEM("a: &x k\n*x : 2\n", "2:1 : an alias cannot be a key");
}

TEST(Yaml, RefusesASecondDocumentAndLeftovers) {
  EXPECT_PROBLEM("a: 1\n---\nb: 2\n", "2:1 : a second document");
  EXPECT_PROBLEM("a: 1\n...\n---\n", "3:1 : a second document");
  EXPECT_PROBLEM("[1, 2] and\n", "1:8 : text after the end of the document");
}

TEST(Yaml, SyntaxErrorsSayWhatToChange) {
  EXPECT_PROBLEM("a: 1\n\tb: 2\n", "2:1 : a tab indents this line");
  EXPECT_PROBLEM("a:\n  \tb: 2\n", "2:3 : a tab indents this line");
  EXPECT_EQ(problems_of("a: 1\n \t \nb:\t2\n"), "");
  EXPECT_PROBLEM("a: b: c\n", "1:5 : a ':' without a key");
  EXPECT_PROBLEM("a: 1\n b: 2\n", "2:3 : a ':' without a key");
  EXPECT_PROBLEM("a: [1, 2\nb: 3\n", "2:2 : the list that starts with '[' is not closed properly");
  EXPECT_PROBLEM("a: {b: 1]\n", "1:9 : a closing bracket that does not match");
  EXPECT_PROBLEM("a: \"abc\nb: 1\n", "1:4 a: the closing quote is missing");
  EXPECT_PROBLEM("a: &x 'it''s\nb: 1\n", "1:4 a: the closing quote is missing");
  EXPECT_PROBLEM("a: @x\n", "1:4 : a character that cannot start a value");
  EXPECT_PROBLEM("a: *x\n", "1:4 : an alias ('*name') without an anchor");
  EXPECT_NE(problems_of("a: [1, [2\n"), "");
  EXPECT_NE(problems_of("a: {b: 1\n"), "");
}

TEST(Yaml, RefusesBytesThatAreNotText) {
  EXPECT_PROBLEM("a: \xFF\n", "1:4 : the byte 0xff is not UTF-8");
  EXPECT_PROBLEM("a: \xC0\xAF\n", "1:4 : the byte 0xc0 is not UTF-8");
  EXPECT_PROBLEM("a: \xED\xA0\x80\n", "1:4 : the byte 0xed is not UTF-8");
  EXPECT_PROBLEM("a: \xE2\x82", "1:4 : the byte 0xe2 is not UTF-8");
  EXPECT_PROBLEM(std::string("\xFF\xFE"
                             "a\0",
                             4),
                 "1:1 : the byte 0xff is not UTF-8");
  EXPECT_PROBLEM(std::string("a: \0b", 5), "1:4 : the control character 0x00");
  EXPECT_PROBLEM("a: 1\n\x04 b", "2:1 : the control character 0x04");
  EXPECT_PROBLEM("a: \"\\x01\"\n", "1:4 a: a control character in a text");
}

TEST(Yaml, CapsNestingBeforeTheStackEnds) {
  EXPECT_EQ(problems_of(repeated("[", 64) + repeated("]", 64)), "");
  EXPECT_PROBLEM(repeated("[", 65) + repeated("]", 65), "1:65 : nested more than 64 levels deep");
  for (const char* opener : {"[", "{", "- ", "- [\n", "[a, {b: "}) {
    const std::string problems = problems_of(repeated(opener, 100'000));
    EXPECT_NE(problems.find("nested more than 64 levels deep"), problems.npos) << opener;
  }
  std::string aliased = "a0: &a0 [x]\n";
  for (int i = 1; i < 64; ++i) {
    const std::string n = std::to_string(i);
    aliased += "a" + n + ": &a" + n + " [*a" + std::to_string(i - 1) + "]\n";
  }
  EXPECT_PROBLEM(aliased, "64:12 : nested more than 64 levels deep");
}

/// A random value as JSON, with spaces and ends of lines where they may stand.
std::string random_json(SplitMix64& random, int depth) {
  const auto gap = [&] {
    constexpr std::array kGaps{"", "", " ", "\n", "\r\n  ", "\n\n "};
    return std::string(kGaps[random.next() % kGaps.size()]);
  };
  constexpr std::array kScalars{
      "1",    "-0.5", "1e5",           "12345678901234567890", "\"5\"", "true", "false",
      "0.10", "\"\"", "\"a: [b, c}\"", "\"\\n\\\"\\u00fc\"",   "\"ü#\""};
  const std::uint64_t kind = random.next() % 4;
  if (depth == 0 || kind >= 2) {
    return kScalars[random.next() % kScalars.size()];
  }
  std::string text = kind == 0 ? "[" : "{";
  const std::uint64_t count = random.next() % 4;
  for (std::uint64_t n = 0; n < count; ++n) {
    text += (n == 0 ? "" : "," + gap()) + gap();
    text += kind == 0 ? "" : "\"é" + std::to_string(n) + "\" : ";
    text += random_json(random, depth - 1) + gap();
  }
  return text + gap() + (kind == 0 ? "]" : "}");
}

void expect_equal(const Value& a, const Value& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.text, b.text);
  EXPECT_EQ(a.quoted, b.quoted);
  EXPECT_EQ(std::pair(a.where.line, a.where.column), std::pair(b.where.line, b.where.column));
  ASSERT_EQ(a.items.size(), b.items.size());
  for (std::size_t n = 0; n < a.items.size(); ++n) {
    expect_equal(a.items[n], b.items[n]);
  }
  ASSERT_EQ(a.entries.size(), b.entries.size());
  for (std::size_t n = 0; n < a.entries.size(); ++n) {
    EXPECT_EQ(a.entries[n].key, b.entries[n].key);
    EXPECT_EQ(std::pair(a.entries[n].where.line, a.entries[n].where.column),
              std::pair(b.entries[n].where.line, b.entries[n].where.column));
    expect_equal(a.entries[n].value, b.entries[n].value);
  }
}

TEST(Yaml, OfJsonTheSameAsWithAComment) {
  SplitMix64 random(5);
  for (int n = 0; n < 3000; ++n) {
    const std::string text = "{\"root\": " + random_json(random, 5) + "}";
    SCOPED_TRACE(text);
    const Value as_json = parse_yaml(text, "f");
    expect_equal(as_json, parse_yaml(text + "\n# no JSON", "f"));
    if (HasFailure()) {
      break;
    }
  }
  EXPECT_PROBLEM("{\"a\": 1,\n \"a\": 2}", "2:2 a: this key occurs twice");
  EXPECT_PROBLEM("{\"a\": {\"b\": null}}", "1:13 a.b: 'null' is not a value");
  EXPECT_PROBLEM("{\"a\": \"\\u0007\"}", "1:7 a: a control character");
  EXPECT_PROBLEM("{\"a\": " + repeated("[", 70) + repeated("]", 70) + "}",
                 "1:70 : nested more than 64");
}

TEST(Yaml, CapsNodesAndCycles) {
  EXPECT_PROBLEM("a: &a [1, *a]\n", "1:11 a.1: an alias to a list or map that contains it");
  EXPECT_PROBLEM("&a {b: {c: *a}}\n", "1:12 b.c: an alias to a list or map");
  std::string bomb = "a0: &a0 [x,x,x,x,x,x,x,x,x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string n = std::to_string(i);
    const std::string alias = "*a" + std::to_string(i - 1);
    bomb += "a" + n + ": &a" + n + " [" + repeated(alias + ",", 8) + alias + "]\n";
  }
  ASSERT_LT(bomb.size(), 430U);
  EXPECT_NE(problems_of(bomb).find("more than 1000000 values in one file"), std::string::npos);
  for (const std::string& many :
       {repeated("- 1\n", 1'000'001), "[" + repeated("1,", 1'000'001) + "]",
        "[" + repeated("\"\"", 4'000'000) + "]"}) {
    EXPECT_NE(problems_of(many).find("more than 1000000 values"), std::string::npos);
  }
  EXPECT_EQ(parse_yaml("[" + repeated("1,", 999'000) + "]", "f").items.size(), 999'000U);
}

TEST(Yaml, FilesThatCannotBeRead) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      load_yaml(file);
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.problems().at(0).where.file, file.string());
      return error.problems().at(0).message;
    }
    return "";
  };
  const std::filesystem::path folder = ::testing::TempDir();
  EXPECT_EQ(message(folder / "no_such_file.yaml"), "there is no such file");
  EXPECT_EQ(message(folder), "is a folder, expected a file");
  const std::filesystem::path large = folder / "altiplan_large.yaml";
  std::ofstream(large) << "a: " << std::string(std::size_t{16} << 20, 'x');
  EXPECT_PRED2(starts_with, message(large), "is larger than 16 MiB");
  std::ofstream(large) << "a: 1\n";
  EXPECT_EQ(load_yaml(large).find("a")->where.file, large.string());
  std::filesystem::remove(large);
}

TEST(Yaml, Overrides) {
  EXPECT_EQ(parse_override("0.6", "--set a=0.6").text, "0.6");
  EXPECT_EQ(parse_override("[1, 2]", "--set a=[1, 2]").items.size(), 2U);
  const Value map = parse_override("{k: 'v'}", "--set a={k: 'v'}");
  EXPECT_EQ(map.find("k")->where.override_text, "--set a={k: 'v'}");
  EXPECT_EQ(map.where.line, 0);
  for (const char* bad : {"", "~", "a\nb", "[1", "{a: 1, a: 2}", "!x 1", "1 # \x01"}) {
    try {
      parse_override(bad, "--set a");
      ADD_FAILURE() << "accepted " << bad;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.problems().at(0).where.override_text, "--set a");
      EXPECT_EQ(error.problems().at(0).where.file, "");
    }
  }
}

struct CommaDecimals : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Yaml, TheLocaleChangesNothing) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimals));
  const Value value = parse_yaml("a: 1234.5\nb: \"\\u00e9\"\n", "f");
  const std::string problems = problems_of(repeated("\n", 1233) + "a: 1\na: 2\n");
  std::locale::global(before);
  EXPECT_EQ(value.find("a")->text, "1234.5");
  EXPECT_EQ(value.find("b")->text, "é");
  EXPECT_EQ(problems, "1235:1 a: this key occurs twice in one map, first on line 1234");
}
}  // namespace
}  // namespace altiplan::host::yaml_test
