// SPDX-License-Identifier: Apache-2.0
#include "study/reproduce/reproduce.hpp"

#include <stdlib.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <thread>

#include "commands.hpp"
#include "host/base/unfinished.hpp"
#include "progress.hpp"
#include "reproduce_text.hpp"

namespace altiplan::cli {
namespace {
namespace fs = std::filesystem;

struct ReproduceArguments {
  std::vector<std::string> papers;
  std::vector<std::string> rows;
  std::optional<std::string> out;
  study::ReproduceOptions options;
  host::Overrides overrides;  ///< only the plugin path is used
  bool list = false;
  bool json = false;
};

/// The folder of the databases: the given one, or a temporary one that goes with this object.
class Folder {
 public:
  explicit Folder(const std::optional<std::string>& given) {
    if (given) {
      path_ = *given;
      std::error_code error;
      fs::create_directory(path_, error);
      if (!fs::is_directory(path_)) {
        throw Error("--out: cannot create the folder '" + *given + "'" +
                    (error ? ": " + error.message() : ", which is a file"));
      }
      return;
    }
    const auto lock = host::uninterrupted();
    std::string name = (fs::temp_directory_path() / "altiplan-reproduce-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw Error("cannot create a folder in '" + fs::temp_directory_path().string() + "'");
    }
    path_ = name;
    unfinished_.emplace([name] {
      std::error_code ignored;
      fs::remove_all(name, ignored);
    });
  }

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  std::optional<host::Unfinished> unfinished_;
};

std::vector<study::Paper> papers_of(const ReproduceArguments& arguments) {
  std::vector<study::Paper> papers;
  const std::vector<std::string> all{"all"};
  for (const std::string& word : arguments.papers.empty() ? all : arguments.papers) {
    for (const fs::path& file : study::papers_named(word)) {
      papers.push_back(study::read_paper(file));
    }
  }
  return papers;
}

int list(const ReproduceArguments& arguments) {
  host::Json json = host::Json::array();
  for (const study::Paper& paper : papers_of(arguments)) {
    if (arguments.json) {
      json.push_back(list_json(paper));
    } else {
      std::cout << list_text(paper) << '\n';
    }
  }
  if (arguments.json) {
    std::cout << host::file_text(json);
  }
  return kDone;
}

std::string line_of(const study::Paper& paper, const study::PaperRuns& runs,
                    const study::StudyProgress& progress) {
  const std::size_t ended = progress.before + progress.done;
  std::string line = paper.name.text() + ", " + runs.id + ": ";
  if (progress.runs == 0) {
    return line + "reading";
  }
  line += std::to_string(ended) + " of " + std::to_string(progress.runs) + " runs";
  if (progress.done > 0 && ended < progress.runs) {
    line += ", " +
            duration(progress.elapsed_s / double(progress.done) * double(progress.runs - ended)) +
            " left";
  }
  return line;
}

/// Runs the papers one after the other and prints each table when its runs have ended.
class Reproduction {
 public:
  Reproduction(const ReproduceArguments& arguments, const Folder& folder)
      : arguments_(arguments), options_(arguments.options) {
    options_.folder = folder.path();
    options_.study.say = [this](const std::string& text) {
      line_.clear();
      warn(text);
    };
  }

  /// False if interrupted.
  bool run(const study::Paper& paper, const std::vector<const study::ReproducibleRow*>& rows) {
    const auto start = std::chrono::steady_clock::now();
    MarkCounts counts;
    double cpu_s = 0;
    host::Json json = host::Json::array();
    options_.progress = [&](const study::PaperRuns& runs, const study::StudyProgress& progress) {
      line_.show(line_of(paper, runs, progress));
    };
    options_.done = [&](const study::ReproducedRuns& done) {
      line_.clear();
      counts.add(done);
      all_.add(done);
      cpu_s += done.cpu_s;
      if (!done.failures.empty()) {
        warn(paper.name.text() + ", " + done.runs->id + ": runs that failed: " + done.failures);
      }
      if (!arguments_.json) {
        std::cout << reproduced_text(done) << std::flush;
      }
      for (const host::Json& row : reproduced_json(done)) {
        json.push_back(row);
      }
    };
    if (!arguments_.json) {
      std::cout << title_text(paper);
    }
    const bool is_whole = study::reproduce(paper, rows, options_);
    line_.clear();
    if (!is_whole) {
      return false;
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    finish(paper, counts, std::move(json), wall.count(), cpu_s);
    return true;
  }

  /// Of all papers.
  const MarkCounts& counts() const { return all_; }
  const host::Json& papers() const { return papers_; }

 private:
  void finish(const study::Paper& paper, const MarkCounts& counts, host::Json rows, double wall_s,
              double cpu_s) {
    papers_.push_back({{"number", paper.name.number},
                       {"name", paper.name.name},
                       {"title", paper.title},
                       {"page", paper.page},
                       {"quick", options_.quick},
                       {"differs", counts.of(study::Mark::differs)},
                       {"wall_time_s", wall_s},
                       {"cpu_time_s", cpu_s},
                       {"rows", std::move(rows)}});
    if (!arguments_.json) {
      std::cout << "\n"
                << paper.name.text() << ": " << counts.text() << "; " << duration(wall_s) << ", "
                << duration(cpu_s) << " of processor time\n\n";
    }
  }

  const ReproduceArguments& arguments_;
  study::ReproduceOptions options_;
  ProgressLine line_;
  host::Json papers_ = host::Json::array();
  MarkCounts all_;
};

int reproduce(const ReproduceArguments& arguments) {
  const std::vector<study::Paper> papers = papers_of(arguments);
  if (papers.size() > 1 && !arguments.rows.empty()) {
    throw Error("--row: expected one paper, found " + std::to_string(papers.size()));
  }
  std::vector<std::vector<const study::ReproducibleRow*>> rows;
  for (const study::Paper& paper : papers) {
    rows.push_back(study::rows_named(paper, arguments.rows));
  }
  const Folder folder(arguments.out);
  Reproduction reproduction(arguments, folder);
  for (std::size_t i = 0; i < papers.size(); ++i) {
    if (!reproduction.run(papers[i], rows[i])) {
      std::cerr << "altiplan: interrupted"
                << (arguments.out ? ": repeat the command to continue\n" : "\n");
      return kInterrupted;
    }
  }
  if (arguments.json) {
    std::cout << host::file_text(reproduction.papers());
  } else if (papers.size() > 1) {
    std::cout << papers.size() << " papers: " << reproduction.counts().text() << '\n';
  }
  return reproduction.counts().of(study::Mark::differs) > 0 ? kNoRoute : kDone;
}
}  // namespace

void add_reproduce(App& app, Action& action, const std::string& command_line) {
  const auto prepare = [](ReproduceArguments& arguments) {
    if (arguments.papers.empty() && !arguments.list) {
      throw UsageError{"PAPER is required: a number, a name, a paper file, or all (--list)"};
    }
    arguments.options.study.plugin_path = arguments.overrides.plugin_path;
    // Thousands of routes would fill gigabytes of a temporary folder.
    arguments.options.study.results = arguments.out.has_value();
  };
  auto [command, arguments] = add_command<ReproduceArguments>(
      app, action, "reproduce",
      "run the tables of a published paper and compare: paper, documentation, here",
      [](const ReproduceArguments& given) { return given.list ? list(given) : reproduce(given); },
      prepare);
  arguments.options.study.command = command_line;
  arguments.options.study.jobs = int(std::max(1U, std::thread::hardware_concurrency()));
  command.add_option("papers PAPER", arguments.papers,
                     "papers: number (002), name (fusion_astar), paper file, or all");
  auto* list_only =
      command.add_flag("--list", arguments.list, "only list the papers, and their rows with times");
  command.add_option("--row ID", arguments.rows, "only this row; repeatable")
      ->one_at_a_time()
      ->take_all()
      ->excludes(list_only);
  command
      .add_flag("--quick", arguments.options.quick,
                "run a sample of the scenarios and seeds: the documentation's figures must lie in "
                "its 99.9 % intervals")
      ->excludes(list_only);
  command
      .add_option("-o,--out DIR", arguments.out,
                  "keep the results in this folder, a database for each study; the next call uses "
                  "them")
      ->excludes(list_only);
  command
      .add_option("--jobs", arguments.options.study.jobs,
                  "number of parallel runs (default: the number of processors)")
      ->check(Check::between(1, 1024));
  command.add_flag("--json", arguments.json, "print as JSON");
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan reproduce 002 --quick");
}
}  // namespace altiplan::cli
