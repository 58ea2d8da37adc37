// SPDX-License-Identifier: Apache-2.0
#include "altiplan/params.hpp"

#include <gtest/gtest.h>

#include "host/config/yaml.hpp"

namespace altiplan::params_test {
namespace {

enum class Mode { slow, fast };

struct Inner {
  double width_m = 1;
  void describe(Fields& f) { f("width_m", width_m).unit("m").greater_than(0).required(); }
};

struct Params {
  bool on = false;
  int count = 3;
  double share = 0.5;
  AutoNumber reach;
  std::string title = "none";
  Mode mode = Mode::slow;
  Path file;
  Vec3 cell_m{1, 2, 3};
  std::vector<double> list;
  std::vector<Inner> parts;
  std::optional<double> cap;
  Point at;
  void describe(Fields& f) {
    f("on", on);
    f("count", count).range(1, 10);
    f("share", share).range(0, 1).was("part").doc("a share");
    f("reach", reach).at_least(0);
    f("title", title);
    f("mode", mode, {{"slow", Mode::slow}, {"fast", Mode::fast}});
    f("file", file);
    f("cell_m", cell_m).unit("m").at_least(0.001);
    f("list", list).range(-5, 5);
    f("parts", parts);
    f("cap", cap).greater_than(0);
    f.point(at);
    f.check(share <= 0.9 || !on, "expected share at most 0.9 when on");
  }
};

std::string problems(const std::string& yaml) {
  Params params;
  const Value value = host::parse_yaml(yaml, "file.yaml");
  std::string text;
  for (const Problem& problem : bind(params, &value, "with").problems) {
    text += problem.text() + "\n";
  }
  return text;
}

Params read(const std::string& yaml) {
  Params params;
  const Value value = host::parse_yaml(yaml, "folder/file.yaml");
  const ParamReport report = bind(params, &value);
  EXPECT_TRUE(report.problems.empty()) << report.problems.front().text();
  return params;
}

TEST(Params, DefaultsStayWhereNothingIsGiven) {
  const Params params = read("{}");
  EXPECT_EQ(params.count, 3);
  EXPECT_EQ(params.cell_m, Vec3(1, 2, 3));
  EXPECT_FALSE(params.cap);
  EXPECT_EQ(params.at.form, Point::Form::none);
}

TEST(Params, ReadsEveryType) {
  const Params params = read(
      "on: true\ncount: 7\nshare: 0.25\nreach: auto\ntitle: '5'\nmode: fast\nfile: a.tif\n"
      "cell_m: [4, 5.5, 6e1]\nlist: [1, -2]\nparts: [{width_m: 2}, {width_m: 3}]\ncap: 9\n"
      "at_lonlat: [-84.3, 36.6]\nabove_ground_m: 20\n");
  EXPECT_TRUE(params.on);
  EXPECT_EQ(params.count, 7);
  EXPECT_EQ(params.share, 0.25);
  EXPECT_FALSE(params.reach.value);
  EXPECT_EQ(params.title, "5");
  EXPECT_EQ(params.mode, Mode::fast);
  EXPECT_EQ(params.file.text, "folder/a.tif");
  EXPECT_EQ(params.cell_m, Vec3(4, 5.5, 60));
  EXPECT_EQ(params.list, (std::vector<double>{1, -2}));
  ASSERT_EQ(params.parts.size(), 2u);
  EXPECT_EQ(params.parts[1].width_m, 3);
  EXPECT_EQ(params.cap, 9);
  EXPECT_EQ(params.at.form, Point::Form::lonlat);
  EXPECT_EQ(params.at.above_ground_m, 20);
}

TEST(Params, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(problems("on: yes"), "file.yaml:1:5: with.on: expected true or false, found 'yes'\n");
  EXPECT_EQ(problems("count: 2.5"),
            "file.yaml:1:8: with.count: expected an integer, found '2.5'\n");
  EXPECT_EQ(problems("count: 11"), "file.yaml:1:8: with.count: expected from 1 to 10, found 11\n");
  EXPECT_EQ(problems("share: '0.5'"),
            "file.yaml:1:8: with.share: expected a number, found the text \"0.5\"\n");
  EXPECT_EQ(problems("share: 010"), "file.yaml:1:8: with.share: expected a number, found '010'\n");
  EXPECT_EQ(problems("share: .nan"),
            "file.yaml:1:8: with.share: expected a finite number, found '.nan'\n");
  EXPECT_EQ(problems("reach: sometimes"),
            "file.yaml:1:8: with.reach: expected a number or auto, found 'sometimes'\n");
  EXPECT_EQ(problems("cap: 0"), "file.yaml:1:6: with.cap: expected more than 0, found 0\n");
  EXPECT_EQ(problems("cell_m: [1, 2]"),
            "file.yaml:1:9: with.cell_m: expected three numbers, found a list of 2\n");
  EXPECT_EQ(problems("cell_m: [1, 2, 0]"),
            "file.yaml:1:16: with.cell_m.2: expected at least 0.001 m, found 0\n");
  EXPECT_EQ(problems("list: [1, 9]"),
            "file.yaml:1:11: with.list.1: expected from -5 to 5, found 9\n");
  EXPECT_EQ(problems("mode: fats"),
            "file.yaml:1:7: with.mode: expected one of slow, fast; found 'fats' (did you mean "
            "'fast'?)\n");
  EXPECT_EQ(problems("parts: [{}]"), "file.yaml:1:9: with.parts.0: the key 'width_m' is missing\n");
  EXPECT_EQ(problems("part: 0.5"), "file.yaml:1:1: with.part: is now 'share'\n");
  EXPECT_EQ(problems("shar: 1"), "file.yaml:1:1: with.shar: unknown key; did you mean 'share'?\n");
  EXPECT_EQ(
      problems("at_m: [1, 2]\nat_lonlat: [3, 4]"),
      "file.yaml:2:12: with.at_lonlat: a point needs only one of at_m, at_lonlat and at_cell\n");
  EXPECT_EQ(problems("at_m: [1, 2, 3]\nabove_ground_m: 4"),
            "file.yaml:2:17: with.above_ground_m: the point already has a height: give its third "
            "coordinate or above_ground_m\n");
  EXPECT_EQ(problems("on: true\nshare: 0.95"),
            "file.yaml:1:1: with: expected share at most 0.9 when on\n");
}

TEST(Params, FindsEveryProblemAtOnce) {
  EXPECT_EQ(problems("on: 1\ncount: x\nextra: 2\n"),
            "file.yaml:1:5: with.on: expected true or false, found '1'\n"
            "file.yaml:2:8: with.count: expected an integer, found 'x'\n"
            "file.yaml:3:1: with.extra: unknown key; expected one of on, count, share, reach, "
            "title, mode, file, cell_m, list, parts, cap, at_m, at_lonlat, at_cell, "
            "above_ground_m\n");
}

TEST(Params, OneDeclarationFeedsTheDescription) {
  Params params;
  const ParamReport report = bind(params, nullptr);
  const FieldSpec& share = report.fields[2].spec;
  EXPECT_EQ(share.name, "share");
  EXPECT_EQ(share.default_json, "0.5");
  EXPECT_EQ(share.max, 1);
  EXPECT_EQ(share.doc, "a share");
  const FieldSpec& mode = report.fields[5].spec;
  EXPECT_EQ(mode.type, FieldType::choice);
  EXPECT_EQ(mode.choices, (std::vector<std::string>{"slow", "fast"}));
  const FieldSpec& parts = report.fields[9].spec;
  EXPECT_EQ(parts.children.at(0).children.at(0).name, "width_m");
  EXPECT_EQ(report.fields[7].value_json, "[1, 2, 3]");
}

TEST(NearestName, FindsSlipsAndLeavesStrangersAlone) {
  const std::vector<std::string> names{"weight_g", "weight_h", "cell_m"};
  EXPECT_EQ(nearest_name("wieght_g", names), "weight_g");
  EXPECT_EQ(nearest_name("cellm", names), "cell_m");
  EXPECT_EQ(nearest_name("zzz", names), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), names), "");
}
}  // namespace
}  // namespace altiplan::params_test
