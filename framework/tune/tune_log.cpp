// SPDX-License-Identifier: Apache-2.0
#include "tune/tune_log.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/output_file.hpp"
#include "study/workers/job_record.hpp"

namespace altiplan::tune {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSettings = "settings.json";
constexpr const char* kLog = "runs.log";
/// All files that a tuning writes, which --fresh removes.
constexpr std::array kOurs = {kSettings,         kLog,           "evaluations.csv", "held_back.csv",
                              "convergence.svg", "summary.json", "tuned.yaml"};

std::string check_sum(const std::string& text) {
  char sum[16];
  std::snprintf(sum, sizeof sum, "%08lx",
                ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), uInt(text.size())));
  return sum;
}

std::string line_of(const RunId& id, const std::string& parameters, const ScoredRun& run) {
  const host::Json json = {id.first,
                           id.second,
                           parameters,
                           run.outcome,
                           run.value ? host::Json(*run.value) : host::Json(),
                           run.message};
  const std::string text = host::json_text(json);
  return text + " " + check_sum(text) + "\n";
}

/// "" if it does not exist.
std::string text_of(const fs::path& file) {
  return host::is_there(file)
             ? formats::read_file(file.string(), std::numeric_limits<std::uintmax_t>::max())
             : "";
}

/// The differences of two settings, in words.
std::string differences(const host::Json& before, const host::Json& now) {
  std::set<std::string> keys;
  for (const host::Json* all : {&before, &now}) {
    for (const auto& [key, value] : all->items()) {
      keys.insert(key);
    }
  }
  std::string text;
  for (const std::string& key : keys) {
    const host::Json was = before.value(key, host::Json());
    const host::Json is = now.value(key, host::Json());
    if (was == is) {
      continue;
    }
    std::string what = key;
    if (key == "files") {
      what = "";
      for (const auto& [file, hash] : is.items()) {
        const bool same = was.is_object() && was.value(file, host::Json()) == hash;
        what += !same ? (what.empty() ? "" : ", ") + file : "";
      }
      what = what.empty() ? "its input files" : "the content of " + what;
    } else if (key == "plugins" || key == "program" || key == "altiplan") {
      what = key == "plugins" ? "the build of a plugin" : "the build of the program";
    } else if (is.is_primitive()) {
      what += " (" + host::exact_json_text(was) + " before, " + host::exact_json_text(is) + " now)";
    }
    text += (text.empty() ? "" : "; ") + what;
  }
  return text;
}

/// True for a partial file of ours that a killed call has left: "FILE.HEX.partial".
bool is_left_over(const std::string& name) {
  return name.ends_with(".partial") && std::ranges::any_of(kOurs, [&](const char* ours) {
           return name.starts_with(std::string(ours) + ".");
         });
}

/// The folder's files; removes partial files of a killed call.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::vector<fs::path> left_over;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
    if (is_left_over(names.back())) {
      left_over.push_back(entry.path());
      names.pop_back();
    }
  }
  for (const fs::path& file : left_over) {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
  return names;
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw Error("--out: '" + folder.string() + "' " + why);
}
}  // namespace

TuneLog::TuneLog(fs::path folder, const host::Json& settings, bool fresh)
    : folder_(std::move(folder)), file_(folder_ / kLog) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    refuse(folder_, "cannot be created: " + error.message());
  }
  const fs::path described = folder_ / kSettings;
  const std::vector<std::string> files = files_in(folder_);
  if (!host::is_there(described)) {
    for (const std::string& name : files) {
      if (name != "work") {
        refuse(folder_, "contains '" + name + "' and no tuning: give an empty or new folder");
      }
    }
  } else if (fresh) {
    for (const char* ours : kOurs) {
      fs::remove(folder_ / ours, error);
    }
  } else if (host::is_there(file_)) {  // otherwise no run can be lost
    const host::Json before = host::json_or_discarded(text_of(described));
    if (!before.is_object()) {
      refuse(folder_, "contains a damaged settings.json: give another folder, or --fresh");
    }
    if (before != settings) {
      refuse(folder_, "contains a tuning that differs in " + differences(before, settings) +
                          ": give another folder, or --fresh to start over");
    }
  }
  host::write_file(described, host::file_text(settings));
  read();
}

void TuneLog::read() {
  const std::string text = text_of(file_);
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    const std::string line = text.substr(begin, end - begin);
    const std::size_t space = line.rfind(' ');
    begin = end + 1;
    const bool is_whole =
        space != std::string::npos && line.substr(space + 1) == check_sum(line.substr(0, space));
    const host::Json json = is_whole ? host::json_or_discarded(line.substr(0, space))
                                     : host::Json(host::Json::value_t::null);
    if (!json.is_array() || json.size() != 6) {
      ++damaged_;
      continue;
    }
    ScoredRun run{json[3], std::nullopt, json[5]};
    if (json[4].is_number()) {
      run.value = json[4].get<double>();
    }
    runs_[{json[0], json[1]}] = {json[2], run};
  }
  std::error_code error;
  if (damaged_ > 0) {
    finish();
  } else if (begin < text.size()) {  // truncated by a kill
    fs::resize_file(file_, begin, error);
    if (error) {
      refuse(folder_, "contains a log that cannot be written: " + error.message());
    }
  }
}

const ScoredRun* TuneLog::find(const RunId& id, const std::string& parameters) const {
  const auto found = runs_.find(id);
  if (found == runs_.end()) {
    return nullptr;
  }
  if (found->second.parameters != parameters) {
    throw PluginError("the tuner is not deterministic: evaluation " + std::to_string(id.first) +
                      " had the parameters " + found->second.parameters + ", now " + parameters);
  }
  return &found->second.run;
}

void TuneLog::add(const RunId& id, const std::string& parameters, const ScoredRun& run) {
  if (const int error = study::append_file(file_.string(), line_of(id, parameters, run));
      error != 0) {
    refuse(folder_, "cannot be written to: " + std::string(std::strerror(error)));
  }
  runs_[id] = {parameters, run};
}

void TuneLog::finish() const {
  std::string text;
  for (const auto& [id, line] : runs_) {
    text += line_of(id, line.parameters, line.run);
  }
  host::write_file(file_, text);
}
}  // namespace altiplan::tune
