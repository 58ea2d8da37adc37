// SPDX-License-Identifier: Apache-2.0
#include "edit_mission.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "altiplan/formats/input_file.hpp"
#include "host/base/output_file.hpp"
#include "host/gate/changed_plan.hpp"
#include "host/import_export/route_format.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;
using host::Json;

/// True of an item with a position of its own that is one of the file's, not of a complex item,
/// which its ground station makes anew.
bool is_movable(const formats::MissionFile& mission, const std::string& place) {
  const auto command = std::find_if(
      mission.commands.begin(), mission.commands.end(),
      [&](const formats::MissionCommand& one) { return one.place == place && one.has_position(); });
  return command != mission.commands.end() && std::count(place.begin(), place.end(), '.') <= 2;
}

std::vector<PlacedItem> items_of(const JudgedPlan& judged, const Frame& page) {
  std::vector<PlacedItem> items = judged.items(page);
  std::erase_if(items,
                [&](const PlacedItem& item) { return !is_movable(judged.mission, item.place); });
  return items;
}

Json movable(const std::vector<PlacedItem>& items) {
  Json all = Json::array();
  for (const PlacedItem& item : items) {
    all.push_back({{"key", item.place},
                   {"kind", "item"},
                   {"plugin", ""},
                   {"name", item.name},
                   {"number", item.number},
                   {"at", host::to_json(Polyline{item.at})[0]}});
  }
  return all;
}
}  // namespace

MissionEditor::MissionEditor(PlanCheck check, host::Overrides overrides, host::Basemap* basemap)
    : check_(std::move(check)),
      overrides_(std::move(overrides)),
      basemap_(basemap),
      saved_(formats::read_file(check_.plan)),
      opened_(judged_plan(check_, overrides_, saved_)),
      judged_(opened_) {
  static_cast<void>(host::changed_plan(saved_, judged_.mission.format, {}));  // refuses others
  states_.push_back({saved_, 0, items_of(opened_, opened_.world.truth.frame())});
  if (basemap_ != nullptr) {
    static_cast<void>(scene());  // refuses images of elsewhere
  }
}

host::PageAnswer MissionEditor::answer(const host::PageRequest& request) {
  const std::lock_guard lock(mutex_);
  return host::answered(
      request, {{"GET /", [&](const Json&) { return host::edited_page(scene()); }},
                {"GET /plugins", [](const Json&) { return host::json_answer(Json::array()); }},
                {"POST /edit", [&](const Json& wish) { return host::json_answer(change(wish)); }},
                {"POST /save", [&](const Json& wish) { return host::json_answer(saved(wish)); }}});
}

Json MissionEditor::scene() {
  Json scene = host::line_scene(judged_.line(opened_.world.truth.frame()), opened_.world).json;
  scene["title"] = fs::path(check_.plan).filename();  // the verdict changes
  scene["movable"] = movable(now().items);
  scene["edit"] = state();
  scene["edit_formats"] = Json::array();
  if (basemap_ != nullptr) {
    basemap_->add_to(scene, opened_.world.truth.frame());
  }
  return scene;
}

JudgedPlan MissionEditor::judged(const std::string& text, bool quick) const {
  if (!quick) {
    return judged_plan(check_, overrides_, text);
  }
  JudgedPlan same{host::read_mission_file(check_.plan, text), opened_.world, {}, opened_.gate};
  same.report = host::judge_plan(check_.plan, same.mission, same.world, same.gate);
  return same;
}

bool MissionEditor::goes_on(std::uint64_t gesture) const {
  return gesture != 0 && now_ > 0 && now().gesture == gesture;
}

std::string MissionEditor::moved(const std::string& place, const Vec3& by,
                                 std::uint64_t gesture) const {
  const State& before = states_[goes_on(gesture) ? now_ - 1 : now_];
  const auto item = std::find_if(before.items.begin(), before.items.end(),
                                 [&](const PlacedItem& one) { return one.place == place; });
  if (item == before.items.end()) {
    throw Error("there is no item '" + place + "' to move");
  }
  host::PlanChanges changes;
  host::ChangedItem& change = changes.items.emplace_back();
  change.place = place;
  change.raised_by_m = by.z();
  if (by.x() != 0 || by.y() != 0) {
    const auto [lon, lat] =
        opened_.world.truth.frame().to_lonlat(item->at.x() + by.x(), item->at.y() + by.y());
    change.lonlat = {lon, lat};
  }
  return host::changed_plan(before.text, judged_.mission.format, changes);
}

Json MissionEditor::change(const Json& wish) {
  const std::string history = wish.value("history", "");
  const auto gesture = wish.value("gesture", std::uint64_t(0));
  const bool quick = wish.value("quick", false);
  std::size_t at = now_;
  std::optional<State> made;
  if (history == "undo") {
    at -= at > 0 ? 1 : 0;
  } else if (history == "redo") {
    at += at + 1 < states_.size() ? 1 : 0;
  } else if (!history.empty()) {
    throw Error("history: expected undo or redo, found '" + history + "'");
  } else if (wish.contains("move")) {
    const Json& move = wish.at("move");
    made = State{moved(move.at("key"), host::moved_by(move.at("by")), gesture), gesture, {}};
    at += goes_on(gesture) ? 0 : 1;
  }
  // What cannot be judged is not kept.
  JudgedPlan judged_now = judged(made ? made->text : states_[at].text, quick);
  const Frame& frame = opened_.world.truth.frame();
  if (made) {
    made->items = items_of(judged_now, frame);
    states_.resize(at);
    states_.push_back(*std::move(made));
  }
  judged_ = std::move(judged_now);
  now_ = at;
  ++number_;
  Json answer = host::line_parts(judged_.line(frame), opened_.world);
  answer["movable"] = movable(now().items);
  Json json = state();
  json["quick"] = quick;
  json["answers"] = Json::array({std::move(answer)});
  return json;
}

Json MissionEditor::saved(const Json& wish) {
  const fs::path file = check_.plan;
  const bool is_new = wish.contains("as");
  const fs::path place =
      is_new ? file.parent_path() / (file.stem().string() + "_" + host::file_word(wish.at("as")) +
                                     file.extension().string())
             : file;
  if (!is_new && now().text == saved_) {
    return {{"files", Json::array()}};
  }
  if (const std::string problem = host::output_problem(place); !problem.empty()) {
    throw Error(problem);
  }
  if (is_new && fs::exists(place)) {
    throw Error("'" + place.string() + "' is there already: save under another name");
  }
  if (!is_new && formats::read_file(file) != saved_) {
    throw Error("'" + file.string() +
                "' has been changed by another program: save under another name, or open it anew");
  }
  host::write_file(place, now().text);
  if (!is_new) {
    saved_ = now().text;
  }
  return {{"files", {place.string()}}};
}

Json MissionEditor::state() const {
  return {{"number", number_},
          {"undo", now_ > 0},
          {"redo", now_ + 1 < states_.size()},
          {"world", ""},
          {"scenario", Json::object()},
          {"pipelines", Json::array()},
          {"mission", check_.plan},
          {"verdict", judged_.verdict()},
          {"findings", judged_.findings()}};
}
}  // namespace altiplan::cli
