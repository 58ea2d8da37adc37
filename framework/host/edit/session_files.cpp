// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/formats/input_file.hpp"
#include "host/base/output_file.hpp"
#include "host/base/program.hpp"
#include "host/config/yaml.hpp"
#include "host/config/yaml_edit.hpp"
#include "host/edit/session.hpp"

// What leaves the session: saved files, exports and uploads.

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

/// The seconds that a command may take: an upload waits for its autopilot.
constexpr std::chrono::seconds kCommandTime{60};

/// The file's name with a suffix, beside it.
fs::path named(const fs::path& file, const std::string& suffix) {
  return file.parent_path() / (file.stem().string() + suffix + ".yaml");
}

std::string last_line_of(const fs::path& file) {
  std::string text = formats::read_file(file);
  while (text.ends_with('\n')) {
    text.pop_back();
  }
  return text;
}
}  // namespace

Json EditSession::saved(const Json& wish) {
  const std::lock_guard lock(mutex_);
  const bool is_new = wish.contains("as");
  const std::string suffix = is_new ? "_" + file_word(wish.at("as")) : "";
  const Texts written = is_new ? new_texts(suffix) : changed_texts();
  for (const auto& [place, text] : written) {
    if (const std::string problem = output_problem(place); !problem.empty()) {
      throw Error(problem);
    }
    if (is_new && fs::exists(place)) {
      throw Error("'" + place.string() + "' is there already: save under another name");
    }
  }
  Json names = Json::array();
  for (const auto& [place, text] : written) {
    write_file(place, text);
    names.push_back(place.string());
  }
  if (!is_new && !written.empty()) {
    begin_anew();
  }
  return {{"files", names}};
}

void EditSession::begin_anew() {
  // What is planned is what the files say now, and the changes that no file has.
  std::vector<Assignment> left;
  for (const Assignment& one : edits_.all()) {
    if (one.pipeline >= opened_ && one.parts().file == FileOfKey::pipeline) {
      left.push_back(one);
    }
  }
  for (std::size_t n = 0; n <= opened_; ++n) {
    files_[n].opened = formats::read_file(files_[n].path);
    trees_[n] = parse_yaml(files_[n].opened, files_[n].path.string());
  }
  edits_ = Edits(std::move(left));
  results_.clear();
  ++state_number_;
}

std::string EditSession::text_of(std::size_t file, std::size_t pipeline) const {
  return with_assignments(files_[file].opened, files_[file].path.string(),
                          texts_for(edits_.all(), pipeline),
                          file == opened_ ? FileOfKey::scenario : FileOfKey::pipeline);
}

EditSession::Texts EditSession::changed_texts() const {
  Texts written;
  for (std::size_t n = 0; n <= opened_; ++n) {
    const OpenFile& file = files_[n];
    std::string text = text_of(n, n == opened_ ? 0 : n);
    if (text == file.opened) {
      continue;
    }
    if (formats::read_file(file.path) != file.opened) {
      throw Error(
          "'" + file.path.string() +
          "' has been changed by another program: save under another name, or open it anew");
    }
    written.emplace_back(file.path, std::move(text));
  }
  return written;
}

EditSession::Texts EditSession::new_texts(const std::string& suffix) const {
  const fs::path scenario = named(files_[opened_].path, suffix);
  Texts written{{scenario, text_of(opened_, 0)}};
  for (std::size_t n = 0; n < pipelines_.size(); ++n) {
    const std::size_t file = pipelines_[n].file;
    const std::string number = n < opened_ ? "" : "_" + std::to_string(n + 1);
    const fs::path place = named(files_[file].path, suffix + number);
    const std::string to = scenario.lexically_relative(place.parent_path()).string();
    written.emplace_back(place, with_assignments(text_of(file, n), place.string(),
                                                 {"scenario=" + to}, FileOfKey::pipeline));
  }
  return written;
}

Json EditSession::run_command(const Json& wish, const std::vector<std::string>& before,
                              const std::vector<std::string>& after) {
  fs::path result;
  {
    const std::lock_guard lock(mutex_);
    const std::size_t pipeline = pipeline_of(wish);
    result = folder_ / (pipelines_[pipeline].name + ".json");
    const auto found = results_.find(pipeline);
    if (found == results_.end()) {
      throw Error("nothing has been planned yet");
    }
    write_file(result, file_text(found->second));
  }
  std::vector<std::string> arguments{fs::read_symlink("/proc/self/exe").string()};
  arguments.insert(arguments.end(), before.begin(), before.end());
  arguments.push_back(result.string());
  arguments.insert(arguments.end(), after.begin(), after.end());
  const fs::path errors = folder_ / "errors.txt";
  const Program program(arguments, {{}, errors, folder_});
  const auto code = program.ended(Program::Clock::now() + kCommandTime);
  if (code != 0) {
    const std::string why = last_line_of(errors);
    throw Error(why.empty() ? "the command did not end in time" : why);
  }
  return {{"said", last_line_of(errors)}};
}

PageAnswer EditSession::exported(const Json& wish) {
  const std::string format = wish.at("to");
  const std::lock_guard one_at_a_time(commands_);
  const fs::path file = folder_ / "exported";
  run_command(wish, {"export"}, {"--to", format, "--out", file.string()});
  return {200, "application/octet-stream", formats::read_file(file)};
}

Json EditSession::uploaded(const Json& wish) {
  const std::lock_guard one_at_a_time(commands_);
  return run_command(wish, {"upload"}, {"--link", wish.at("address")});
}
}  // namespace altiplan::host
