// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "check_plan.hpp"
#include "host/edit/page_request.hpp"
#include "host/view/basemap.hpp"

namespace altiplan::cli {

/// The state of `altiplan edit` of a mission: its text with items moved, judged anew at each move
/// as `altiplan check` does. Thread-safe. What the page asks for and gets is in
/// tools/viewer/README.md.
class MissionEditor {
 public:
  /// Judges the mission as it is; throws as judged_plan, and Error for a format whose items cannot
  /// be changed. `basemap` may be null.
  MissionEditor(PlanCheck check, host::Overrides overrides, host::Basemap* basemap);

  host::PageAnswer answer(const host::PageRequest& request);

 private:
  /// The mission after a move.
  struct State {
    std::string text;
    std::uint64_t gesture = 0;      ///< the drag that it belongs to; 0: none
    std::vector<PlacedItem> items;  ///< that can be dragged
  };

  /// What the page has at first.
  host::Json scene();
  host::Json change(const host::Json& wish);
  host::Json saved(const host::Json& wish);
  /// Judges the text; quickly in the world that is there, which the files may no longer describe.
  JudgedPlan judged(const std::string& text, bool quick) const;
  /// The mission with one item moved by so much from where it was before that drag. Throws Error
  /// for an item that there is not.
  std::string moved(const std::string& place, const Vec3& by, std::uint64_t gesture) const;
  /// True if a change of that gesture replaces the last one.
  bool goes_on(std::uint64_t gesture) const;
  const State& now() const { return states_[now_]; }
  /// What the page needs to know of the state.
  host::Json state() const;

  const PlanCheck check_;
  const host::Overrides overrides_;
  host::Basemap* const basemap_;
  std::mutex mutex_;           ///< guards what follows
  std::vector<State> states_;  ///< the first is the file's, the ones after now_ are undone
  std::size_t now_ = 0;
  std::string saved_;        ///< the file's text as opened, or as last written here
  const JudgedPlan opened_;  ///< its world is the page's
  JudgedPlan judged_;        ///< of the state that is shown
  std::uint64_t number_ = 0;
};
}  // namespace altiplan::cli
