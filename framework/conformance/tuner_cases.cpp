// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>

#include "report.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kInside =
    "Tuner contract 1: ask returns points inside the space, all groups summing to 1; an empty "
    "batch "
    "ends "
    "the search";
constexpr const char* kScores =
    "Tuner contract 2: tell follows ask, one score per point, lower is better, infinity for a "
    "failure";
constexpr const char* kEqual =
    "Tuner contract 3: equal spaces, streams and scores give equal batches";

using TunerPoint = std::vector<double>;
using Batch = std::vector<TunerPoint>;
using Score = std::function<double(const TunerPoint&)>;

/// A search that asks for more counts as endless for a study.
constexpr std::size_t kMaxPoints = 100'000;

struct TunerBench {
  Factory<Tuner> make;
  Options options;

  RandomStream stream() const { return RandomStream(options.seed).sub("tuner"); }
};

std::vector<std::pair<const char*, std::vector<Dimension>>> spaces() {
  return {{"one dimension", {{"a", -3, 7, -1}}},
          {"three dimensions", {{"a", 0, 1, -1}, {"b", -1e6, 1e6, -1}, {"c", 1e-9, 2e-9, -1}}},
          {"three weights", {{"u", 0, 1, 0}, {"v", 0, 1, 0}, {"w", 0, 1, 0}}},
          {"two groups and a number",
           {{"u", 0, 1, 4}, {"a", 5, 6, -1}, {"v", 0, 1, 4}, {"x", 0, 1, 1}, {"y", 0, 1, 1}}},
          {"weights with bounds", {{"u", 0.1, 0.6, 0}, {"v", 0.2, 0.7, 0}, {"w", 0.1, 0.9, 0}}},
          {"nothing to choose", {{"a", 2, 2, -1}, {"w", 0, 1, 0}}}};
}

std::string point_text(const TunerPoint& point) {
  std::string all = "(";
  for (const double x : point) {
    all += (all.size() > 1 ? ", " : "") + text(x);
  }
  return all + ")";
}

/// Why the point does not lie in the space; "" if it does.
std::string misplaced(const TunerPoint& point, const std::vector<Dimension>& space) {
  if (point.size() != space.size()) {
    return std::to_string(point.size()) + " numbers for " + std::to_string(space.size()) +
           " dimensions";
  }
  std::map<int, double> sums;
  for (std::size_t i = 0; i < space.size(); ++i) {
    const Dimension& d = space[i];
    const double slack = d.group >= 0 ? 1e-9 : 0;
    if (!(point[i] >= d.min - slack && point[i] <= d.max + slack)) {
      return "'" + d.name + "' is outside " + text(d.min) + " to " + text(d.max);
    }
    sums[d.group] += point[i];
  }
  sums.erase(-1);
  for (const auto& [group, sum] : sums) {
    if (std::abs(sum - 1) > 1e-9) {
      return "group " + std::to_string(group) + " sums to " + text(sum);
    }
  }
  return "";
}

std::vector<Batch> search(const TunerBench& bench, const std::vector<Dimension>& space,
                          const Score& score, Report& report, const std::string& name) {
  const auto tuner = bench.make();
  const auto search = tuner->begin(space, bench.stream());
  if (!report.expect(search != nullptr, kInside,
                     [&] { return name + ": the tuner begins no search"; })) {
    return {};
  }
  std::vector<Batch> batches;
  std::size_t points = 0;
  while (points < kMaxPoints) {
    batches.push_back(search->ask());
    std::vector<double> scores;
    for (const TunerPoint& point : batches.back()) {
      const std::string wrong = misplaced(point, space);
      if (!report.expect(wrong.empty(), kInside, [&] {
            return name + ", point " + std::to_string(points + scores.size()) + " " +
                   point_text(point) + ": " + wrong;
          })) {
        return batches;
      }
      scores.push_back(score(point));
    }
    if (batches.back().empty()) {
      report.expect(search->ask().empty(), kInside,
                    [&] { return name + ": after an empty batch the tuner asks for more"; });
      return batches;
    }
    points += scores.size();
    search->tell(scores);
  }
  report.add(kInside, name + ": no empty batch after " + std::to_string(points) + " points");
  return batches;
}

double bowl(const TunerPoint& point) {
  double sum = 0;
  for (const double x : point) {
    sum += (x - 0.3) * (x - 0.3);
  }
  return sum;
}

void inside(const TunerBench& bench, Report& report) {
  for (const auto& [name, space] : spaces()) {
    const auto batches = search(bench, space, bowl, report, name);
    report.expect(batches.size() > 1, kInside, [&, name = name] {
      return std::string(name) + ": the tuner asks for nothing at all";
    });
  }
}

void failures(const TunerBench& bench, Report& report) {
  const double inf = kInfinity;
  const std::vector<std::pair<const char*, Score>> scores{
      {"every score infinite", [inf](const TunerPoint&) { return inf; }},
      {"half of the scores infinite",
       [inf](const TunerPoint& p) { return p[0] < 0.4 ? inf : bowl(p); }},
      {"all scores equal", [](const TunerPoint&) { return 1.0; }},
      {"huge scores", [](const TunerPoint& p) { return 1e300 * bowl(p); }},
      {"negative scores", [](const TunerPoint& p) { return -bowl(p); }}};
  for (const auto& [what, score] : scores) {
    for (const auto& [name, space] : spaces()) {
      search(bench, space, score, report, std::string(name) + ", " + what);
    }
  }
}

void equal_searches(const TunerBench& bench, Report& report) {
  for (const auto& [name, space] : spaces()) {
    const auto& dimensions = space;
    const char* const what = name;
    const auto first = search(bench, dimensions, bowl, report, what);
    std::vector<Batch> one;
    std::vector<Batch> other;
    Report aside[2];
    in_two_threads([&] { one = search(bench, dimensions, bowl, aside[0], what); },
                   [&] { other = search(bench, dimensions, bowl, aside[1], what); });
    report.expect(first == one && first == other, kEqual, [&] {
      return std::string(what) + ": searches with equal streams and scores diverge";
    });
  }
}

/// Two searches of one tuner, interleaved.
void searches_in_turns(const TunerBench& bench, Report& report) {
  const auto tuner = bench.make();
  const std::vector<Dimension> space = spaces()[3].second;
  const auto one = tuner->begin(space, bench.stream());
  const auto other = tuner->begin(space, bench.stream());
  for (int n = 0; n < 100; ++n) {
    const Batch a = one->ask();
    const Batch b = other->ask();
    if (!report.expect(
            a == b, kEqual,
            [&] { return "batch " + std::to_string(n) + " of two searches in turns differs"; }) ||
        a.empty()) {
      return;
    }
    std::vector<double> scores;
    for (const TunerPoint& point : a) {
      scores.push_back(bowl(point));
    }
    one->tell(scores);
    other->tell(scores);
  }
}
}  // namespace

Cases tuner_cases(const Factory<Tuner>& make, const Options& options) {
  const TunerBench bench{make, options};
  const auto made = [&](const char* name, const char* thrown,
                        void (*body)(const TunerBench&, Report&)) {
    return make_case(name, thrown, [bench, body](Report& report) { body(bench, report); });
  };
  return {made("points_lie_in_the_space", kInside, inside),
          made("failures_and_odd_scores", kScores, failures),
          made("equal_searches", kEqual, equal_searches),
          made("searches_in_turns", kEqual, searches_in_turns)};
}
}  // namespace altiplan::conformance
