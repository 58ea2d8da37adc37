// SPDX-License-Identifier: Apache-2.0
#include "study/store/merge.hpp"

#include <algorithm>
#include <optional>

#include "altiplan/error.hpp"
#include "host/result/difference.hpp"
#include "study/store/place.hpp"
#include "study/store/store.hpp"
#include "study/store/store_lock.hpp"
#include "study/workers/work_folder.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;

using Study = std::map<std::string, std::string>;

std::string value_of(const Study& study, const std::string& name) {
  const auto found = study.find(name);
  return found == study.end() ? "" : found->second;
}

/// The first difference of two study files, each without comments and on one line:
/// "'"repetitions": 2' against '"repetitions": 3'".
std::string where_they_differ(const std::string& first, const std::string& second) {
  const auto [one, other] = std::mismatch(first.begin(), first.end(), second.begin(), second.end());
  const std::size_t at = std::size_t(one - first.begin());
  // From the key onwards, which is the same in both.
  const std::size_t separator = at == 0 ? first.npos : first.find_last_of(",{[", at - 1);
  const std::size_t begin = separator == first.npos ? 0 : separator + 1;
  const auto part = [&](const std::string& text) {
    const std::size_t from = text[begin] == ' ' ? begin + 1 : begin;
    return excerpt(text.substr(from, text.find_first_of(",}]", std::max(from, at)) - from));
  };
  return part(first) + " against " + part(second);
}

std::string cell(const StoredRun& run) { return "'" + run_name(run) + "'"; }

bool is_same(const StoredSession& a, const StoredSession& b) {
  return a.started == b.started && a.command == b.command && a.version == b.version &&
         a.host == b.host && a.jobs == b.jobs && a.reuse == b.reuse && a.limits == b.limits;
}

/// A result without the paths of its files, which differ if the study was moved.
host::Json without_places(const std::string& result) {
  host::Json json = result.empty() ? host::Json() : host::json_or_discarded(result);
  if (json.is_object()) {
    json.erase("pipeline");
    json.erase("scenario");
    if (json.contains("overrides") && json["overrides"].is_object()) {
      json["overrides"].erase("scenario");
    }
    if (json.contains("files") && json["files"].is_array()) {
      for (host::Json& file : json["files"]) {
        if (file.is_object()) {
          file.erase("path");
        }
      }
    }
  }
  return json;
}

std::optional<host::Difference> results_differ(const std::string& first,
                                               const std::string& second) {
  if (first == second) {
    return std::nullopt;
  }
  const host::Json one = without_places(first);
  const host::Json other = without_places(second);
  // Text that is not JSON is compared unchanged.
  return one.is_discarded() || other.is_discarded() ? host::first_difference(first, second)
                                                    : host::first_difference(one, other);
}

class Merger {
 public:
  explicit Merger(const fs::path& file) : out_(file, StoreMode::write) {}

  void add(const std::string& file) {
    const Store store(file, StoreMode::read);
    expect_same_study(store);
    add_variants(store);
    const std::map<std::int64_t, std::int64_t> sessions = add_sessions(store);
    for (const StoredRun& run : store.runs()) {
      if (from_.contains(run.key)) {
        compare(*store.run(run.id), file);
      } else {
        expect_free(run, file);
        keep(*store.run(run.id), sessions, file);
      }
    }
    flush();
  }

  Merged finish() {
    merged_.runs = from_.size();
    return std::move(merged_);
  }

 private:
  void expect_same_study(const Store& store) {
    const Study study = store.study();
    if (study.empty()) {
      throw Error("'" + store.file().string() + "' contains no study yet");
    }
    if (first_.empty()) {
      first_ = store.file().string();
      study_ = study;
      out_.set_study(study);
    } else if (const std::string why = studies_differ(study_, study); !why.empty()) {
      throw Error("'" + first_ + "' and '" + store.file().string() +
                  "' belong to different studies: " + why);
    }
  }

  void add_variants(const Store& store) {
    const auto scenarios = store.scenarios();
    const auto pipelines = store.pipelines();
    expect_same_variants(scenarios, out_.scenarios(), "scenario", store);
    expect_same_variants(pipelines, out_.pipelines(), "pipeline", store);
    out_.add_variants(scenarios, pipelines);
  }

  /// In two folders of the same study file paths may differ, but the keys set must not.
  void expect_same_variants(const std::vector<StoredVariant>& added,
                            const std::vector<StoredVariant>& known, const std::string& kind,
                            const Store& store) const {
    for (const StoredVariant& variant : added) {
      for (const StoredVariant& other : known) {
        if (variant.name == other.name && (variant.of != other.of || variant.set != other.set)) {
          throw Error("the " + kind + " '" + variant.name + "' sets different keys in '" + first_ +
                      "' and '" + store.file().string() + "'");
        }
      }
    }
  }

  /// New ids of the sessions by the old ones; a session merged before already exists.
  std::map<std::int64_t, std::int64_t> add_sessions(const Store& store) {
    std::map<std::int64_t, std::int64_t> ids;
    std::vector<StoredSession> known = out_.sessions();
    for (const StoredSession& session : store.sessions()) {
      const auto same = std::find_if(known.begin(), known.end(), [&](const StoredSession& other) {
        return is_same(session, other);
      });
      ids[session.id] = same == known.end() ? out_.add_session(session) : same->id;
    }
    return ids;
  }

  void compare(const StoredRun& run, const std::string& file) {
    flush();  // the run may not be written yet
    const StoredRun kept = *out_.run(run.key);
    std::optional<host::Difference> difference;
    if (kept.outcome != run.outcome) {
      difference = host::Difference{"outcome", kept.outcome, run.outcome};
    } else {
      difference = results_differ(kept.result, run.result);
    }
    if (!difference) {
      ++merged_.again;
      return;
    }
    merged_.differing.push_back("the run " + cell(run) + " has different results in '" +
                                from_.at(run.key) + "' and '" + file + "': " + difference->path +
                                " is " + difference->first + " and " + difference->second +
                                "; keeping the first");
  }

  void expect_free(const StoredRun& run, const std::string& file) {
    const auto [there, is_new] = cells_.emplace(cell(run), run.key);
    if (!is_new && from_.at(there->second) != file) {
      throw Error("'" + from_.at(there->second) + "' and '" + file + "' both hold the run " +
                  cell(run) + ", made from different files, plugins or builds of the program (" +
                  there->second.substr(0, 12) + " and " + run.key.substr(0, 12) + ")");
    }
  }

  void keep(StoredRun run, const std::map<std::int64_t, std::int64_t>& sessions,
            const std::string& file) {
    constexpr std::size_t kBatch = 100;
    const auto session = sessions.find(run.session);
    if (session == sessions.end()) {
      throw Error("'" + file + "' is damaged: the run " + cell(run) + " belongs to no session");
    }
    run.session = session->second;
    from_[run.key] = file;
    batch_.push_back(std::move(run));
    if (batch_.size() == kBatch) {
      flush();
    }
  }

  void flush() {
    if (!batch_.empty()) {
      out_.add(batch_);
      batch_.clear();
    }
  }

  Store out_;
  Study study_;
  std::string first_;                         ///< the first store
  std::map<std::string, std::string> from_;   ///< the store, by key
  std::map<std::string, std::string> cells_;  ///< key of the run, by pipeline, scenario, repetition
  std::vector<StoredRun> batch_;
  Merged merged_;
};
}  // namespace

std::string studies_differ(const std::map<std::string, std::string>& first,
                           const std::map<std::string, std::string>& second) {
  for (const char* name : {"name", "seed"}) {
    if (value_of(first, name) != value_of(second, name)) {
      return std::string("the ") + name + " is " + excerpt(value_of(first, name)) + " and " +
             excerpt(value_of(second, name));
    }
  }
  if (value_of(first, "text") != value_of(second, "text")) {
    return "their files differ: " +
           where_they_differ(value_of(first, "text"), value_of(second, "text"));
  }
  return "";
}

Merged merge_stores(const std::vector<std::string>& stores, const std::filesystem::path& out) {
  const WorkFolder locked(work_folder_of(out));  // so that no study writes the file being replaced
  NewDatabase unfinished(out);
  Merged merged;
  {
    Merger merger(unfinished.file());
    for (const std::string& store : stores) {
      expect_no_writer(store);
      merger.add(store);
      expect_no_writer(store);  // nor one that has begun since
    }
    merged = merger.finish();
  }
  unfinished.put_in_place();
  return merged;
}
}  // namespace altiplan::study
