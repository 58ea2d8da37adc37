// SPDX-License-Identifier: Apache-2.0
#include "study/report/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "altiplan/random.hpp"
#include "host/base/machine_fault.hpp"
#include "host/view/scene.hpp"
#include "study/figures/text.hpp"
#include "study/report/packed.hpp"

namespace altiplan::study::report {
namespace {

constexpr unsigned kSeconds = 20;       // to build one scene
constexpr std::size_t kMaxRoutes = 12;  // in one scene; more would hide each other

/// Takes one of each list in turn, so that every kind has examples.
std::vector<std::size_t> in_turn(const std::vector<std::vector<std::size_t>>& lists) {
  std::vector<std::size_t> taken;
  bool any = true;
  for (std::size_t at = 0; any; ++at) {
    any = false;
    for (const auto& list : lists) {
      if (at < list.size()) {
        taken.push_back(list[at]);
        any = true;
      }
    }
  }
  return taken;
}

std::vector<std::size_t> failures(const StudyData& data) {
  using Kind = std::tuple<bool, std::size_t, std::string, std::string>;
  std::map<Kind, std::vector<std::size_t>> kinds;  // unexplained ones first
  for (std::size_t at = 0; at < data.rows.size(); ++at) {
    const RunRow& row = data.rows[at];
    if (!row.solved()) {
      kinds[{!unexplained(row.outcome), row.pipeline, row.outcome, row.message}].push_back(at);
    }
  }
  std::vector<std::vector<std::size_t>> lists;
  for (auto& [kind, rows] : kinds) {
    lists.push_back(std::move(rows));
  }
  return in_turn(lists);
}

std::vector<std::size_t> outliers(const Analysis& analysis) {
  std::vector<std::vector<std::size_t>> lists;
  for (const MetricAnalysis& metric : analysis.metrics) {
    for (const Sample& sample : metric.samples) {
      if (!sample.box) {
        continue;
      }
      std::vector<std::size_t> far = sample.box->outliers;
      std::stable_sort(far.begin(), far.end(), [&](std::size_t a, std::size_t b) {
        return std::abs(sample.values[a] - sample.box->median) >
               std::abs(sample.values[b] - sample.box->median);
      });
      lists.emplace_back();
      for (const std::size_t at : far) {
        lists.back().push_back(sample.rows[at]);
      }
    }
  }
  return in_turn(lists);
}

/// All rows in an order that follows the study's seed.
std::vector<std::size_t> shuffled(const StudyData& data) {
  std::vector<std::size_t> rows(data.rows.size());
  RandomStream stream = RandomStream(std::uint64_t(data.file.seed)).sub("report scenes");
  for (std::size_t at = 0; at < rows.size(); ++at) {
    const auto other = std::size_t(stream.integer(0, std::int64_t(at)));
    rows[at] = rows[other];
    rows[other] = at;
  }
  return rows;
}

host::StoredResult result_of(const StudyData& data, std::size_t row, const std::string& text,
                             const SceneOptions& options) {
  host::Overrides overrides;
  overrides.plugin_path = options.plugin_path;
  host::Json json = host::parse_json(text);
  if (!options.times) {
    drop_times(json);
  }
  json["trace"] = nullptr;
  return host::stored_result(run_name(data, data.rows[row]), std::move(json), overrides);
}

/// The scene of these rows of one pair, as text of JSON.
std::string scene_text(const StudyData& data, const std::vector<std::size_t>& rows,
                       const std::vector<host::StoredResult>& results) {
  host::Json scene = host::build_scene(results).json;
  for (std::size_t at = 0; at < rows.size(); ++at) {
    const RunRow& row = data.rows[rows[at]];
    scene["results"][at]["name"] = data.pipelines[row.pipeline].name;
    scene["results"][at]["file"] = run_name(data, row);
    scene["results"][at]["series"] = data.series_of(row.pipeline);
  }
  const RunRow& first = data.rows[rows.front()];
  scene["title"] = data.scenarios[first.scenario].name + " #" + std::to_string(first.repetition);
  thin_scene(scene);
  return host::json_text(scene);
}

/// A line of JSON with the changes since each row was made, followed by the packed scene of the
/// unchanged rows: a route must be shown in the world that it was planned in.
std::string pair_text(const StudyData& data, const std::vector<std::size_t>& rows,
                      const std::vector<std::string>& texts, const SceneOptions& options) {
  host::Json changed = host::Json::array();
  std::vector<std::size_t> drawn;
  std::vector<host::StoredResult> results;
  for (std::size_t at = 0; at < rows.size(); ++at) {
    host::StoredResult result = result_of(data, rows[at], texts[at], options);
    changed.push_back(what_changed(result));
    if (changed.back().empty()) {
      drawn.push_back(rows[at]);
      results.push_back(std::move(result));
    }
  }
  return changed.dump(-1, ' ', true, host::Json::error_handler_t::replace) + "\n" +
         (drawn.empty() ? "" : packed(scene_text(data, drawn, results)));
}

/// A fault of the machine may be transient, and the child may report it as another error: retries
/// once.
std::string made_at_last(const std::function<std::string()>& make) {
  try {
    return made_in_child(make, kSeconds);
  } catch (const SceneLate&) {
    throw;
  } catch (const Error&) {
    return made_in_child(make, kSeconds);
  }
}

class SceneMaker {
 public:
  SceneMaker(const StudyData& data, const ResultSource& results, const SceneOptions& options)
      : data_(data), results_(results), options_(options) {}

  void add(const std::vector<std::size_t>& chosen) {
    std::vector<std::size_t> rows;
    std::vector<std::string> texts;
    for (const std::size_t row : chosen) {
      std::string text = results_(data_.rows[row]);
      if (!text.empty() && texts.size() < kMaxRoutes) {
        texts.push_back(std::move(text));
        rows.push_back(row);
      } else if (!text.empty()) {
        why_not_[row] = "a scene shows at most " + std::to_string(kMaxRoutes) + " runs";
      }
    }
    if (texts.empty()) {
      ++empty_;
      return;
    }
    const auto make = [&] { return pair_text(data_, rows, texts, options_); };
    try {
      keep(chosen, rows, made_at_last(make));
    } catch (const host::MachineFault& fault) {
      throw host::MachineFault("the scene of " + run_name(data_, data_.rows[chosen.front()]) +
                               ": " + fault.what());
    } catch (const std::exception&
                 error) {  // including JSON errors: a plugin may corrupt its child's output
      leave_out(chosen, error.what());
    }
  }

  Scenes take(std::size_t pairs) {
    Scenes result;
    result.what = what(pairs);
    result.scenes = std::move(scenes_);
    result.notes.assign(notes_.begin(), notes_.end());
    for (const auto& [change, runs] : changed_) {
      result.changed.push_back(change + ": " + counted(runs, "run") + " made before " +
                               (runs == 1 ? "is" : "are") + " not shown in 3-D.");
    }
    result.why_not = std::move(why_not_);
    return result;
  }

 private:
  void leave_out(const std::vector<std::size_t>& chosen, const std::string& why) {
    notes_.insert(run_name(data_, data_.rows[chosen.front()]) + ": " + why);
    for (const std::size_t row : chosen) {
      why_not_.try_emplace(row, why);
    }
  }

  /// `text` as of pair_text.
  void keep(const std::vector<std::size_t>& chosen, const std::vector<std::size_t>& rows,
            const std::string& text) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    const auto changes =
        host::parse_json(text.substr(0, line)).get<std::vector<std::vector<std::string>>>();
    PackedScene scene;
    for (std::size_t at = 0; at < rows.size(); ++at) {
      for (const std::string& change : changes.at(at)) {
        ++changed_[change];
        std::string& why = why_not_[rows[at]];
        why += (why.empty() ? "" : "; ") + change;
      }
      if (changes[at].empty()) {
        scene.rows.push_back(rows[at]);
      }
    }
    scene.data = text.substr(std::min(line + 1, text.size()));
    if (scene.rows.empty()) {
      return;
    }
    if (scene.data.size() > options_.max_bytes_each) {
      leave_out(chosen, "its scene has " + grouped(scene.data.size()) + " bytes, the limit is " +
                            grouped(options_.max_bytes_each));
    } else if (bytes_ + scene.data.size() <= options_.max_bytes) {
      bytes_ += scene.data.size();
      scenes_.push_back(std::move(scene));
    } else {
      ++beyond_;
    }
  }

  std::string what(std::size_t pairs) const {
    std::size_t runs = 0;
    for (const PackedScene& scene : scenes_) {
      runs += scene.rows.size();
    }
    std::string text =
        counted(runs, "run") + " of " + grouped(scenes_.size()) + " of " + counted(pairs, "pair") +
        " (scenario, repetition) are available in 3-D: failures of every kind, outliers, and a "
        "random sample (seed of the study).";
    if (empty_ > 0) {
      text += " " + counted(empty_, "more pair") + " without a result of any pipeline.";
    }
    if (beyond_ > 0) {
      text += " " + counted(beyond_, "more scene") + " did not fit.";
    }
    return text;
  }

  const StudyData& data_;
  const ResultSource& results_;
  const SceneOptions& options_;
  std::vector<PackedScene> scenes_;
  std::set<std::string> notes_;
  std::map<std::string, std::size_t> changed_;  // runs of each
  std::map<std::size_t, std::string> why_not_;
  std::size_t bytes_ = 0;
  std::size_t beyond_ = 0;
  std::size_t empty_ = 0;
};
}  // namespace

std::vector<std::vector<std::size_t>> choose_scenes(const StudyData& data, const Analysis& analysis,
                                                    std::size_t most) {
  std::map<std::pair<std::size_t, int>, const Pair*> pair_of;
  const std::vector<Pair> pairs = pairs_of(data);
  for (const Pair& pair : pairs) {
    pair_of[{pair.scenario, pair.repetition}] = &pair;
  }
  std::set<const Pair*> taken;
  std::vector<std::vector<std::size_t>> chosen;
  const auto take = [&](const std::vector<std::size_t>& rows, std::size_t until) {
    for (const std::size_t at : rows) {
      const Pair* pair = pair_of.at({data.rows[at].scenario, data.rows[at].repetition});
      if (chosen.size() >= until) {
        return;
      }
      if (taken.insert(pair).second) {
        chosen.push_back({at});
        for (const std::size_t other : pair->rows) {
          if (other != kNoRow && other != at) {
            chosen.back().push_back(other);
          }
        }
      }
    }
  };
  take(failures(data), most * 2 / 5);
  take(outliers(analysis), most * 4 / 5);
  take(shuffled(data), most);
  return chosen;
}

Scenes build_scenes(const StudyData& data, const Analysis& analysis, const ResultSource& results,
                    const SceneOptions& options) {
  SceneMaker maker(data, results, options);
  const auto chosen = choose_scenes(data, analysis, options.most);
  for (std::size_t at = 0; at < chosen.size(); ++at) {
    options.begins("building scene " + std::to_string(at + 1) + " of " +
                   std::to_string(chosen.size()));
    maker.add(chosen[at]);
  }
  return maker.take(pairs_of(data).size());
}
}  // namespace altiplan::study::report
