// SPDX-License-Identifier: Apache-2.0
#include "host/edit/session.hpp"

#include <algorithm>
#include <chrono>

#include "altiplan/formats/input_file.hpp"
#include "host/config/overrides.hpp"
#include "host/config/yaml.hpp"
#include "host/config/yaml_edit.hpp"
#include "host/edit/movable.hpp"
#include "host/import_export/route_format.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxKey = 200;

/// What a change may say.
constexpr std::string_view kWishes[] = {"move",    "set",   "pipeline", "history",
                                        "gesture", "quick", "world"};

/// Slower answers are no longer seen as following the hand.
constexpr std::chrono::milliseconds kFluent{60};

/// A process each, and a line on the picture.
constexpr std::size_t kMostPipelines = 4;

Json json_of(const Value& value) {
  Json json;
  switch (value.kind) {
    case Value::Kind::scalar:
      return value.text;
    case Value::Kind::list:
      json = Json::array();
      for (const Value& item : value.items) {
        json.push_back(json_of(item));
      }
      return json;
    default:
      json = Json::object();
      for (const Value::Entry& entry : value.entries) {
        json[entry.key] = json_of(entry.value);
      }
      return json;
  }
}

Value applied(Value tree, const std::vector<std::string>& set, FileOfKey file) {
  apply_overrides(tree, set, file);
  return tree;
}

}  // namespace

EditSession::EditSession(std::vector<EditedPipeline> pipelines, std::vector<Assignment> given,
                         Frame frame, std::filesystem::path folder, PlanLine& line,
                         Basemap* basemap)
    : line_(line),
      basemap_(basemap),
      frame_(std::move(frame)),
      folder_(std::move(folder)),
      opened_(pipelines.size()),
      pipelines_(std::move(pipelines)),
      edits_(std::move(given)) {
  for (const EditedPipeline& pipeline : pipelines_) {
    files_.push_back({pipeline.config.pipeline_path, ""});
  }
  files_.push_back({pipelines_.front().config.scenario_path, ""});
  for (OpenFile& file : files_) {
    file.opened = formats::read_file(file.path);
    trees_.push_back(parse_yaml(file.opened, file.path.string()));
  }
}

PageAnswer EditSession::answer(const PageRequest& request) {
  const auto plugins = [&] {
    const PlanTask task{PlanTask::Kind::plugins};
    return PageAnswer{200, "application/json", line_.finish(line_.begin(task)).value_or("[]")};
  };
  return answered(
      request, {{"GET /", [&](const Json&) { return page(); }},
                {"GET /plugins", [&](const Json&) { return plugins(); }},
                {"POST /edit", [&](const Json& wish) { return json_answer(change(wish)); }},
                {"POST /compare", [&](const Json&) { return json_answer(compared()); }},
                {"POST /save", [&](const Json& wish) { return json_answer(saved(wish)); }},
                {"POST /export", [&](const Json& wish) { return exported(wish); }},
                {"POST /upload", [&](const Json& wish) { return json_answer(uploaded(wish)); }}});
}

PageAnswer EditSession::page() {
  PlanTask task;
  Json state_now;
  {
    const std::lock_guard lock(mutex_);
    task = task_of(PlanTask::Kind::page);
    state_now = state();
  }
  Json scene = parse_json(line_.finish(line_.begin(task)).value_or(error_answer("superseded")));
  if (scene.contains("error")) {
    throw Error(scene.at("error").get<std::string>());
  }
  for (std::size_t n = 0; n < task.files.size(); ++n) {
    scene["results"][n]["name"] = state_now.at("pipelines")[n].at("name");
  }
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t n = 0; n < task.files.size() && state_now.at("number") == state_number_; ++n) {
      results_[n] = std::move(scene["result"][n]);
    }
  }
  scene.erase("result");
  scene["edit"] = std::move(state_now);
  for (const RouteFormat& format : route_formats()) {
    scene["edit_formats"].push_back({format.name, format.extension});
  }
  if (basemap_ != nullptr) {
    basemap_->add_to(scene, frame_);
  }
  return edited_page(scene);
}

std::size_t EditSession::pipeline_of(const Json& wish) const {
  const auto pipeline = wish.value("pipeline", std::size_t(0));
  if (pipeline >= pipelines_.size()) {
    throw Error("there is no pipeline " + std::to_string(pipeline));
  }
  return pipeline;
}

std::vector<Assignment> EditSession::assignments_of(const Json& wish) const {
  const std::size_t pipeline = pipeline_of(wish);
  std::vector<Assignment> assignments;
  const auto add = [&](const std::string& text) {
    if (parse_set(text).path.size() > kMaxKey || text.find('\n') != text.npos) {
      throw Error("'" + text.substr(0, kMaxKey) + "': expected KEY=VALUE or ~KEY on one line");
    }
    assignments.push_back({text, pipeline});
  };
  if (wish.contains("move")) {
    const std::vector<Assignment> before = edits_.before(wish.value("gesture", std::uint64_t(0)));
    const Value scenario = applied(trees_.back(), texts_for(before, 0), FileOfKey::scenario);
    const Json& move = wish.at("move");
    for (const std::string& text :
         moved(scenario, move.at("key").get<std::string>(), moved_by(move.at("by")), frame_)) {
      add(text);
    }
  }
  const Json texts = wish.value("set", Json::array());
  if (!texts.is_array()) {
    throw Error("the request is not as expected: set must be a list of texts");
  }
  for (const Json& text : texts) {
    add(text.get<std::string>());
  }
  return assignments;
}

Json EditSession::change(const Json& wish) {
  for (const auto& [key, value] : wish.items()) {
    if (std::find(std::begin(kWishes), std::end(kWishes), key) == std::end(kWishes)) {
      throw Error("the request is not as expected: unknown key '" + key + "'");
    }
  }
  const std::string undo = wish.value("history", "");
  if (!undo.empty() && undo != "undo" && undo != "redo") {
    throw Error("history: expected undo or redo, found '" + undo + "'");
  }
  Edits before;
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    before = edits_;
    if (undo == "undo") {
      edits_.undo();
    } else if (undo == "redo") {
      edits_.redo();
    } else if (const auto assignments = assignments_of(wish); !assignments.empty()) {
      edits_.add(assignments, wish.value("gesture", std::uint64_t(0)));
    }
    number = ++state_number_;
  }
  try {
    return planned(wish);
  } catch (const std::exception&) {
    // What cannot be planned with is not kept, unless it has been changed further meanwhile.
    const std::lock_guard lock(mutex_);
    if (state_number_ == number) {
      edits_ = before;
    }
    throw;
  }
}

bool EditSession::is_flown(std::uint64_t gesture) {
  if (gesture != gesture_) {
    gesture_ = gesture;
    is_slow_ = false;
  }
  return !is_slow_;
}

Json EditSession::planned(const Json& wish) {
  const bool quick = wish.value("quick", false);
  const auto began = std::chrono::steady_clock::now();
  Json json;
  std::vector<std::uint64_t> numbers;
  {
    // One state is asked for in all processes before the next one is.
    const std::lock_guard lock(mutex_);
    json = state();
    PlanTask task = task_of(PlanTask::Kind::plan);
    task.quick = quick;
    const bool is_other_world = world() != wish.value("world", "");
    task.flies = !quick || is_flown(wish.value("gesture", std::uint64_t(0)));
    for (task.pipeline = 0; task.pipeline < pipelines_.size(); ++task.pipeline) {
      task.obstacles = is_other_world && task.pipeline == 0;  // which are the same for all
      numbers.push_back(line_.begin(task));
    }
  }
  json["quick"] = quick;
  json["answers"] = Json::array();
  std::string problem;
  bool is_superseded = false;
  for (const std::uint64_t number : numbers) {
    const std::optional<std::string> text = line_.finish(number);
    is_superseded = is_superseded || !text;
    Json answer = parse_json(text.value_or("{}"));
    problem = answer.value("error", problem);
    json["answers"].push_back(std::move(answer));
  }
  if (is_superseded) {
    return {{"superseded", true}};
  }
  if (!problem.empty()) {
    throw Error(problem);
  }
  const std::lock_guard lock(mutex_);
  is_slow_ = is_slow_ || (quick && std::chrono::steady_clock::now() - began > kFluent);
  const bool is_newest = json.at("number") == state_number_;
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    Json& answer = json["answers"][n];
    if (!quick && is_newest) {
      results_[n] = std::move(answer["result"]);
    }
    answer.erase("result");  // the page has no use for it
    answer["results"][0]["name"] = json["pipelines"][n]["name"];
  }
  return json;
}

std::vector<std::vector<std::string>> EditSession::sets() const {
  const std::vector<Assignment> all = edits_.all();
  std::vector<std::vector<std::string>> sets;
  for (std::size_t n = 0; n < pipelines_.size(); ++n) {
    sets.push_back(texts_for(all, n));
  }
  return sets;
}

PlanTask EditSession::task_of(PlanTask::Kind kind) const {
  PlanTask task;
  task.kind = kind;
  task.set = sets();
  for (const EditedPipeline& pipeline : pipelines_) {
    task.files.push_back(pipeline.file);
  }
  return task;
}

Json EditSession::compared() {
  const std::lock_guard lock(mutex_);
  if (pipelines_.size() == kMostPipelines) {
    throw Error("at most " + std::to_string(kMostPipelines) +
                " pipelines are planned side by side");
  }
  EditedPipeline copy = pipelines_.front();
  const std::size_t number = pipelines_.size();
  copy.name += "_" + std::to_string(number + 1);
  pipelines_.push_back(std::move(copy));
  std::vector<Assignment> same;
  for (const Assignment& one : edits_.all()) {
    if (one.pipeline == 0 && one.parts().file == FileOfKey::pipeline) {
      same.push_back({one.text, number});
    }
  }
  if (!same.empty()) {
    edits_.add(same, 0);
  }
  return {{"pipelines", pipelines_.size()}};
}

std::string EditSession::world() const {
  std::string text;
  for (const Assignment& one : edits_.all()) {
    const SetText set = one.parts();
    const std::string first = set.path.substr(0, set.path.find('.'));
    const bool is_end = first == "start" || first == "goal" || first == "via";
    // Layers may be drawn from the run's seed.
    if (set.file == FileOfKey::scenario ? !is_end : first == "seed") {
      text += one.text + "\n";
    }
  }
  return std::to_string(std::hash<std::string>()(text));
}

Json EditSession::state() const {
  const std::vector<Assignment> all = edits_.all();
  Json json{{"number", state_number_},
            {"undo", edits_.can_undo()},
            {"redo", edits_.can_redo()},
            {"world", world()},
            {"scenario", json_of(applied(trees_.back(), texts_for(all, 0), FileOfKey::scenario))},
            {"pipelines", Json::array()}};
  for (std::size_t n = 0; n < pipelines_.size(); ++n) {
    const std::vector<std::string> set = texts_for(all, n);
    json["pipelines"].push_back(
        {{"name", pipelines_[n].name},
         {"file", files_[pipelines_[n].file].path.string()},
         {"tree", json_of(applied(trees_[pipelines_[n].file], set, FileOfKey::pipeline))},
         {"set", set}});
  }
  return json;
}
}  // namespace altiplan::host
