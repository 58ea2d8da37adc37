// SPDX-License-Identifier: Apache-2.0
#include "study/report/report.hpp"

#include <cstdio>

#include "altiplan/error.hpp"
#include "commands.hpp"
#include "host/base/program.hpp"
#include "progress.hpp"
#include "study/arena/arena.hpp"
#include "study/arena/arena_reading.hpp"
#include "study/figures/text.hpp"
#include "study/store/load_study.hpp"
#include "study/store/place.hpp"

namespace altiplan::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> stores;
  std::string folder;  ///< "" if no page is requested
  std::optional<std::string> arena;
  std::string title;
  bool no_times = false;
  bool pdf = false;
  host::Overrides overrides;
};

/// The command line; with --no-times without the file names, so that the page depends only on the
/// runs.
std::string command_of(const ReportArguments& arguments) {
  std::string command = "altiplan report";
  if (arguments.no_times) {
    command += " DB -o DIR --no-times";
  } else {
    for (const std::string& store : arguments.stores) {
      command += " " + study::report::shell(store);
    }
    command += " -o " + study::report::shell(arguments.folder);
  }
  if (!arguments.title.empty()) {
    command += " --title " + study::report::shell(arguments.title);
  }
  return command + (arguments.pdf ? " --pdf" : "");
}

std::filesystem::path pdf_converter() {
  const auto found = host::find_on_path({"rsvg-convert"});
  if (!found) {
    throw Error(
        "--pdf: needs the program rsvg-convert, which is not on the PATH; in Debian and Ubuntu it "
        "is in the package librsvg2-bin");
  }
  return *found;
}

/// The runs of a study, and those of benchmarks of OMPL beside them.
study::report::Source load(const std::vector<std::string>& files) {
  std::vector<std::string> stores;
  std::vector<std::string> arenas;
  for (const std::string& file : files) {
    (study::is_arena(file) ? arenas : stores).push_back(file);
  }
  study::report::Source source;
  if (!stores.empty() || arenas.empty()) {
    source = study::report::load_source(stores);
  } else {
    source.study_text = "# runs of another program\n";
    source.results = [](const study::RunRow&) { return std::string(); };
  }
  for (const std::string& file : arenas) {
    const std::size_t store = source.data.stores.size();
    const auto traces = study::add_arena(source.data, file);
    source.results = [store, others = source.results](const study::RunRow& row) {
      return row.store == store ? std::string() : others(row);
    };
    source.traces = [store, traces, others = source.traces](const study::RunRow& row) {
      return row.store == store ? traces(row) : others(row);
    };
  }
  return source;
}

int write_page(const ReportArguments& arguments) {
  study::report::expect_report_folder(arguments.folder);
  study::report::Options options;
  if (arguments.pdf) {
    options.to_pdf = pdf_converter();
  }
  std::optional<Activity> activity("reading the runs");
  const study::report::Source source = load(arguments.stores);
  options.title = arguments.title;
  options.command = command_of(arguments);
  options.times = !arguments.no_times;
  options.scenes.plugin_path = arguments.overrides.plugin_path;
  options.begins = [&](const std::string& what) { activity->begin(what); };
  const study::report::Written written =
      study::report::write_report(source, options, arguments.folder);
  activity.reset();
  constexpr std::size_t kMaxChanges = 5;
  for (std::size_t n = 0; n < written.changed.size() && n < kMaxChanges; ++n) {
    warn(study::report::printable(written.changed[n]));
  }
  if (written.changed.size() > kMaxChanges) {
    warn(std::to_string(written.changed.size() - kMaxChanges) +
         " more files have changed: the page lists them");
  }
  if (!written.notes.empty()) {
    warn(std::to_string(written.notes.size()) +
         " scenes could not be built: the page lists them; the first: " +
         study::report::printable(written.notes.front()));
  }
  std::printf("%s\n", written.summary.c_str());
  for (const std::string& sentence : written.lacking) {
    std::printf("  %s\n", sentence.c_str());
  }
  std::printf("%s: %s MB, %zu figures, %zu scenes\n",
              (std::filesystem::path(arguments.folder) / "index.html").c_str(),
              fixed(double(written.page_bytes) / 1e6, 2).c_str(), written.figures, written.scenes);
  return kDone;
}

int write_report(const ReportArguments& arguments) {
  if (arguments.arena) {
    expect_store_writable(*arguments.arena, "--arena");
  }
  expect_apart(arguments.arena, "--arena", arguments.stores);
  if (arguments.arena) {
    study::expect_replaceable(*arguments.arena);
    study::write_arena(study::load_study_data(arguments.stores), *arguments.arena);
    std::printf("%s: for Planner Arena\n", arguments.arena->c_str());
  }
  return arguments.folder.empty() ? kDone : write_page(arguments);
}
}  // namespace

void add_report(App& app, Action& action) {
  const auto prepare = [](ReportArguments& arguments) {
    if (arguments.folder.empty() && !arguments.arena) {
      throw UsageError{"-o or --arena is required"};
    }
    if (arguments.pdf && arguments.folder.empty()) {
      throw UsageError{"--pdf: needs -o"};
    }
  };
  auto [command, arguments] = add_command<ReportArguments>(
      app, action, "report", "write a study's results as a page with figures and tables",
      write_report, prepare);
  command
      .add_option(
          "stores DB", arguments.stores,
          "study databases: all shards of one study; OMPL benchmark databases (Planner Arena)")
      ->required();
  command.add_option("-o,--out DIR", arguments.folder,
                     "report folder: a new folder, or that of an earlier report");
  command.add_option("--arena FILE", arguments.arena, "write a database for Planner Arena");
  command.add_option("--title TEXT", arguments.title,
                     "title of the page (default: the study's name)");
  command.add_flag(
      "--no-times", arguments.no_times,
      "omit times, host and other values that vary between runs, so that equal results "
      "give identical files");
  command.add_flag("--pdf", arguments.pdf,
                   "write the figures as PDF too; needs rsvg-convert (package librsvg2-bin)");
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan report study.db -o report");
}
}  // namespace altiplan::cli
