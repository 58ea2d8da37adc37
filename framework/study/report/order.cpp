// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "altiplan/error.hpp"
#include "study/figures/text.hpp"
#include "study/plan/study_grid.hpp"
#include "study/report/analysis.hpp"

namespace altiplan::study::report {
namespace {

/// The sorted variants, and the new index for each old one.
template <class Less>
std::vector<std::size_t> sort_variants(std::vector<StoredVariant>& variants, const Less& less) {
  std::vector<std::size_t> order(variants.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return less(variants[a], variants[b]); });
  std::vector<StoredVariant> sorted;
  std::vector<std::size_t> place(variants.size());
  for (const std::size_t old : order) {
    place[old] = sorted.size();
    sorted.push_back(std::move(variants[old]));
  }
  variants = std::move(sorted);
  return place;
}

/// Index of the entry of a pipeline variant.
std::size_t entry_of(const StudyFile& file, const StoredVariant& variant) {
  const auto found = std::find_if(file.pipelines.begin(), file.pipelines.end(),
                                  [&](const auto& entry) { return entry.id == variant.of; });
  return std::size_t(found - file.pipelines.begin());
}

/// The index of each pipeline variant in the study's file; an entry's grid varies its last key
/// fastest, as its runs do.
std::map<std::string, std::size_t> places_in(const StudyFile& file) {
  std::map<std::string, std::size_t> places;
  for (const PipelineChoice& entry : file.pipelines) {
    try {
      for (const GridCell& cell : grid_of(entry.set, "set")) {
        places.try_emplace(entry.id + cell.label, places.size());
      }
    } catch (const ConfigError&) {
      // A study that could not be planned: pipelines are ordered by name.
    }
  }
  return places;
}

void drop_varying_columns(StudyData& data) {
  std::vector<std::size_t> kept;
  for (std::size_t at = 0; at < data.columns.size(); ++at) {
    if (!is_measured(data.columns[at])) {
      kept.push_back(at);
    }
  }
  std::vector<std::string> columns;
  for (const std::size_t at : kept) {
    columns.push_back(data.columns[at]);
  }
  for (RunRow& row : data.rows) {
    std::vector<double> values;
    for (const std::size_t at : kept) {
      values.push_back(row.values[at]);
    }
    row.values = std::move(values);
  }
  data.columns = std::move(columns);
}
}  // namespace

StudyData in_order(StudyData data, bool times) {
  const std::map<std::string, std::size_t> places = places_in(data.file);
  const auto place_of = [&](const StoredVariant& variant) {
    const auto found = places.find(variant.name);
    return std::pair(entry_of(data.file, variant), found == places.end() ? kNoRow : found->second);
  };
  const auto by_entry = [&](const StoredVariant& a, const StoredVariant& b) {
    const auto left = place_of(a);
    const auto right = place_of(b);
    return left != right ? left < right : natural_less(a.name, b.name);
  };
  const auto by_name = [](const StoredVariant& a, const StoredVariant& b) {
    return natural_less(a.name, b.name);
  };
  const std::vector<std::size_t> pipeline = sort_variants(data.pipelines, by_entry);
  const std::vector<std::size_t> scenario = sort_variants(data.scenarios, by_name);
  std::size_t beyond = places.size();  // pipelines that the study does not plan
  for (const StoredVariant& variant : data.pipelines) {
    const auto found = places.find(variant.name);
    data.series.push_back(found == places.end() ? beyond++ : found->second);
  }
  for (RunRow& row : data.rows) {
    row.pipeline = pipeline[row.pipeline];
    row.scenario = scenario[row.scenario];
  }
  std::stable_sort(data.rows.begin(), data.rows.end(), [](const RunRow& a, const RunRow& b) {
    return std::tie(a.scenario, a.pipeline, a.repetition) <
           std::tie(b.scenario, b.pipeline, b.repetition);
  });
  if (!times) {
    drop_varying_columns(data);
  }
  return data;
}

namespace {

/// Keeps the marked variants; returns the new index for each old one.
std::vector<std::size_t> keep(std::vector<StoredVariant>& variants, const std::vector<bool>& kept) {
  std::vector<std::size_t> place(variants.size(), kNoRow);
  std::vector<StoredVariant> left;
  for (std::size_t old = 0; old < variants.size(); ++old) {
    if (kept[old]) {
      place[old] = left.size();
      left.push_back(std::move(variants[old]));
    }
  }
  variants = std::move(left);
  return place;
}
}  // namespace

Absent take_absent(StudyData& data) {
  Absent absent;
  if (data.rows.empty()) {
    return absent;
  }
  std::vector<bool> pipelines(data.pipelines.size(), false);
  std::vector<bool> scenarios(data.scenarios.size(), false);
  for (const RunRow& row : data.rows) {
    pipelines[row.pipeline] = true;
    scenarios[row.scenario] = true;
  }
  std::vector<std::size_t> series;
  for (std::size_t p = 0; p < pipelines.size(); ++p) {
    if (pipelines[p]) {
      series.push_back(data.series_of(p));
    } else {
      absent.pipelines.push_back(data.pipelines[p].name);
    }
  }
  absent.scenarios = std::size_t(std::count(scenarios.begin(), scenarios.end(), false));
  const std::vector<std::size_t> pipeline = keep(data.pipelines, pipelines);
  const std::vector<std::size_t> scenario = keep(data.scenarios, scenarios);
  data.series = std::move(series);
  for (RunRow& row : data.rows) {
    row.pipeline = pipeline[row.pipeline];
    row.scenario = scenario[row.scenario];
  }
  return absent;
}

const std::vector<std::string>& outcome_order() {
  static const std::vector<std::string> kOrder{
      "solved",        "no_route",   "timed_out", "invalid_problem", "rejected",
      "not_reached",   "collided",   "cancelled", "failed",          "crashed",
      "out_of_memory", "bad_output", "refused"};
  return kOrder;
}

bool unexplained(std::string_view outcome) {
  for (const char* known : {"solved", "no_route", "timed_out", "cancelled", "invalid_problem",
                            "rejected", "collided", "not_reached"}) {
    if (outcome == known) {
      return false;
    }
  }
  return true;
}

std::string outcome_text(std::string_view outcome) {
  std::string text = printable(outcome);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string run_name(const StudyData& data, const RunRow& row) {
  return study::run_name(data.pipelines[row.pipeline].name, data.scenarios[row.scenario].name,
                         row.repetition);
}

std::vector<Pair> pairs_of(const StudyData& data) {
  std::vector<Pair> pairs;
  std::vector<std::size_t> order(data.rows.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::size_t at) {
    return std::pair(data.rows[at].scenario, data.rows[at].repetition);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (const std::size_t at : order) {
    if (pairs.empty() || std::pair(pairs.back().scenario, pairs.back().repetition) != key(at)) {
      pairs.push_back(
          {key(at).first, key(at).second, std::vector<std::size_t>(data.pipelines.size(), kNoRow)});
    }
    pairs.back().rows[data.rows[at].pipeline] = at;
  }
  return pairs;
}

std::vector<Pair> distinct_pairs(const StudyData& data, const std::string& metric) {
  const std::vector<bool> repeat = repeat_themselves(data);
  std::vector<Pair> all = pairs_of(data);
  if (is_measured(metric) || std::find(repeat.begin(), repeat.end(), false) != repeat.end()) {
    return all;
  }
  const auto lacks_run = [](const Pair& pair) {
    return std::find(pair.rows.begin(), pair.rows.end(), kNoRow) != pair.rows.end();
  };
  std::vector<Pair> pairs;
  for (Pair& pair : all) {
    if (pairs.empty() || pairs.back().scenario != pair.scenario) {
      pairs.push_back(std::move(pair));
    } else if (lacks_run(pairs.back())) {
      pairs.back() = std::move(pair);
    }
  }
  return pairs;
}

Repeating repeating(const StudyData& data) {
  const std::vector<bool> repeat = repeat_themselves(data);
  const bool any =
      std::adjacent_find(data.rows.begin(), data.rows.end(), [&](const RunRow& a, const RunRow& b) {
        return repeat[a.pipeline] && a.pipeline == b.pipeline && a.scenario == b.scenario;
      }) != data.rows.end();
  const auto count = std::count(repeat.begin(), repeat.end(), true);
  return !any                                     ? Repeating::none
         : count == std::ptrdiff_t(repeat.size()) ? Repeating::all
         : count > 1                              ? Repeating::some
                                                  : Repeating::one;
}

std::string counted_once(Repeating repeating, Counted counted) {
  if (repeating == Repeating::all) {
    return " (equal repetitions count once)";
  }
  if (counted == Counted::values && repeating != Repeating::none) {
    return " (the repetitions of a pipeline count once if they are equal)";
  }
  if (counted == Counted::pairs && repeating == Repeating::some) {
    return " (the repetitions of two pipelines count once if those of both are equal)";
  }
  return "";
}
}  // namespace altiplan::study::report
