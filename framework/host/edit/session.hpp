// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "host/edit/edits.hpp"
#include "host/edit/page_request.hpp"
#include "host/edit/plan_process.hpp"
#include "host/view/basemap.hpp"

namespace altiplan::host {

/// The state of `altiplan edit`: what has been changed in the files, planned anew at each change.
/// Thread-safe. What the page asks for and gets is in tools/viewer/README.md.
class EditSession {
 public:
  /// `line` leads to the process that plans. `given` were in force when the files were opened,
  /// `frame` is that of their world, `folder` is for files that last as long as the session, and
  /// `basemap` may be null.
  EditSession(std::vector<EditedPipeline> pipelines, std::vector<Assignment> given, Frame frame,
              std::filesystem::path folder, PlanLine& line, Basemap* basemap);

  PageAnswer answer(const PageRequest& request);

 private:
  /// A file as it was when it was opened, or last written here.
  struct OpenFile {
    std::filesystem::path path;
    std::string opened;
  };

  Json change(const Json& wish);
  /// Adds a copy of the first pipeline, to be changed and compared.
  Json compared();
  Json planned(const Json& wish);
  /// Whether the flight is a part of quick answers: unless they have taken long in this gesture.
  bool is_flown(std::uint64_t gesture);
  Json saved(const Json& wish);
  /// Once the changes are in the files.
  void begin_anew();
  /// Files to be written.
  using Texts = std::vector<std::pair<std::filesystem::path, std::string>>;
  /// A file with the changes that concern it, and a pipeline's.
  std::string text_of(std::size_t file, std::size_t pipeline) const;
  Texts changed_texts() const;
  /// New files beside the opened ones; the pipelines' are of the new scenario.
  Texts new_texts(const std::string& suffix) const;
  PageAnswer page();
  PageAnswer exported(const Json& wish);
  Json uploaded(const Json& wish);
  /// Runs this program with the result of the wish's pipeline as a file; returns what it says on
  /// stderr.
  Json run_command(const Json& wish, const std::vector<std::string>& before,
                   const std::vector<std::string>& after);

  std::vector<Assignment> assignments_of(const Json& wish) const;
  std::size_t pipeline_of(const Json& wish) const;
  /// What the page needs to know of the state.
  Json state() const;
  std::vector<std::vector<std::string>> sets() const;
  PlanTask task_of(PlanTask::Kind kind) const;
  /// Equal for states with the same obstacles.
  std::string world() const;

  PlanLine& line_;
  Basemap* const basemap_;
  const Frame frame_;
  const std::filesystem::path folder_;
  const std::size_t opened_;  ///< the number of pipelines with a file of their own
  std::mutex commands_;       ///< held while one runs: it has files in the folder
  mutable std::mutex mutex_;  ///< guards what follows
  std::vector<Value> trees_;  ///< of the files, as opened
  std::vector<EditedPipeline> pipelines_;
  std::vector<OpenFile> files_;  ///< of the opened pipelines, then the scenario's
  Edits edits_;
  std::uint64_t state_number_ = 0;
  std::uint64_t gesture_ = 0;
  bool is_slow_ = false;                 ///< what that gesture has asked for
  std::map<std::size_t, Json> results_;  ///< of each pipeline, as last planned whole
};
}  // namespace altiplan::host
